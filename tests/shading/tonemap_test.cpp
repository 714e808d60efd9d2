// Tone maps against values worked out from their published definitions in another language (matrices, not text, of this
// project), and the sRGB transfer function.
#include <catch2/catch.hpp>

#include "reference/shading.h"

using namespace burnish::shading;
using glm::dvec3;
using glm::vec3;

namespace {

struct Case {
  dvec3 in, out;
};
// Khronos PBR Neutral specification 1.0, listing.
const Case kNeutral[] = {{{0.18, 0.18, 0.18}, {0.14, 0.14, 0.14}},
                         {{1, 1, 1}, {0.8690909, 0.8690909, 0.8690909}},
                         {{4, 2, 1}, {0.9832558, 0.6399514, 0.4682992}},
                         {{0.05, 0.02, 0.3}, {0.0325, 0.0025, 0.2825}},
                         {{100, 1, 0.1}, {0.9994208, 0.9369481, 0.9363801}}};
// Hill's fit, BakingLab/ACES.hlsl.
const Case kAces[] = {{{0.18, 0.18, 0.18}, {0.1055912, 0.1055912, 0.1055902}},
                      {{1, 1, 1}, {0.6191154, 0.6191154, 0.6191092}},
                      {{4, 2, 1}, {0.9281324, 0.8110373, 0.6699072}},
                      {{0.05, 0.02, 0.3}, {0.0078440, 0.0031192, 0.1857531}},
                      {{100, 1, 0.1}, {1, 0.9624068, 0.8689249}}};
// Wrensch, "Minimal AgX Implementation"; the outset matrix as the numerical inverse of the inset.
const Case kAgx[] = {{{0.18, 0.18, 0.18}, {0.2144674, 0.2145326, 0.2145367}},
                     {{1, 1, 1}, {0.5899769, 0.5902070, 0.5902214}},
                     {{4, 2, 1}, {0.8792166, 0.7500884, 0.6133542}},
                     {{0.05, 0.02, 0.3}, {0.0762496, 0.0381573, 0.3382963}},
                     {{100, 1, 0.1}, {1, 0.8887697, 0.8658156}}};

template <std::size_t N>
void checkCases(const Case (&cases)[N], dvec3 (*exact)(dvec3), vec3 (*inFloat)(vec3)) {
  for (const Case& c : cases) {
    const dvec3 a = exact(c.in);
    const vec3 b = inFloat(vec3(c.in));
    CAPTURE(c.in.x, c.in.y, c.in.z, a.x, a.y, a.z);
    for (int k = 0; k < 3; ++k) {
      CHECK(a[k] == Approx(c.out[k]).margin(1e-6));
      CHECK(double(b[k]) == Approx(c.out[k]).margin(5e-6));
    }
  }
}

/// Grey from black through half float's largest: finite, in [0, 1], not falling by more than `slack`.
void checkGreys(vec3 (*map)(vec3), float slack) {
  float before = 0;
  for (int i = 0; i <= 4000; ++i) {
    const float grey = i == 0 ? 0.0f : 65504 * std::exp2(-32 + 32 * float(i) / 4000);
    const vec3 c = map(vec3(grey));
    CAPTURE(grey, c.x, c.y, c.z);
    for (int k = 0; k < 3; ++k) {
      REQUIRE(std::isfinite(c[k]));
      REQUIRE(c[k] >= 0);
      REQUIRE(c[k] <= 1);
    }
    REQUIRE(c.y >= before - slack);
    before = std::fmax(before, c.y);
  }
  CHECK(map(vec3(0)).y == Approx(0).margin(1e-6));
  CHECK(before > 0.97f);
}

/// Saturated and mixed colours over the same range.
void checkColours(vec3 (*map)(vec3)) {
  for (const vec3 colour :
       {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(1, 1, 0), vec3(1, 0.5f, 0.1f), vec3(0, 0.001f, 1)})
    for (int i = 0; i <= 400; ++i) {
      const vec3 c = map(colour * (65504 * std::exp2(-32 + 32 * float(i) / 400)));
      for (int k = 0; k < 3; ++k) {
        REQUIRE(std::isfinite(c[k]));
        REQUIRE(c[k] >= 0);
        REQUIRE(c[k] <= 1);
      }
    }
}

}  // namespace

TEST_CASE("Neutral") {
  checkCases(kNeutral, f64::tonemapNeutral, f32::tonemapNeutral);
  checkGreys(f32::tonemapNeutral, 0);
  checkColours(f32::tonemapNeutral);
  // Below the shoulder a colour passes unchanged but for the 0.04 that dielectrics reflect.
  const dvec3 in(0.5, 0.3, 0.18);
  CHECK(glm::length(f64::tonemapNeutral(in) - (in - 0.04)) < 1e-12);
  // No step where the shoulder and the toe begin.
  const auto grey = [](double x) { return f64::tonemapNeutral(dvec3(x)).x; };
  CHECK(grey(0.8 + 1e-9) - grey(0.8 - 1e-9) == Approx(2e-9).margin(1e-10));
  CHECK(grey(0.08 + 1e-9) - grey(0.08 - 1e-9) == Approx(2e-9).margin(1e-10));
}

TEST_CASE("ACES") {
  checkCases(kAces, f64::tonemapAces, f32::tonemapAces);
  checkGreys(f32::tonemapAces, 2e-6f);
  checkColours(f32::tonemapAces);
}

TEST_CASE("AgX") {
  checkCases(kAgx, f64::tonemapAgx, f32::tonemapAgx);
  checkGreys(f32::tonemapAgx, 2e-5f);
  checkColours(f32::tonemapAgx);
}

TEST_CASE("no tone map clamps") { CHECK(f64::tonemapNone(dvec3(-1, 0.25, 7)) == dvec3(0, 0.25, 1)); }

TEST_CASE("the sRGB transfer function, exact and fast") {
  CHECK(f64::srgbFromLinear(0) == 0);
  CHECK(f64::srgbFromLinear(1) == Approx(1));
  CHECK(f64::srgbFromLinear(0.18) == Approx(0.46135613));
  CHECK(f64::linearFromSrgb(0.5) == Approx(0.21404114));
  double worst = 0, at = 0, before = 0;
  for (int i = 0; i <= 1'000'000; ++i) {
    const double x = i / 1e6, exact = f64::srgbFromLinear(x), fast = double(f32::srgbFromLinearFast(float(x)));
    if (std::abs(fast - exact) > worst) worst = std::abs(fast - exact), at = x;
    if (fast < before - 1e-6) FAIL("falls at " << x);
    before = fast;
  }
  WARN("srgbFromLinearFast: off by at most " << worst * 255 << "/255, at " << at);
  CHECK(worst <= 0.1 / 255);
  for (int code = 0; code < 256; ++code) {
    CHECK(std::round(f32::srgbFromLinear(f32::linearFromSrgb(float(code) / 255)) * 255) == float(code));
    CHECK(std::round(f32::srgbFromLinearFast(f32::linearFromSrgb(float(code) / 255)) * 255) == float(code));
  }
}
