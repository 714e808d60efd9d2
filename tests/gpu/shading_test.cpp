// The shading text as GLSL, on the backend under test, against the same text as C++ in double: one texel per case.
#include "reference/shading.h"

#include <functional>
#include <random>
#include <vector>

#include "shader_cases.h"
#include "shading/test_rungs.h"

using namespace burnish;
using burnish::stability::glslOf;
using burnish::test::defaultRungs;
using burnish::test::GlFixture;
using burnish::test::onGpu;
using glm::dvec3;
using glm::vec3;
using glm::vec4;
namespace f64 = burnish::shading::f64;
namespace f32 = burnish::shading::f32;

namespace {

using Case = burnish::test::ShaderCase;

vec3 randomUnit(std::mt19937& random) {
  std::normal_distribution<float> normal;
  for (;;) {
    const vec3 v(normal(random), normal(random), normal(random));
    if (glm::length(v) > 0.1f) return glm::normalize(v);
  }
}
float uniform(std::mt19937& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

bool finite(const vec4& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

/// Worst |gpu - truth| / scale over the cases; every result must be finite.
double worstError(std::span<const Case> cases, std::span<const vec4> gpu,
                  const std::function<dvec3(const Case&)>& truth,
                  const std::function<double(const Case&, const dvec3&)>& scale) {
  double worst = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    CAPTURE(i, cases[i][0].x, cases[i][0].y, cases[i][0].z, cases[i][0].w, gpu[i].x, gpu[i].y, gpu[i].z);
    REQUIRE(finite(gpu[i]));
    const dvec3 exact = truth(cases[i]), off = glm::abs(dvec3(gpu[i]) - exact);
    worst = std::fmax(worst, std::fmax(off.x, std::fmax(off.y, off.z)) / scale(cases[i], exact));
  }
  return worst;
}
double one(const Case&, const dvec3&) { return 1; }

/// n, l, v with l and v above the surface, w of n = alpha in the pipeline's range, d = albedo and substance.
std::vector<Case> shadingCases(int count, float lowest) {
  std::mt19937 random(7);
  std::vector<Case> cases;
  while (int(cases.size()) < count) {
    const vec3 n = randomUnit(random), v = randomUnit(random);
    const float r = uniform(random, 0.02f, 1.0f), alpha = r * r;
    // Every other light near the mirror direction, where the lobe is.
    const vec3 h = glm::normalize(n + randomUnit(random) * alpha),
               l = cases.size() % 2 ? glm::normalize(glm::reflect(-v, h)) : randomUnit(random);
    if (dot(n, v) < lowest || dot(n, l) < lowest || dot(l, v) < -0.9f) continue;
    cases.push_back({vec4(n, alpha), vec4(l, 0), vec4(v, 0),
                     vec4(uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1))});
  }
  return cases;
}

}  // namespace

