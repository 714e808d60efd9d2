// The specular lobe: evaluation in float against double, normalizations, directional albedo
// (docs/shading.md, section 4).
#include <catch2/catch.hpp>

#include "sphere.h"
#include "test_rungs.h"

using namespace burnish;
using namespace burnish::shading;
using namespace burnish::test;
using glm::dvec3;
using glm::vec3;

namespace {

struct LobeErrors {
  double pow = 0, exp2 = 0, stable = 0;
};

/// Worst absolute errors of (n·h)^p in float over the lobe, for random n and v at least 6 degrees above the surface.
/// The truth is (n·h)^p of the very same float vectors, taken as directions, in double.
LobeErrors lobeErrors(double roughness, int count, double steepest) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  const double alpha = roughness * roughness;
  const float p = f32::powerFromAlpha(f32::alphaFromRoughness(float(roughness)));
  LobeErrors worst;
  while (count > 0) {
    const dvec3 exactN = randomUnit(random), exactV = randomUnit(random);
    if (dot(exactN, exactV) < steepest) continue;
    const dvec3 side = glm::normalize(glm::cross(exactN, randomUnit(random)));
    const double angle = uniform(random) * 3 * alpha;  // three widths
    const dvec3 exactH = exactN * std::cos(angle) + side * std::sin(angle);
    const vec3 n(exactN), v(exactV), l(glm::reflect(-exactV, exactH));
    if (double(dot(n, l)) < steepest || dot(exactV, exactH) < steepest) continue;
    --count;
    const dvec3 dn = glm::normalize(dvec3(n)), dh = glm::normalize(glm::normalize(dvec3(l)) + glm::normalize(dvec3(v)));
    const dvec3 c = glm::cross(dn, dh);
    const double truth = std::exp(0.5 * double(p) * std::log1p(-std::fmin(dot(c, c), 1.0)));
    const auto note = [&](double& w, float value) { w = std::fmax(w, std::abs(double(value) - truth)); };
    const float nol = glm::dot(n, l), nov = glm::dot(n, v), inverse = 1 / (2 + 2 * glm::dot(l, v));
    note(worst.pow, std::pow(std::fmin(glm::dot(n, glm::normalize(l + v)), 1.0f), p));
    note(worst.exp2, f32::lobeExp2(nov + nol, inverse, p));
    note(worst.stable, f32::lobeStable(f32::sinSquaredHalf(n, l, nol, v - n * nov, inverse), p));
  }
  return worst;
}

double albedo(double nov, double p, bool kelemen, int steps) {
  const dvec3 v = viewAt(nov);
  return integrateHemisphere(
      [&](const dvec3& l) {
        const double s2 = 2 + 2 * dot(l, v), noh2 = (l.z + v.z) * (l.z + v.z) / s2, lobe = std::pow(noh2, 0.5 * p);
        return l.z *
               (kelemen ? f64::D_blinnPhong(lobe, p) * f64::V_kelemen(1 / s2) : f64::normalizationExact(p) * lobe);
      },
      steps);
}

}  // namespace

TEST_CASE("the lobe in float: the stable form keeps it, n·h loses it") {
  struct Row {
    double r, pow, stable, stableGrazing;
  };
  // docs/shading.md, section 4, holds near the normal (here within 26 degrees); toward grazing (within 84 degrees) the
  // rounding of l and v themselves turns h.
  for (const Row& row : {Row{0.2, 0.00015, 1e-5, 1e-5}, Row{0.1, 0.0028, 1e-5, 1e-4}, Row{0.05, 0.045, 1e-4, 3e-4},
                         Row{0.02, 0.74, 1e-4, 1.5e-3}, Row{0.01, 1.0, 5e-4, 7e-3}}) {
    const LobeErrors e = lobeErrors(row.r, 200'000, 0.9), grazing = lobeErrors(row.r, 200'000, 0.1);
    WARN("r " << row.r << ": pow " << e.pow << ", exp2 " << e.exp2 << ", stable " << e.stable << "; toward grazing pow "
              << grazing.pow << ", exp2 " << grazing.exp2 << ", stable " << grazing.stable);
    CHECK(e.stable < row.stable);
    CHECK(grazing.stable < row.stableGrazing);
    CHECK(e.stable < e.exp2 / 3);
    CHECK(e.pow < 2 * row.pow);
    CHECK(e.pow > row.pow / 2);
  }
}

TEST_CASE("the stable lobe is finite where the half vector lies in the surface") {
  for (const float sin2 : {0.999999f, 0.99999994f, 1.0f, 1.0000001f, 2.0f, 1e30f})
    for (const float p : {0.0f, 1.0f, 64.0f, 1.25e7f}) {
      CAPTURE(sin2, p);
      const float lobe = f32::lobeStable(sin2, p);
      CHECK(lobe >= 0);
      CHECK(lobe <= 1);
      if (p >= 1) CHECK(lobe < 0.002f);
    }
  // A light as far behind the surface as the eye is before it: l + v has no part along n.
  const vec3 n(0, 0, 1), v(0.6f, 0, 0.8f), l(0, 0.6f, -0.8f);
  const vec3 behind =
      f32::shadeDirection(f32::makeSurface(n, v, vec3(0.5f), 0.3f, 0.1f), l, glm::vec2(0), defaultRungs());
  CHECK(behind == vec3(0));
}

