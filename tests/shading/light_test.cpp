// Attenuation of punctual lights and occlusion of reflections.
#include <catch2/catch.hpp>

#include "reference/shading.h"

using namespace burnish::shading;

TEST_CASE("a light with a range: inverse square under a window that ends at the range") {
  for (const double range : {0.5, 2.5, 40.0, 1000.0}) {
    const double invRange4 = std::pow(range, -4);
    const auto attenuation = [&](double d) { return f64::distanceAttenuation(d * d, 1 / (d * d), invRange4, 0); };
    CHECK(attenuation(range) == Approx(0).margin(1e-30));
    CHECK(attenuation(range * 1.5) == 0);
    for (int i = 1; i < 100; ++i) {
      const double d = range * i / 100, window = 1 - std::pow(d / range, 4);
      CHECK(attenuation(d) == Approx(window * window / (d * d)).epsilon(1e-9));
    }
    // The last tenth falls steadily and to nothing: value and slope vanish together.
    double before = attenuation(0.9 * range);
    for (int i = 1; i <= 1000; ++i) {
      const double now = attenuation(range * (0.9 + 0.1 * i / 1000));
      CHECK(now <= before);
      CHECK(before - now < 0.01 * attenuation(0.9 * range));
      before = now;
    }
    CHECK(attenuation(range * 0.999) < 2e-5 / (range * range));
  }
}

TEST_CASE("a light without a range loses its threshold everywhere and ends without a step") {
  for (const double reach : {3.0, 100.0}) {
    const double bias = 1 / (reach * reach);
    const auto attenuation = [&](double d) { return f64::distanceAttenuation(d * d, 1 / (d * d), 0, bias); };
    for (int i = 1; i < 100; ++i) {
      const double d = reach * i / 100;
      CHECK(attenuation(d) == Approx(1 / (d * d) - bias).epsilon(1e-9));
    }
    CHECK(attenuation(reach) == Approx(0).margin(1e-15));
    CHECK(attenuation(reach * 1.0001) == 0);
    CHECK(attenuation(reach * 0.9999) < 3e-4 * bias);
    CHECK(attenuation(reach * 100) == 0);
  }
}

TEST_CASE("attenuation in float follows double, and is finite at the light itself") {
  double worst = 0;
  for (int i = 1; i < 10'000; ++i) {
    const float d2 = 6.25f * float(i) / 10'000;
    const double truth = f64::distanceAttenuation(double(d2), 1 / double(d2), 1 / 39.0625, 0);
    // Relative to the light without its window.
    worst =
        std::fmax(worst, std::abs(double(f32::distanceAttenuation(d2, 1 / d2, 1 / 39.0625f, 0)) - truth) * double(d2));
  }
  CHECK(worst < 5e-7);
  const float nearest = 1e-4f;  // BURNISH_GUARD_DISTANCE2
  CHECK(f32::distanceAttenuation(nearest, 1 / nearest, 0, 0) == Approx(1e4));
}

TEST_CASE("spot cones: one inside, nothing outside, smooth between") {
  const double inner = std::cos(0.3), outer = std::cos(0.6), scale = 1 / (inner - outer), offset = -outer * scale;
  CHECK(f64::spotAttenuation(1, scale, offset) == 1);
  CHECK(f64::spotAttenuation(inner, scale, offset) == Approx(1));
  CHECK(f64::spotAttenuation(outer, scale, offset) == Approx(0).margin(1e-20));
  CHECK(f64::spotAttenuation(-1, scale, offset) == 0);
  CHECK(f64::spotAttenuation(0.5 * (inner + outer), scale, offset) == Approx(0.25));  // the square of the linear ramp
  double before = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double now = f64::spotAttenuation(outer + (inner - outer) * i / 1000, scale, offset);
    CHECK(now >= before);
    CHECK(now - before < 0.0025);
    before = now;
  }
}

TEST_CASE("specular occlusion lies in [0, 1], grows with AO, and is off without occlusion") {
  for (int a = 0; a <= 20; ++a)
    for (int v = 0; v <= 20; ++v) {
      const double alpha = a / 20.0, nov = v / 20.0;
      CHECK(f64::specularOcclusion(nov, 1, alpha, SPECULAR_OCCLUSION_LAGARDE) == Approx(1));
      double before = 0;
      for (int i = 0; i <= 50; ++i) {
        const double now = f64::specularOcclusion(nov, i / 50.0, alpha, SPECULAR_OCCLUSION_LAGARDE);
        CHECK(now >= before);
        CHECK(now <= 1);
        before = now;
      }
    }
  // Listing 26 by hand: nv 0.5, ao 0.5, alpha 0.25: 1^x - 1 + 0.5; nv 0.1, ao 0.4, alpha 0.0625: 0.5^(2^-2) - 0.6.
  CHECK(f64::specularOcclusion(0.5, 0.5, 0.25, SPECULAR_OCCLUSION_LAGARDE) == Approx(0.5));
  CHECK(f64::specularOcclusion(0.1, 0.4, 0.0625, SPECULAR_OCCLUSION_LAGARDE) == Approx(0.240896415));
}

TEST_CASE("levels of a prefiltered cube and roughness are each other's inverse") {
  for (const double last : {1.0, 3.0, 5.0}) {
    for (int i = 0; i <= 100; ++i)
      CHECK(f64::environmentRoughness(f64::environmentLevel(i / 100.0, last), last) == Approx(i / 100.0).margin(1e-12));
    CHECK(f64::environmentLevel(1, last) == Approx(last));
  }
}
