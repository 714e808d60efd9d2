// Fresnel reflectance: every rung against formulas written down once more here, in double (docs/shading.md, section 4).
#include <catch2/catch.hpp>
#include <complex>
#include <functional>

#include "reference/quadrature.h"
#include "sphere.h"
#include "test_rungs.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
namespace f32 = burnish::shading::f32;
namespace f64 = burnish::shading::f64;

namespace {

double schlick(double f0, double c) { return f0 + (1 - f0) * std::pow(1 - c, 5); }
double gaussian(double f0, double c) { return f0 + (1 - f0) * std::pow(2, (-5.55473 * c - 6.98316) * c); }

/// Amplitudes by Snell's law for a complex index behind the surface (Born and Wolf, section 1.5.2 eq. 20 and 14.2):
/// q = m cos θt, the root that decays inward.
double complexReflectance(std::complex<double> m, double c) {
  const std::complex<double> m2 = m * m, q = std::sqrt(m2 - (1 - c * c));
  return 0.5 * (std::norm((c - q) / (c + q)) + std::norm((m2 * c - q) / (m2 * c + q)));
}

/// Real indices, by angles: Fresnel's sine and tangent laws; 1 beyond the critical angle.
double angleReflectance(double eta, double theta) {
  const double s = std::sin(theta) / eta;
  if (s >= 1) return 1;
  const double t = std::asin(s);
  if (theta < 1e-6) return std::pow((eta - 1) / (eta + 1), 2);
  return 0.5 * (std::pow(std::sin(theta - t) / std::sin(theta + t), 2) +
                std::pow(std::tan(theta - t) / std::tan(theta + t), 2));
}

double indexOf(double f0) { return (1 + std::sqrt(f0)) / (1 - std::sqrt(f0)); }
double mean(const std::function<double(double)>& f) { return reference::hemisphereMean<double>(f, 96); }

struct Worst {
  double error = 0, at = 0;
  void note(double e, double where) {
    if (!(e <= error)) error = e, at = where;
  }
};

}  // namespace

TEST_CASE("fresnel: Schlick and its spherical Gaussian") {
  Worst between, inFloat;
  for (int j = 0; j <= 20; ++j)
    for (int i = 0; i <= 2000; ++i) {
      const double f0 = j / 20.0, c = i / 2000.0;
      CHECK(std::abs(f64::F_schlick(dvec3(f0), c).x - schlick(f0, c)) < 1e-14);
      CHECK(std::abs(f64::F_sphericalGaussian(dvec3(f0), c).y - gaussian(f0, c)) < 1e-14);
      between.note(std::abs(gaussian(f0, c) - schlick(f0, c)), c);
      for (int rung : {FRESNEL_SCHLICK, FRESNEL_SPHERICAL_GAUSSIAN, FRESNEL_NONE})
        inFloat.note(
            std::abs(double(f32::fresnelRung(glm::vec3(float(f0)), glm::vec3(0), glm::vec3(0), float(c), rung).z) -
                     f64::fresnelRung(dvec3(double(float(f0))), dvec3(0), dvec3(0), double(float(c)), rung).z),
            c);
    }
  WARN("spherical Gaussian against Schlick: at most " << between.error << ", at cosine " << between.at
                                                      << "; float off by " << inFloat.error);
  CHECK(between.error < 0.0038);
  CHECK(between.error > 0.0037);  // a fit, not the same function
  CHECK(inFloat.error < 1e-6);
  CHECK(f64::F_schlick(dvec3(0.04), 1).x == Approx(0.04));
  CHECK(f64::F_schlick(dvec3(0.04), 0).x == Approx(1));
}

TEST_CASE("fresnel: Schlick against the exact one of dielectrics") {
  struct Row {
    double eta, error, degrees;
  };
  for (const Row& row : {Row{1.33, 0.060, 83.8}, Row{1.5, 0.036, 85.0}, Row{1.8, 0.035, 85.4}, Row{2.4, 0.074, 84.5}}) {
    const double f0 = std::pow((row.eta - 1) / (row.eta + 1), 2);
    Worst worst;
    for (int i = 0; i < 9000; ++i) {
      const double theta = i / 100.0 * kPi / 180, truth = angleReflectance(row.eta, theta);
      worst.note(std::abs(f64::F_schlick(dvec3(f0), std::cos(theta)).x - truth), i / 100.0);
      CHECK(std::abs(f64::F_dielectric(f0, std::cos(theta)) - truth) < 1e-12);
    }
    CAPTURE(row.eta);
    CHECK(std::abs(worst.error - row.error) < 0.001);
    CHECK(std::abs(worst.at - row.degrees) < 0.15);
  }
}

