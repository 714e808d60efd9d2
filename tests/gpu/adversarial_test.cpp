// Every function of the shading text and every rung, in GLSL on the backend under test, in float and in double: finite, and inside what its formula allows, for any input that its
// header accepts. 20 000 inputs a row; 2 000 000 where BURNISH_LONG is set.
#include <fmt/format.h>

#include <cfloat>
#include <cstdlib>
#include <map>

#include "gl_fixture.h"
#include "text.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec4;

namespace {

constexpr std::size_t kChunk = 200'000;
std::size_t casesWanted() {
  const char* text = std::getenv("BURNISH_LONG");
  return text && *text && std::string_view(text) != "0" ? 2'000'000 : 20'000;
}

/// Three in four from all that is allowed, the rest from where the pipeline works.
std::vector<Case> chunkOf(const Domain& domain, Random& random, std::size_t count) {
  std::vector<Case> cases;
  cases.reserve(count);
  while (cases.size() < count) cases.push_back(random() % 4 ? domain.adverse(random) : domain.ordinary(random));
  return cases;
}

/// Rounding moves a bound by this share of itself; 0 stays 0.
constexpr double kSlack = 1e-5;

struct Violations {
  std::size_t count = 0;
  std::string first;
  void note(const Row& row, const char* where, const Case& in, const Ranges& ranges, const dvec4& value) {
    for (int k = 0; k < 4; ++k) {
      const Range r = ranges[std::size_t(k)];
      if (std::isfinite(value[k]) && value[k] >= r.lo - kSlack * std::abs(r.lo) && value[k] <= r.hi + kSlack * std::abs(r.hi)) continue;
      if (++count > 3) continue;
      first += fmt::format("\n  {} in {}, output {}: {:.9g} outside [{:.9g}, {:.9g}] for", row.name, where, k, value[k], r.lo, r.hi);
      for (const glm::vec4& v : in) first += fmt::format(" ({:.9g}, {:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z, v.w);
    }
  }
};

}  // namespace

TEST_CASE("GLSL and C++: every rung is finite and inside its bound", "[adversarial]") {
  GlFixture f;
  stability::ShaderCases evaluator(*f.device);
  std::map<const Domain*, std::vector<const Row*>> byDomain;
  for (const Row& row : rows()) byDomain[row.domain].push_back(&row);
  const std::size_t wanted = casesWanted();
  std::map<const Row*, std::array<Violations, 3>> found;
  for (const auto& [domain, members] : byDomain) {
    Random random(7);
    for (std::size_t done = 0; done < wanted; done += kChunk) {
      const std::vector<Case> cases = chunkOf(*domain, random, std::min(kChunk, wanted - done));
      for (const Row* row : members) {
        const auto gpu = evaluator.evaluate(cases, row->glsl());
        INFO(row->name);
        if (!gpu) FAIL(gpu.error().message());
        auto& [glsl, inFloat, inDouble] = found[row];
        for (std::size_t i = 0; i < cases.size(); ++i) {
          const Ranges ranges = row->ranges(*row, cases[i]);
          glsl.note(*row, "GLSL", cases[i], ranges, dvec4((*gpu)[i]));
          inFloat.note(*row, "float", cases[i], ranges, row->text.inFloat(cases[i], row->rungs, row->rung));
          inDouble.note(*row, "double", cases[i], ranges, row->text.inDouble(cases[i], row->rungs, row->rung));
        }
      }
    }
  }
  std::size_t total = 0;
  for (const Row& row : rows())
    for (const Violations& v : found[&row]) {
      total += v.count;
      INFO(row.name << ": " << v.count << " of " << wanted << v.first);
      CHECK(v.count == 0);
    }
  WARN(rows().size() << " rows, " << wanted << " inputs each: " << total << " violations");
}
