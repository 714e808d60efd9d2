// Every function of the shading text and every rung: GLSL on the backend under test and C++ in float against C++ in double, on the same cases.
#include <burnish/quality.h>
#include <fmt/format.h>

#include <map>
#include <set>

#include "gl_fixture.h"
#include "text.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec4;

namespace {

constexpr std::size_t kCases = 20'000;

std::vector<Case> ordinaryCases(const Domain& domain) {
  Random random(20'240'601);
  std::vector<Case> cases;
  cases.reserve(kCases);
  while (cases.size() < kCases) cases.push_back(domain.ordinary(random));
  return cases;
}

bool finite(const dvec4& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w); }

struct Errors {
  double glsl = 0, inFloat = 0, between = 0;  ///< of GLSL and of float against double; of GLSL against float
  int output = 0;                             ///< where glsl was found
  bool finite = true;
};
Errors errorsOf(const Row& row, std::span<const Case> cases, std::span<const glm::vec4> gpu) {
  Errors worst;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const dvec4 exact = row.text.inDouble(cases[i], row.rungs, row.rung), inFloat = row.text.inFloat(cases[i], row.rungs, row.rung), glsl(gpu[i]);
    worst.finite &= finite(exact) && finite(inFloat) && finite(glsl);
    for (int k = 0; k < 4; ++k) {
      if (exact[k] == glsl[k] && exact[k] == inFloat[k]) continue;
      const double scale = row.scale.of(row, cases[i], exact, k), e = std::abs(glsl[k] - exact[k]) / scale;
      if (!(e <= worst.glsl)) worst.glsl = e, worst.output = k;
      worst.inFloat = std::max(worst.inFloat, std::abs(inFloat[k] - exact[k]) / scale);
      worst.between = std::max(worst.between, std::abs(inFloat[k] - glsl[k]) / scale);
    }
  }
  return worst;
}

/// Rungs that are no function of numbers, and what tests them.
const std::map<std::string, const char*> kElsewhere = {
    {"ambient-source=probes", "records that are read (tests/probe)"},
    {"ambient-source=grid", "buffers that are read (tests/probe); its functions have rows"},
    {"reflection=infinite", "the direction as it is"},
    {"reflection=box", "its functions are held against ray-box in double, through GLSL too (tests/probe)"},
    {"reflection=box-rough", "its functions are held against ray-box in double, through GLSL too (tests/probe)"},
    {"occlusion=none", "a texture that is read or not (tests/render)"},
    {"occlusion=baked", "a texture that is read or not (tests/render)"},
    {"occlusion=screen-4", "passes (tests/render); their functions have rows"},
    {"occlusion=screen-8", "passes (tests/render); their functions have rows"},
    {"occlusion=screen-16", "passes (tests/render); their functions have rows"},
    {"direct-occlusion=none", "a factor in the lighting pass (tests/render)"},
    {"direct-occlusion=specular", "a factor in the lighting pass (tests/render)"},
    {"anisotropy=none", "the term left out"},
    {"rough-diffuse=none", "the term left out"},
    {"path=deferred", "passes (tests/render)"},
    {"path=forward", "passes (tests/render)"},
    {"shadow=none", "the term left out"},
    {"shadow=tap", "lookups of a map (tests/render); its functions are in tests/shading"},
    {"shadow=pcf", "lookups of a map (tests/render); its functions are in tests/shading"},
    {"shadow=pcss", "lookups of a map (tests/render); its functions are in tests/shading"},
    {"antialiasing=none", "the term left out"},
    {"antialiasing=edge", "a pass (tests/render)"},
    {"antialiasing=temporal", "passes (tests/render); their functions have rows"},
    {"specular-antialiasing=none", "the term left out"},
    {"normal-storage=oct-8", "a format (tests/render); its functions have rows"},
    {"normal-storage=oct-12", "a format (tests/render); its functions have rows"},
    {"normal-storage=oct-16", "a format (tests/render); its functions have rows"},
    {"light-buffer=r11g11b10", "a format (tests/render)"},
    {"light-buffer=rgba16f", "a format (tests/render)"},
    {"light-buffer=rgba32f", "a format (tests/render)"},
    {"bloom=none", "the term left out"},
    {"bloom=scatter", "a pass (tests/render)"},
};

}  // namespace

TEST_CASE("GLSL and C++: the table has every rung", "[rungs]") {
  std::set<std::string> covered, names;
  for (const Row& row : rows()) {
    CAPTURE(row.name);
    CHECK(names.insert(row.name).second);
    covered.insert(row.covers.begin(), row.covers.end());
  }
  std::set<std::string> wanted;
  for (const Term& term : terms())
    for (const Rung& rung : term.rungs) {
      const std::string name = fmt::format("{}={}", term.name, rung.name);
      CAPTURE(name);
      wanted.insert(name);
      CHECK(covered.count(name) + kElsewhere.count(name) == 1);
    }
  for (const std::string& name : covered) {
    CAPTURE(name);
    CHECK(wanted.count(name) == 1);
  }
}

TEST_CASE("GLSL and C++: every rung agrees with double", "[rungs]") {
  GlFixture f;
  stability::ShaderCases evaluator(*f.device);
  std::map<const Domain*, std::vector<Case>> cases;
  for (const Row& row : rows()) {
    std::vector<Case>& inputs = cases[row.domain];
    if (inputs.empty()) inputs = ordinaryCases(*row.domain);
    const auto gpu = evaluator.evaluate(inputs, row.glsl());
    INFO(row.name);
    if (!gpu) FAIL(gpu.error().message());
    const Errors e = errorsOf(row, inputs, *gpu);
    WARN(fmt::format("{}: GLSL off by at most {:.2g}{} (output {}), float by {:.2g}; GLSL and float differ by {:.2g}", row.name, e.glsl, row.scale.unit, e.output, e.inFloat, e.between));
    CHECK(e.finite);
    CHECK(e.glsl <= row.bound.glsl);
    CHECK(e.inFloat <= row.bound.inFloat);
  }
}
