// What the G-buffer's 8-bit codes cost: roughness, albedo, substance (docs/shading.md, sections 1 and 2).
#include <burnish/material.h>

#include <catch2/catch.hpp>

#include "reference/shading.h"
#include "sphere.h"

using namespace burnish;
using namespace burnish::shading;

TEST_CASE("the roughness code errs by at most 3.2 % in the lobe's peak") {
  double worst = 0, at = 0;
  for (int i = 0; i <= 100'000; ++i) {
    const double r = 0.02 + 0.98 * i / 100'000, alpha = f64::alphaFromRoughness(r);
    const double stored = f64::decodeAlpha(std::round(f64::encodeAlpha(alpha) * 255) / 255);
    const double error = std::abs(
        f64::D_blinnPhong(1, f64::powerFromAlpha(stored)) / f64::D_blinnPhong(1, f64::powerFromAlpha(alpha)) - 1);
    if (error > worst) worst = error, at = r;
  }
  WARN("roughness code: the peak is off by at most " << worst * 100 << " %, at r " << at);
  CHECK(worst <= 0.032);
  CHECK(worst > 0.02);  // the range is used: half a step of 255
}

TEST_CASE("roughness codes: both ends, order, clamping, float against double") {
  CHECK(f64::encodeAlpha(1) == 1);
  CHECK(f64::encodeAlpha(4e-4) == Approx(0).margin(1e-12));
  CHECK(f64::encodeAlpha(0) == f64::encodeAlpha(4e-4));
  CHECK(f64::encodeAlpha(7) == 1);
  for (int code = 0; code < 256; ++code) {
    const double alpha = f64::decodeAlpha(code / 255.0);
    CHECK(std::round(f64::encodeAlpha(alpha) * 255) == code);
    CHECK(std::round(f32::encodeAlpha(f32::decodeAlpha(float(code) / 255)) * 255) == float(code));
    CHECK(f32::decodeAlpha(float(code) / 255) == Approx(alpha).epsilon(2e-6));
    CHECK(f64::alphaFromPower(f64::powerFromAlpha(alpha)) == Approx(alpha).epsilon(1e-12));
  }
  CHECK(f64::powerFromAlpha(4e-4) == Approx(1.25e7).epsilon(1e-6));
}

TEST_CASE("the albedo code is as fine as sRGB") {
  double worst = 0, worstSrgb = 0, ratioLow = 9, ratioHigh = 0, ratioDark = 0;
  for (int i = 0; i <= 100'000; ++i) {
    const double c = i / 100'000.0;
    const double stored = f64::decodeAlbedo(glm::round(f64::encodeAlbedo(glm::dvec3(c)) * 255.0) / 255.0).x;
    worst = std::fmax(worst, std::abs(stored - c));
    worstSrgb = std::fmax(worstSrgb, std::abs(f64::linearFromSrgb(std::round(f64::srgbFromLinear(c) * 255) / 255) - c));
    if (c < 0.01 || c > 0.999) continue;
    // Width of one step of 1/255 around c, against sRGB's.
    const double step = 2 * std::sqrt(c),
                 srgbStep = 2e-6 / (f64::srgbFromLinear(c + 1e-6) - f64::srgbFromLinear(c - 1e-6));
    ratioDark = std::fmax(ratioDark, step / srgbStep);
    if (c < 0.046) continue;
    ratioLow = std::fmin(ratioLow, step / srgbStep);
    ratioHigh = std::fmax(ratioHigh, step / srgbStep);
  }
  WARN("albedo code: error at most " << worst << " (sRGB " << worstSrgb << "); steps of " << ratioLow << " to "
                                     << ratioHigh << " of sRGB's from 0.046 up, " << ratioDark << " at 0.01");
  CHECK(worst <= worstSrgb);
  CHECK(worst <= 1.0 / 255);
  CHECK(ratioLow > 0.86);
  CHECK(ratioHigh < 1.14);
  CHECK(ratioDark < 1.30);
}

TEST_CASE("the shaders' substance is the material library's") {
  double worst = 0;
  for (int i = 0; i <= 1000; ++i)
    for (const glm::vec3 albedo :
         {glm::vec3(0), glm::vec3(1), glm::vec3(0.9f, 0.5f, 0.1f), glm::vec3(0.02f, 0.3f, 0.7f)}) {
      const float s = float(i) / 1000;
      const DecodedSubstance library = decodeSubstance(s, albedo);
      const auto difference = [&](const auto& a, const glm::vec3& b) {
        for (int k = 0; k < 3; ++k) worst = std::fmax(worst, std::abs(double(a[k]) - double(b[k])));
      };
      difference(f32::substanceF0(s, albedo), library.f0);
      difference(f32::substanceDiffuse(s, albedo), library.diffuse);
      difference(f64::substanceF0(double(s), glm::dvec3(albedo)), library.f0);
      difference(f64::substanceDiffuse(double(s), glm::dvec3(albedo)), library.diffuse);
    }
  WARN("substance: library and shaders differ by at most " << worst);
  CHECK(worst < 1e-6);
}

TEST_CASE("substance: the code's landmarks") {
  const glm::dvec3 gold(1.0, 0.78, 0.34);
  CHECK(f64::substanceF0(0, gold).x == Approx(0.25));
  CHECK(f64::substanceF0(85 / 255.0, gold).y == Approx(0.04));
  CHECK(f64::substanceF0(0.4, gold).z == Approx(0.0196));
  CHECK(f64::substanceF0(1, gold).y == Approx(0.78));
  CHECK(f64::substanceDiffuse(1, gold).x == Approx(0).margin(1e-12));
  CHECK(f64::substanceDiffuse(0.4, gold).x == Approx(1.0));
}