TEST_CASE("GLSL: normals are packed and unpacked as in C++") {
  GlFixture f;
  std::mt19937 random(1);
  std::vector<Case> cases;
  for (int axis = 0; axis < 6; ++axis) {
    vec3 n(0);
    n[axis % 3] = axis < 3 ? 1.0f : -1.0f;
    cases.push_back({vec4(n, 0)});
  }
  cases.push_back({vec4(0)});
  while (cases.size() < 50'000) cases.push_back({vec4(randomUnit(random), 0)});
  const auto codes = onGpu(f, cases, "vec4(floor(packNormal(a.xyz) * 255.0 + 0.5), 0.0)");
  const auto stored = onGpu(f, cases, "vec4(unpackNormal(floor(packNormal(a.xyz) * 255.0 + 0.5) / 255.0), 0.0)");
  int differing = 0;
  double worst = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    REQUIRE(finite(stored[i]));
    const dvec3 n(cases[i][0]);
    differing += dvec3(codes[i]) != glm::round(f64::packNormal(n) * 255.0);
    const dvec3 truth = i == 6 ? dvec3(0, 0, 1) : glm::normalize(n);
    worst = std::fmax(worst, 2 * std::asin(glm::length(glm::normalize(dvec3(stored[i])) - truth) / 2));
    if (i < 6) CHECK(glm::length(dvec3(stored[i]) - n) < 1e-6);
  }
  WARN("packed normals: worst angle " << worst * 57.29577951 << " degrees; " << differing << " of " << cases.size()
                                      << " codes differ from double's");
  CHECK(worst * 57.29577951 < 0.0589 * 1.02);
  CHECK(differing < int(cases.size()) / 200);  // ties

  std::vector<Case> triples;
  for (int i = 0; i < 50'000; ++i)
    triples.push_back({vec4(float(random() % 256), float(random() % 256), float(random() % 256), 0) / 255.0f});
  const auto unpacked = onGpu(f, triples, "vec4(unpackNormal(a.rgb), 0.0)");
  // Any three bytes, also those that no normal packs to: the code 4095 lies a step beyond the square, where the sign of a zero decides which way it is folded.
  const auto truth = [](const Case& c) { return f64::unpackNormal(glm::round(dvec3(c[0]) * 255.0) / 255.0); };
  const auto beyond = [](const Case& c) {
    const glm::ivec3 b = glm::ivec3(glm::round(dvec3(c[0]) * 255.0));
    return b.x + b.z / 16 * 256 == 4095 || b.y + b.z % 16 * 256 == 4095;
  };
  std::vector<Case> packed, others;
  std::vector<vec4> ofPacked, ofOthers;
  for (std::size_t i = 0; i < triples.size(); ++i) {
    (beyond(triples[i]) ? others : packed).push_back(triples[i]);
    (beyond(triples[i]) ? ofOthers : ofPacked).push_back(unpacked[i]);
  }
  const double error = worstError(packed, ofPacked, truth, one), beyondIt = worstError(others, ofOthers, truth, one);
  WARN("unpackNormal: off by at most " << error << ", beyond the square by " << beyondIt << " (" << others.size() << ")");
  CHECK(error < 2e-6);
  CHECK(beyondIt < 1.01 / 1023);
}

TEST_CASE("GLSL: roughness codes") {
  GlFixture f;
  std::vector<Case> cases;
  for (int i = 0; i <= 4096; ++i)
    cases.push_back({vec4(float(i) / 4096, std::exp2(-11.2877f * float(i) / 4096), 0, 0)});
  for (const float bad : {0.0f, -1.0f, 2.0f, 1e30f, 1e-38f}) cases.push_back({vec4(0.5f, bad, 0, 0)});
  const auto gpu = onGpu(f, cases, "vec4(encodeAlpha(a.y), decodeAlpha(a.x), powerFromAlpha(decodeAlpha(a.x)), 0.0)");
  double encode = 0, decode = 0, power = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    REQUIRE(finite(gpu[i]));
    const double alpha = f64::decodeAlpha(double(cases[i][0].x)), p = f64::powerFromAlpha(alpha);
    encode = std::fmax(encode, std::abs(double(gpu[i].x) - f64::encodeAlpha(double(cases[i][0].y))));
    decode = std::fmax(decode, std::abs(double(gpu[i].y) / alpha - 1));
    power = std::fmax(power, std::abs(double(gpu[i].z) - p) / (p + 2));
  }
  WARN("encodeAlpha off by " << encode * 255 << "/255, decodeAlpha by " << decode << " of alpha, power by " << power
                             << " of p + 2");
  CHECK(encode < 1e-6);
  CHECK(decode < 5e-6);
  CHECK(power < 1e-5);
}

TEST_CASE("GLSL: the stable lobe") {
  GlFixture f;
  std::mt19937 random(3);
  std::vector<Case> cases;
  for (int i = 0; i < 20'000; ++i) {
    const float r = uniform(random, 0.02f, 1.0f), p = f32::powerFromAlpha(r * r);
    cases.push_back({vec4(std::fmin(uniform(random, 0, 12) / (p + 2), 1.0f), p, 0, 0)});
  }
  for (const float sin2 : {-1e-7f, 0.0f, 1e-38f, 0.9999999f, 1.0f, 1.5f, 1e30f})
    for (const float p : {0.0f, 1.0f, 1.25e7f}) cases.push_back({vec4(sin2, p, 0, 0)});
  const auto truth = [](const Case& c) {
    const double x = std::clamp(double(c[0].x), 0.0, 1.0);
    return dvec3(std::exp(0.5 * double(c[0].y) * (x == 1 ? std::log(1e-30) : std::log1p(-x))), 0,
                 0);  // BURNISH_GUARD_LOG
  };
  const auto gpu = onGpu(f, cases, "vec4(lobeStable(a.x, a.y), 0.0, 0.0, 0.0)");
  const double error = worstError(cases, gpu, truth, one);
  WARN("lobeStable: off by at most " << error << " of the peak");
  CHECK(error < 1e-5);
}