TEST_CASE("fresnel: the exact dielectric from F0") {
  Worst inFloat;
  for (int j = 0; j < 200; ++j)
    for (int i = 0; i <= 500; ++i) {
      const double f0 = j / 200.0, c = i / 500.0;
      const double truth = c > 0 ? complexReflectance(indexOf(f0), c) : f0 > 0 ? 1 : 0;
      CAPTURE(f0, c);
      CHECK(std::abs(f64::F_dielectric(f0, c) - truth) < 1e-11);
      if (c > 0) CHECK(std::abs(f64::dielectricReflectance(indexOf(f0), c) - truth) < 1e-11);
      const float f = float(f0), g = float(c);
      inFloat.note(std::abs(double(f32::F_dielectric(f, g)) - f64::F_dielectric(double(f), double(g))), c);
    }
  WARN("F_dielectric: float off by at most " << inFloat.error << ", at cosine " << inFloat.at);
  CHECK(inFloat.error < 2e-6);
  // F0 = 1 needs an infinite index: held at (1 - 1e-6)², whose Brewster angle lies within 1e-6 of the horizon.
  for (double c : {0.01, 0.1, 0.5, 1.0}) {
    CHECK(f64::F_dielectric(1, c) == Approx(1).margin(1e-3 / c * 1e-1));
    CHECK(double(f32::F_dielectric(1, float(c))) == Approx(1).margin(1e-3));
  }
  CHECK(f64::F_dielectric(1, 1) == Approx(1).margin(4.1e-6));
  CHECK(f64::F_dielectric(1, 0) == 1);
  CHECK(f64::F_dielectric(0, 0.5) == 0);
}

TEST_CASE("fresnel: real indices on either side, total internal reflection") {
  Worst inFloat;
  for (double eta : {0.3, 0.5, 1 / 1.5, 0.75, 0.99, 1.0, 1.0003, 1.33, 1.5, 2.42, 4.0}) {
    for (int i = 1; i <= 1000; ++i) {
      const double c = i / 1000.0;
      CAPTURE(eta, c);
      CHECK(std::abs(f64::dielectricReflectance(eta, c) - angleReflectance(eta, std::acos(c))) < 1e-9);
      const float e = float(eta), g = float(c), critical = 1 - e * e;
      if (std::abs(g * g - critical) > 1e-3f)  // infinitely steep at the critical angle
        inFloat.note(
            std::abs(double(f32::dielectricReflectance(e, g)) - f64::dielectricReflectance(double(e), double(g))), c);
    }
    CHECK(f64::dielectricReflectance(eta, 0) == (eta == 1 ? f64::dielectricReflectance(1, 0) : 1));
    CHECK(f64::dielectricReflectance(eta, 1) == Approx(std::pow((eta - 1) / (eta + 1), 2)).margin(1e-14));
  }
  WARN("dielectricReflectance: float off by at most " << inFloat.error);
  CHECK(inFloat.error < 1e-5);
  // Glass to air: 41.81 degrees.
  CHECK(f64::dielectricReflectance(1 / 1.5, std::cos(41.82 * kPi / 180)) == 1);
  CHECK(f64::dielectricReflectance(1 / 1.5, std::cos(41.80 * kPi / 180)) < 0.95);
}

TEST_CASE("fresnel: conductors against complex arithmetic") {
  Worst worst, inFloat;
  for (double eta : {0.0, 0.02, 0.14, 0.5, 1.0, 1.5, 3.0, 10.0})
    for (double k : {0.0, 0.01, 0.5, 1.0, 2.0, 4.0, 9.0, 20.0}) {
      if (eta + k == 0) continue;
      for (int i = 1; i <= 400; ++i) {
        const double c = i / 400.0, value = f64::F_conductor(eta, k, c);
        worst.note(std::abs(value - complexReflectance({eta, k}, c)), c);
        CHECK(value >= 0);
        CHECK(value <= 1);
        if (k > 0.1) inFloat.note(std::abs(double(f32::F_conductor(float(eta), float(k), float(c))) - value), c);
      }
      CHECK(f64::F_conductor(eta, k, 1) ==
            Approx((std::pow(eta - 1, 2) + k * k) / (std::pow(eta + 1, 2) + k * k)).margin(1e-12));
    }
  WARN("F_conductor: off by at most " << worst.error << "; float by " << inFloat.error << " at cosine " << inFloat.at);
  CHECK(worst.error < 1e-7);
  CHECK(inFloat.error < 1e-4);
}

