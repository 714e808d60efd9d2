// (n·h)^p from directions in GLSL: what is left of a narrow lobe by each rung (docs/shading.md, section 4).
#include "shader_cases.h"
#include "text_domains.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
using glm::vec3;
using glm::vec4;

namespace {

/// Half vectors within three widths of the normal, eye and light at least acos(`steepest`) above the surface.
std::vector<Case> insideLobe(float roughness, float steepest, std::size_t count) {
  Random random(3);
  const double alpha = double(roughness * roughness);
  std::vector<Case> cases;
  while (cases.size() < count) {
    const dvec3 n = glm::normalize(dvec3(randomUnit(random))), v = glm::normalize(dvec3(randomUnit(random))), side = glm::normalize(glm::cross(n, dvec3(randomUnit(random))));
    const double angle = double(uniform(random, 0, 3)) * alpha;
    const dvec3 h = n * std::cos(angle) + side * std::sin(angle), l = h * (2 * dot(h, v)) - v;
    if (dot(n, v) < double(steepest) || dot(n, l) < double(steepest) || dot(v, h) < double(steepest)) continue;
    cases.push_back({vec4(vec3(n), roughness * roughness), vec4(vec3(l), 0), vec4(vec3(v), 0)});
  }
  return cases;
}

/// Worst absolute errors of pow, exp2 and stable; the truth is (n·h)^p of the very same vectors, taken as directions, in double.
dvec3 errorsOf(GlFixture& f, float roughness, float steepest) {
  const std::vector<Case> cases = insideLobe(roughness, steepest, 100'000);
  const auto gpu = onGpu(f, cases,
                         "vec4(lobePow(dot(a.xyz, normalize(b.xyz + c.xyz)), powerFromAlpha(a.w)), "
                         "lobeExp2(dot(a.xyz, b.xyz) + dot(a.xyz, c.xyz), 1.0 / (2.0 + 2.0 * dot(b.xyz, c.xyz)), powerFromAlpha(a.w)), "
                         "lobeRung(makeSurface(a.xyz, c.xyz, vec3(1), 1, a.w), anglesOf(makeSurface(a.xyz, c.xyz, vec3(1), 1, a.w), b.xyz), powerFromAlpha(a.w), LOBE_STABLE), 0)");
  dvec3 worst(0);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const dvec3 n = glm::normalize(dvec3(cases[i][0])), l = glm::normalize(dvec3(cases[i][1])), v = glm::normalize(dvec3(cases[i][2])), x = glm::cross(n, glm::normalize(l + v));
    const double truth = std::exp(0.5 * double(shading::f32::powerFromAlpha(cases[i][0].w)) * std::log1p(-dot(x, x)));
    worst = glm::max(worst, glm::abs(dvec3(gpu[i]) - truth));
  }
  return worst;
}

}  // namespace

TEST_CASE("GLSL: the stable rung keeps narrow lobes, pow loses them", "[rungs]") {
  struct Lobe {
    float r;
    double pow, stable, stableGrazing;
  };
  GlFixture f;
  // The table of docs/shading.md holds near the normal (here within 26 degrees); toward grazing (within 84 degrees) the rounding of l and v themselves turns h.
  for (const Lobe& row : {Lobe{0.2f, 0.00015, 1e-5, 1e-5}, Lobe{0.1f, 0.0028, 1e-5, 1e-4}, Lobe{0.05f, 0.045, 1e-4, 3e-4}, Lobe{0.02f, 0.74, 1e-4, 1.5e-3}, Lobe{0.01f, 1, 5e-4, 7e-3}}) {
    const dvec3 near = errorsOf(f, row.r, 0.9f), grazing = errorsOf(f, row.r, 0.1f);
    WARN("r " << row.r << ": pow off by " << near.x << ", exp2 " << near.y << ", stable " << near.z << "; toward grazing pow " << grazing.x << ", exp2 " << grazing.y << ", stable "
              << grazing.z);
    CHECK(near.z < row.stable);
    CHECK(grazing.z < row.stableGrazing);
    CHECK(near.x > row.pow / 2);
    CHECK(near.x < 2.5 * row.pow);  // drivers' pow adds its own error
    CHECK(near.z < near.y / 3);
  }
}