TEST_CASE("ln(1 - x) keeps its relative error where x is tiny and where it is near 1") {
  double worst = 0, at = 0;
  const auto check = [&](float x) {
    const double truth = std::log1p(-double(x)), error = std::abs(double(f32::logOneMinus(x)) / truth - 1);
    if (error > worst) worst = error, at = double(x);
  };
  for (int i = 0; i < 1'000'000; ++i) check(float(std::pow(10.0, -12 + 12.0 * i / 1'000'000)));
  for (int i = 1; i < 1'000'000; ++i) check(float(i) / 1'000'000);
  for (float x = 1 - 1e-4f; x < 1 - 2e-7f; x = std::nextafter(x, 2.0f)) check(x);
  WARN("logOneMinus: relative error at most " << worst << ", at x " << at);
  CHECK(worst < 1e-6);
  CHECK(f32::logOneMinus(0) == 0);
  CHECK(f32::logOneMinus(1) < -14);  // held there, not infinite
  CHECK(std::isfinite(f32::logOneMinus(1)));
  CHECK(f64::logOneMinus(0.3) == Approx(std::log1p(-0.3)).epsilon(1e-7));
}

TEST_CASE("Blinn-Phong's distribution integrates to one") {
  for (const double p : {0.0, 1.0, 8.0, 64.0, 1024.0, 8192.0}) {
    const double sum =
        integrateHemisphere([&](const dvec3& h) { return f64::D_blinnPhong(std::pow(h.z, p), p) * h.z; }, 1000);
    CHECK(sum == Approx(1).epsilon(1e-3));
  }
}

TEST_CASE("directional albedo with Kelemen's visibility, F = 1") {
  struct Row {
    double p, nov, value;
  };
  for (const Row& row : {Row{64, 1, 0.969}, Row{64, 0.5, 0.918}, Row{64, 0.2, 0.817}, Row{64, 0.1, 0.801},
                         Row{8192, 1, 1.000}, Row{8192, 0.5, 0.999}, Row{8192, 0.2, 0.997}, Row{8192, 0.1, 0.987}}) {
    const double e = albedo(row.nov, row.p, true, row.p > 1000 ? 1500 : 500);
    CAPTURE(row.p, row.nov, e);
    CHECK(std::abs(e - row.value) < 0.0011);
  }
  for (const double p : {0.0, 1.0, 4.0, 16.0, 64.0, 256.0, 1024.0})
    for (const double nov : {0.01, 0.05, 0.1, 0.3, 0.6, 0.9, 1.0}) {
      CAPTURE(p, nov);
      CHECK(albedo(nov, p, true, 300) < 1.0005);
    }
}

TEST_CASE("directional albedo with void geometry and the exact normalization") {
  struct Row {
    double nov, value;
  };
  for (const Row& row : {Row{1, 1.000}, Row{0.8, 0.651}, Row{0.6, 0.380}, Row{0.4, 0.187}, Row{0.2, 0.070}})
    CHECK(std::abs(albedo(row.nov, 64, false, 500) - row.value) < 0.0011);
  for (const double p : {0.0, 1.0, 4.0, 16.0, 256.0}) {
    CAPTURE(p);
    CHECK(albedo(1, p, false, 500) == Approx(1).epsilon(1e-3));
    for (const double nov : {0.05, 0.3, 0.7, 0.95}) CHECK(albedo(nov, p, false, 300) < 1.0005);
  }
}

TEST_CASE("cheap normalizations against the exact one") {
  double worst = 0, at = 0;
  for (double p = 0; p < 1000; p += 0.1) {
    const double error = (p + 8) / (8 * kPi) / f64::normalizationExact(p) - 1;
    CHECK(error > -1e-12);
    if (error > worst) worst = error, at = p;
  }
  CHECK(worst == Approx(0.0752).margin(0.0001));
  CHECK(at == Approx(8.8).margin(0.11));
  const auto plusTwo = [](double p) { return (p + 2) / (8 * kPi) / f64::normalizationExact(p) - 1; };
  CHECK(plusTwo(1) == Approx(-0.659).margin(0.001));
  CHECK(plusTwo(16) == Approx(-0.200).margin(0.001));
  CHECK(plusTwo(64) == Approx(-0.059).margin(0.001));
}

TEST_CASE("the default path is reciprocal, and float follows double") {
  std::mt19937_64 random(4);
  double worst = 0;
  int used = 0;
  while (used < 20'000) {
    const vec3 n(randomUnit(random)), l(randomUnit(random)), v(randomUnit(random));
    if (dot(n, l) < 0.05f || dot(n, v) < 0.05f) continue;
    ++used;
    const float alpha = 0.01f + 0.99f * float(used % 100) / 100, substance = float(used % 37) / 36;
    const vec3 albedo(0.8f, 0.4f, 0.1f);
    for (const int geometry : {GEOMETRY_VOID, GEOMETRY_KELEMEN}) {
      const Rungs rungs = defaultRungs(geometry);
      const dvec3 dn = glm::normalize(dvec3(n)), dl = glm::normalize(dvec3(l)), dv = glm::normalize(dvec3(v));
      const auto exact = [&](const dvec3& from, const dvec3& to) {
        return f64::shadeDirection(f64::makeSurface(dn, to, dvec3(albedo), double(substance), double(alpha)), from,
                                   glm::dvec2(0), rungs) /
               dot(dn, from);
      };
      const dvec3 there = exact(dl, dv), back = exact(dv, dl);
      CHECK(glm::length(there - back) <=
            1e-6 * glm::length(there));  // logOneMinus has a truncated series in double too
      const vec3 inFloat =
          f32::shadeDirection(f32::makeSurface(n, v, albedo, substance, alpha), l, glm::vec2(0), rungs) / dot(n, l);
      // Relative to the value with the lobe at its peak, where the rounding of vectors is what counts.
      const double scale = glm::length(there) + f64::D_blinnPhong(1, f64::powerFromAlpha(double(alpha))) * 1e-2;
      worst = std::fmax(worst, glm::length(dvec3(inFloat) - there) / scale);
    }
  }
  WARN("shadeDirection: float off by at most " << worst);
  CHECK(worst < 2e-3);
}