TEST_CASE("fresnel: the rung in force, each channel its own") {
  const dvec3 f0(0.04, 0.5, 0.9), eta(0.14, 0.37, 1.44), k(4.0, 2.4, 1.6);
  for (int i = 1; i <= 50; ++i) {
    const double c = i / 50.0;
    const auto rung = [&](int r, const dvec3& e) { return f64::fresnelRung(f0, e, k, c, r); };
    for (int j = 0; j < 3; ++j) {
      CHECK(rung(FRESNEL_NONE, eta)[j] == f0[j]);
      CHECK(rung(FRESNEL_SCHLICK, eta)[j] == Approx(schlick(f0[j], c)));
      CHECK(rung(FRESNEL_SPHERICAL_GAUSSIAN, eta)[j] == Approx(gaussian(f0[j], c)));
      for (int r : {FRESNEL_DIELECTRIC, FRESNEL_CONDUCTOR})
        CHECK(rung(r, dvec3(0))[j] == Approx(complexReflectance(indexOf(f0[j]), c)));
      CHECK(rung(FRESNEL_DIELECTRIC, eta)[j] == rung(FRESNEL_DIELECTRIC, dvec3(0))[j]);
      // A map's tint over the metal's own curve.
      const double own = complexReflectance({eta[j], k[j]}, 1),
                   over = complexReflectance({eta[j], k[j]}, c) * f0[j] / own;
      CHECK(rung(FRESNEL_CONDUCTOR, eta)[j] == Approx(std::fmin(over, 1)).margin(1e-9));
      for (int r = FRESNEL_NONE; r <= FRESNEL_CONDUCTOR; ++r)
        CHECK(f64::fresnelDielectricPart(f0[j], c, r) == Approx(rung(r, dvec3(0))[j]).margin(1e-14));
    }
  }
}

TEST_CASE("refraction: Snell's law, unit length, T + F = 1, the same both ways") {
  std::mt19937_64 random(11);
  for (int i = 0; i < 20'000; ++i) {
    const dvec3 n = randomUnit(random);
    dvec3 eye = randomUnit(random);
    if (dot(eye, n) < 0) eye = -eye;
    if (dot(eye, n) < 1e-3) continue;
    const double eta = i % 2 ? 1 + (i % 97) / 60.0 : 1 / (1 + (i % 97) / 60.0), c = dot(eye, n);
    dvec3 out;
    const double t = f64::refractSnell(eye, n, eta, out), sinEye = glm::length(glm::cross(eye, n));
    CAPTURE(eta, c);
    CHECK(glm::length(out) == Approx(1).epsilon(1e-9));
    CHECK(std::abs(dot(out, glm::cross(eye, n))) < 1e-9);  // one plane
    CHECK(t + angleReflectance(eta, std::acos(c)) == Approx(1).margin(1e-9));
    if (sinEye >= eta) {
      CHECK(t == 0);
      CHECK(glm::length(out - glm::reflect(-eye, n)) < 1e-9);
      continue;
    }
    CHECK(dot(out, n) <= 0);
    CHECK(glm::length(glm::cross(out, n)) * eta == Approx(sinEye).margin(1e-9));
    CHECK(dot(out - n * dot(out, n), eye - n * c) <= 1e-12);  // across the normal
    // Back along the ray, from the other side.
    if (-dot(out, n) < 1e-4) continue;
    dvec3 back(0);
    CHECK(f64::refractSnell(out, -n, 1 / eta, back) == Approx(t).margin(1e-7));
    CHECK(glm::length(back - eye) < 1e-6);
    glm::vec3 outF(0);
    CHECK(std::abs(double(f32::refractSnell(glm::vec3(eye), glm::vec3(n), float(eta), outF)) - t) <
          (std::abs(sinEye - eta) < 0.01 ? 0.1 : 1e-4));
  }
}

TEST_CASE("fresnel: the mean over the hemisphere") {
  Worst gauss, dielectric, any;
  for (int j = 0; j <= 100; ++j) {
    const double f0 = j / 100.0;
    CHECK(f64::fresnelMean(f0, FRESNEL_SCHLICK) ==
          Approx(mean([&](double c) { return schlick(f0, c); })).epsilon(1e-9));
    CHECK(f64::fresnelMean(f0, FRESNEL_NONE) == f0);
    gauss.note(
        std::abs(f64::fresnelMean(f0, FRESNEL_SPHERICAL_GAUSSIAN) - mean([&](double c) { return gaussian(f0, c); })),
        f0);
    if (f0 == 0 || f0 == 1) continue;
    const double error = std::abs(f64::fresnelMean(f0, FRESNEL_DIELECTRIC) -
                                  mean([&](double c) { return complexReflectance(indexOf(f0), c); }));
    (f0 <= 0.25 ? dielectric : any).note(error, f0);
  }
  // Schlick's mean stands in for those of the other rungs: what that costs.
  WARN("fresnelMean: spherical Gaussian off by " << gauss.error << ", exact dielectric by " << dielectric.error
                                                 << " at F0 " << dielectric.at << ", by " << any.error << " at F0 "
                                                 << any.at << ", which no dielectric has");
  CHECK(gauss.error < 0.0013);
  CHECK(dielectric.error < 0.02);
  CHECK(any.error < 0.046);
}