TEST_CASE("GLSL: the lighting equation follows C++ in double") {
  GlFixture f;
  const std::vector<Case> cases = shadingCases(20'000, 0.1f);
  for (const int geometry : {GEOMETRY_VOID, GEOMETRY_KELEMEN}) {
    const shading::Rungs rungs = defaultRungs(geometry);
    const auto gpu = onGpu(f, cases, "shadeCase(a, b, c, d, e, f.xy, " + glslOf(rungs) + ")");
    const auto truth = [&](const Case& c) {
      const dvec3 n = glm::normalize(dvec3(c[0])), l = glm::normalize(dvec3(c[1])), v = glm::normalize(dvec3(c[2]));
      return f64::shadeDirection(f64::makeSurface(n, v, dvec3(c[3]), double(c[3].w), double(c[0].w)), l, glm::dvec2(0),
                                 rungs);
    };
    // Of the lobe's peak at this l and v, or of 1/π where that is more.
    const auto scale = [&](const Case& c, const dvec3&) {
      const double p = f64::powerFromAlpha(double(c[0].w)), s2 = 2 + 2 * dot(dvec3(c[1]), dvec3(c[2]));
      const double peak = geometry == GEOMETRY_KELEMEN ? f64::D_blinnPhong(1, p) / s2 : f64::normalizationExact(p);
      return std::fmax(peak, 0.318);
    };
    const double error = worstError(cases, gpu, truth, scale);
    WARN("shadeDirection, geometry " << geometry << ": off by at most " << error << " of the peak");
    CHECK(error < 3e-4);
  }
}

TEST_CASE("GLSL: the lighting equation is finite and not negative on hard inputs") {
  GlFixture f;
  const vec3 n(0, 0, 1);
  std::vector<vec3> directions = {n, -n, vec3(1, 0, 0), vec3(0, -1, 0)};
  for (const float z : {1e-7f, 1e-4f, 0.01f, 0.7f, -1e-7f, -1e-4f, -0.3f})
    for (const vec3 side : {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0.6f, 0.8f, 0)})
      directions.emplace_back(side * std::sqrt(1 - z * z) + n * z);
  std::vector<Case> cases;
  for (const vec3& v : directions)
    for (std::size_t k = 0; k <= directions.size(); ++k) {
      const vec3 l = k < directions.size() ? directions[k] : -v;
      for (const float r : {0.02f, 0.3f, 1.0f})
        for (const vec4& material :
             {vec4(0), vec4(1), vec4(1, 1, 1, 0), vec4(0, 0, 0, 1), vec4(0.5f, 0.5f, 0.5f, 0.4f)})
          cases.push_back({vec4(n, r * r), vec4(l, 0), vec4(v, 0), material});
    }
  // Lights behind by as much as the eye is before: the half vector lies in the surface.
  std::mt19937 random(11);
  for (int i = 0; i < 2000; ++i) {
    const vec3 v = randomUnit(random), t = randomUnit(random),
               l = glm::normalize(vec3(t.x, t.y, 0)) * std::sqrt(1 - v.z * v.z) - n * v.z;
    cases.push_back({vec4(n, 0.01f), vec4(l, 0), vec4(v, 0), vec4(0.5f)});
  }
  std::vector<std::string> evaluated;
  for (const int geometry : {GEOMETRY_VOID, GEOMETRY_KELEMEN})
    for (const int lobe : {LOBE_POW, LOBE_EXP2, LOBE_STABLE})
      evaluated.push_back("shadeCase(a, b, c, d, e, f.xy, " + glslOf(defaultRungs(geometry, lobe)) + ")");
  for (const std::string& evaluate : evaluated) {
    const auto gpu = onGpu(f, cases, evaluate);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const vec4 &l = cases[i][1], &v = cases[i][2];
      CAPTURE(evaluate, cases[i][0].w, l.x, l.y, l.z, v.x, v.y, v.z, cases[i][3].x, cases[i][3].w, gpu[i].x, gpu[i].y,
              gpu[i].z);
      REQUIRE(finite(gpu[i]));
      REQUIRE(gpu[i].x >= -1e-6f);
      if (l.z <= 0 && v.z >= 0)
        REQUIRE(vec3(gpu[i]) == vec3(0));  // makeSurface turns a normal that looks away from the eye
    }
  }
}

