// The table of hard cases that `burnish stability` prints, and the guard ledger.
#include <burnish/measure.h>

#include <set>

#include "gpu/gl_fixture.h"

using namespace burnish;

namespace {

void checkAll(const std::vector<StabilityCase>& rows) {
  REQUIRE(rows.size() > 10);
  for (const StabilityCase& r : rows) {
    INFO(r.id << " " << r.what << " on " << r.backend << ": " << r.value << " of " << r.bound << " " << r.note);
    CHECK(r.pass);
    CHECK(r.pass == (std::isfinite(r.value) && r.value <= r.bound));
  }
}

}  // namespace

TEST_CASE("hard cases of the shading text on this backend, and pictures") {
  const auto context = test::openContext();
  const auto rows = stabilityOnGpu(context->procAddress(), "gpu");
  checkAll(rows);
  std::set<std::string> ids;
  for (const StabilityCase& r : rows) ids.insert(r.id);
  // Every hard case runs on each backend (docs/hard_cases.md).
  for (int i = 1; i <= 29; ++i) {
    INFO("H" << i);
    CHECK(ids.count("H" + std::to_string(i)) == 1);
  }
}

TEST_CASE("hard cases of the shading text as C++, in double and in float") {
  const auto rows = stabilityOnCpu();
  checkAll(rows);
  std::set<std::string> backends, ids;
  for (const StabilityCase& r : rows) backends.insert(r.backend), ids.insert(r.id);
  CHECK(backends == std::set<std::string>{"double", "float"});
  // What only a renderer can do has no row here: mirror rooms, values that are no numbers (terms take finite ones), positions from depth, targets.
  for (int i = 1; i <= 29; ++i)
    if (i != 6 && i != 17 && i != 23 && i != 28) {
      INFO("H" << i);
      CHECK(ids.count("H" + std::to_string(i)) == 1);
    }
  CHECK(stabilityIds().size() == 29);
}

TEST_CASE("cases are chosen by their ids, and slow ones left out") {
  StabilityOptions options;
  options.cases = {"H15", "H8"};
  const auto some = stabilityOnCpu(options);
  std::set<std::string> ids;
  for (const StabilityCase& r : some) ids.insert(r.id);
  CHECK(ids == std::set<std::string>{"H15", "H8"});
  options.cases = {"H11"};
  CHECK(stabilityOnCpu(options).size() == 2);
  options.quick = true;
  CHECK(stabilityOnCpu(options).empty());
}

TEST_CASE("the guard ledger lists every guard with its reason") {
  const auto rows = guardLedger();
  REQUIRE(rows.size() == 18);
  std::set<std::string> names;
  for (const GuardRow& g : rows) {
    INFO(g.name << ": " << g.worstEnergyLoss << " " << g.where << ", " << g.nonfiniteWithout << " not finite without it");
    names.insert(g.name);
    CHECK(g.reason.size() > 20);
    CHECK(std::isfinite(g.worstEnergyLoss));
    CHECK(g.worstEnergyLoss >= 0);
    // A guard that neither changes energy nor keeps anything finite has no reason to be there.
    CHECK((g.nonfiniteWithout > 0 || g.worstEnergyLoss + g.worstEnergyGain > 1e-9));
  }
  CHECK(names.size() == rows.size());
}
