// Visibility terms against the functions that they stand for (docs/shading.md, section 4).
#include <catch2/catch.hpp>

#include "reference/quadrature.h"
#include "sphere.h"
#include "test_rungs.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
namespace f64 = burnish::shading::f64;

namespace {

double tanOf(double c) { return std::sqrt(1 - c * c) / c; }
/// Heitz 2014, eq. 72.
double lambdaGgx(double c, double alpha) { return 0.5 * (std::sqrt(1 + std::pow(alpha * tanOf(c), 2)) - 1); }
/// Smith's term for Gaussian slopes, with erf (Walter et al. 2007, eq. 27).
double lambdaGauss(double c, double alpha) {
  if (c == 1) return 0;
  const double a = 1 / (alpha * tanOf(c));
  return 0.5 * (std::erf(a) - 1) + std::exp(-a * a) / (2 * a * std::sqrt(kPi));
}

/// ∫ D(h) G1(v) max(v·h, 0) dh / (n·v): 1 where masking leaves visible just what projects (Heitz 2014, eq. 15).
/// `masked`: D G1 by h.
template <class F>
double visibleArea(double nov, double alpha, F&& masked) {
  const reference::GaussRule polar(200), azimuth(64);
  const dvec3 v = viewAt(nov);
  double sum = 0;
  // tan² = alpha² u/(1 - u); rings of h with v·h > 0 throughout end at tan θh = nov / sin v.
  const double whole = nov * nov / (nov * nov + alpha * alpha * v.x * v.x);
  for (std::size_t i = 0; i < 2 * polar.node.size(); ++i) {
    const double t = polar.node[i / 2], from = i % 2 ? whole : 0, span = i % 2 ? 1 - whole : whole;
    const double u = from + span * 0.5 * (1 - std::cos(kPi * t)),
                 du = span * 0.5 * kPi * std::sin(kPi * t) * polar.weight[i / 2];
    const double d = 1 - u + alpha * alpha * u, c = std::sqrt((1 - u) / d), s = alpha * std::sqrt(u / d);
    const double jacobian = alpha * alpha / (2 * c * d * d);
    // v·h > 0 where cos φ > -nov c / (sin v s): whole rings or a part.
    const double limit = -nov * c / std::max(v.x * s, 1e-300), end = limit <= -1 ? kPi : std::acos(limit);
    double ring = 0;
    for (std::size_t j = 0; j < azimuth.node.size(); ++j) {
      const double phi = end * azimuth.node[j];
      const dvec3 h(s * std::cos(phi), s * std::sin(phi), c);
      ring += masked(h) * std::max(dot(v, h), 0.0) * azimuth.weight[j];
    }
    sum += ring * 2 * end * jacobian * du;
  }
  return sum / nov;
}

}  // namespace

TEST_CASE("geometry: Smith's terms against Lambda") {
  double worstFit = 0, worstOne = 0;
  for (double alpha : {4e-4, 0.01, 0.1, 0.3, 0.6, 1.0})
    for (int i = 1; i <= 100; ++i)
      for (int j = 1; j <= 100; ++j) {
        const double l = i / 100.0, v = j / 100.0;
        CAPTURE(alpha, l, v);
        const double ggx = 1 / (1 + lambdaGgx(l, alpha) + lambdaGgx(v, alpha)),
                     gauss = 1 / (1 + lambdaGauss(l, alpha) + lambdaGauss(v, alpha));
        CHECK(4 * l * v * f64::V_smithGgx(l, v, alpha) == Approx(ggx).epsilon(1e-9));
        const double fit = 4 * l * v * f64::V_smithBeckmann(l, v, alpha);
        worstFit = std::max(worstFit, std::abs(fit / gauss - 1));
        worstOne =
            std::max(worstOne, std::abs(4 * v * f64::V_smithBeckmann(1, v, alpha) * (1 + lambdaGauss(v, alpha)) - 1));
        CHECK(fit <= 1 + 1.4e-4);  // Walter's fit of Lambda dips to -7e-5 before it ends
        // Correlated heights see more than independent ones.
        CHECK(ggx >= 1 / ((1 + lambdaGgx(l, alpha)) * (1 + lambdaGgx(v, alpha))) - 1e-12);
      }
  WARN("Smith, Beckmann: rational fit off by at most " << worstOne * 100 << " % of the erf form for one direction, "
                                                       << worstFit * 100 << " % for two");
  CHECK(worstOne < 0.0036);  // Walter et al. state 0.35 %
  CHECK(worstFit < 0.0065);
}

