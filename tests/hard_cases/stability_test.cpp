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
  for (const char* id : {"H12", "H13", "H15", "H16", "H17", "H18", "H19", "H21", "H24", "H26", "H28"}) {
    INFO(id);
    CHECK(ids.count(id) == 1);
  }
}

TEST_CASE("hard cases of the shading text as C++, in double and in float") {
  const auto rows = stabilityOnCpu();
  checkAll(rows);
  std::set<std::string> backends, ids;
  for (const StabilityCase& r : rows) backends.insert(r.backend), ids.insert(r.id);
  CHECK(backends == std::set<std::string>{"double", "float"});
  CHECK(ids.count("H14") == 1);
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