TEST_CASE("GLSL: attenuation and occlusion") {
  GlFixture f;
  std::mt19937 random(5);
  std::vector<Case> cases;
  for (int i = 0; i < 10'000; ++i) {
    const float reach = uniform(random, 0.5f, 50.0f), d = reach * uniform(random, 0.02f, 1.2f),
                d2 = std::fmax(d * d, 1e-4f);
    const bool window = i % 2 == 0;
    cases.push_back({vec4(d2, window ? 1 / (reach * reach * reach * reach) : 0, window ? 0 : 1 / (reach * reach), 0),
                     vec4(uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 4e-4f, 1), 0)});
  }
  const auto gpu = onGpu(f, cases, "vec4(distanceAttenuation(a.x, 1.0 / a.x, a.y, a.z), 0.0, 0.0, 0.0)");
  const double error = worstError(
      cases, gpu,
      [](const Case& c) {
        return dvec3(f64::distanceAttenuation(double(c[0].x), 1 / double(c[0].x), double(c[0].y), double(c[0].z)), 0,
                     0);
      },
      [](const Case& c, const dvec3&) { return 1 / double(c[0].x); });
  WARN("distanceAttenuation: off by at most " << error << " of the inverse square");
  CHECK(error < 1e-6);

  for (const float nov : {0.0f, 1e-4f, 1.0f})
    for (const float ao : {0.0f, 1.0f})
      for (const float alpha : {4e-4f, 1.0f}) cases.push_back({vec4(1), vec4(nov, ao, alpha, 0)});
  const double occlusion = worstError(
      cases, onGpu(f, cases, "vec4(specularOcclusion(b.x, b.y, b.z, SPECULAR_OCCLUSION_LAGARDE), 0.0, 0.0, 0.0)"),
      [](const Case& c) { return dvec3(f64::specularOcclusion(double(c[1].x), double(c[1].y), double(c[1].z),
                                             SPECULAR_OCCLUSION_LAGARDE), 0, 0); },
      one);
  WARN("specularOcclusion: off by at most " << occlusion);
  CHECK(occlusion < 5e-6);
}

TEST_CASE("GLSL: tone maps") {
  GlFixture f;
  std::mt19937 random(6);
  std::vector<Case> cases = {
      {vec4(0)},     {vec4(65504)}, {vec4(65504, 0, 0, 0)}, {vec4(0, 0, 65504, 0)}, {vec4(1e-30f)},
      {vec4(0.76f)}, {vec4(0.8f)}};
  while (cases.size() < 20'000) {
    const float level = std::exp2(uniform(random, -14, 10));
    cases.push_back(
        {vec4(level * uniform(random, 0, 1), level * uniform(random, 0, 1), level * uniform(random, 0, 1), 0)});
  }
  struct Map {
    const char* name;
    dvec3 (*exact)(dvec3);
    double bound;
  };
  for (const Map& map : {Map{"tonemapNone", f64::tonemapNone, 1e-7}, Map{"tonemapNeutral", f64::tonemapNeutral, 1e-6},
                         Map{"tonemapAces", f64::tonemapAces, 5e-6}, Map{"tonemapAgx", f64::tonemapAgx, 1e-4}}) {
    const double error = worstError(
        cases, onGpu(f, cases, std::string("vec4(") + map.name + "(a.rgb), 0.0)"),
        [&](const Case& c) { return map.exact(dvec3(c[0])); }, one);
    WARN(map.name << ": off by at most " << error * 255 << "/255");
    CHECK(error < map.bound);
  }
  std::vector<Case> greys;
  for (int i = 0; i <= 10'000; ++i) greys.push_back({vec4(float(i) / 10'000)});
  const double error = worstError(
      greys, onGpu(f, greys, "vec4(srgbFromLinearFast(a.x), srgbFromLinear(a.x), 0.0, 0.0)"),
      [](const Case& c) { return dvec3(f64::srgbFromLinear(double(c[0].x)), f64::srgbFromLinear(double(c[0].x)), 0); },
      one);
  WARN("sRGB: off by at most " << error * 255 << "/255");
  CHECK(error < 0.25 / 255 + 1e-5);
}