TEST_CASE("geometry: Smith sees what projects, and no more (the weak white furnace)") {
  double ggx = 0, beckmann = 0, cavity = 0;
  for (double alpha : {0.02, 0.1, 0.3, 0.6, 1.0})
    for (double nov : {0.05, 0.1, 0.3, 0.6, 0.9, 1.0}) {
      const dvec3 v = viewAt(nov);
      const auto sin2 = [](const dvec3& h) { return h.x * h.x + h.y * h.y; };
      // From straight above nothing shadows: G2(n, v) is G1(v).
      const double oneGgx = 4 * nov * f64::V_smithGgx(1, nov, alpha),
                   oneBeckmann = 4 * nov * f64::V_smithBeckmann(1, nov, alpha);
      const double a = visibleArea(nov, alpha, [&](const dvec3& h) { return f64::D_ggx(sin2(h), alpha) * oneGgx; });
      const double b =
          visibleArea(nov, alpha, [&](const dvec3& h) { return f64::D_beckmann(sin2(h), alpha) * oneBeckmann; });
      const double c = visibleArea(nov, alpha, [&](const dvec3& h) {
        return f64::D_beckmann(sin2(h), alpha) * 4 * nov * f64::V_vCavity(1, nov, h.z, dot(v, h));
      });
      CAPTURE(alpha, nov, a, b, c);
      ggx = std::max(ggx, std::abs(a - 1));
      beckmann = std::max(beckmann, std::abs(b - 1));
      cavity = std::max(cavity, std::abs(c - 1));
    }
  WARN("weak white furnace: GGX off by " << ggx << ", Beckmann's fit by " << beckmann << ", V-cavities by " << cavity);
  CHECK(ggx < 1e-3);
  CHECK(beckmann < 0.004);
  CHECK(cavity < 1e-3);
}

TEST_CASE("geometry: void, Kelemen, Schlick-Smith and V-cavities by hand") {
  std::mt19937_64 random(12);
  for (int i = 0; i < 20'000; ++i) {
    dvec3 l = randomUnit(random), v = randomUnit(random);
    l.z = std::abs(l.z), v.z = std::abs(v.z);
    if (l.z < 1e-3 || v.z < 1e-3) continue;
    const dvec3 h = normalize(l + v);
    const double lh = dot(l, h), k = (i % 100 + 1) / 100.0;
    CAPTURE(l.z, v.z, lh, k);
    CHECK(f64::V_void() == 0.25);
    CHECK(f64::V_kelemen(1 / dot(l + v, l + v)) == Approx(0.25 / (lh * lh)).epsilon(1e-9));
    const double g = l.z / (l.z * (1 - k) + k) * v.z / (v.z * (1 - k) + k);
    CHECK(4 * l.z * v.z * f64::V_schlickSmith(l.z, v.z, k) == Approx(g).epsilon(1e-9));
    const double cavity = std::min({1.0, 2 * h.z * v.z / lh, 2 * h.z * l.z / lh});
    CHECK(4 * l.z * v.z * f64::V_vCavity(l.z, v.z, h.z, lh) == Approx(cavity).epsilon(1e-9));
    // The rung picks the width: alpha sqrt(2/pi) with Beckmann and Blinn-Phong, alpha/2 with GGX.
    const f64::Surface m = f64::makeSurface({0, 0, 1}, v, dvec3(1), 1, k);
    const f64::Angles a = f64::anglesOf(m, l);
    const auto schlick = [&](double w) { return 0.25 / ((l.z * (1 - w) + w) * (v.z * (1 - w) + w)); };
    const f64::Widths w = f64::widthsOf(m, a, shading::Rungs{});
    CHECK(f64::geometryRung(m, a, w, GEOMETRY_SCHLICK_SMITH, DISTRIBUTION_GGX) == Approx(schlick(k / 2)).epsilon(1e-9));
    for (int d : {DISTRIBUTION_BLINN_PHONG, DISTRIBUTION_BECKMANN})
      CHECK(f64::geometryRung(m, a, w, GEOMETRY_SCHLICK_SMITH, d) ==
            Approx(schlick(k * std::sqrt(2 / kPi))).epsilon(1e-7));
  }
}

TEST_CASE("geometry: how near Schlick's fit comes to Smith") {
  double gauss = 0, ggx = 0;
  for (double alpha : {0.05, 0.2, 0.5, 1.0})
    for (int i = 1; i <= 200; ++i) {
      const double c = i / 200.0, kGauss = alpha * std::sqrt(2 / kPi), kGgx = alpha / 2;
      gauss = std::max(gauss, std::abs(c / (c * (1 - kGauss) + kGauss) - 1 / (1 + lambdaGauss(c, alpha))));
      ggx = std::max(ggx, std::abs(c / (c * (1 - kGgx) + kGgx) - 1 / (1 + lambdaGgx(c, alpha))));
    }
  WARN("Schlick's G1 against Smith's: off by " << gauss << " (Beckmann), " << ggx << " (GGX)");
  CHECK(gauss < 0.45);
  CHECK(ggx < 0.16);
}
