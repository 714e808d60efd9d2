// The space that frames are averaged in, and how what was seen before is kept near what is seen now.
#include <catch2/catch.hpp>

#include "reference/shading.h"
#include "sphere.h"

using namespace burnish::test;
using glm::dvec3;
namespace f32 = burnish::shading::f32;
namespace f64 = burnish::shading::f64;

TEST_CASE("light is averaged as it is up to display white, on a curve past it, and comes back") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1), decades(-4, 4.6);
  for (int i = 0; i < 100'000; ++i) {
    const dvec3 c = dvec3(unit(random), unit(random), unit(random)) * std::pow(10.0, decades(random));
    const double l = f64::lumaOf(c);
    const dvec3 t = f64::compressLight(c);
    if (l <= 1) REQUIRE(t == c);
    if (l > 1) REQUIRE(f64::lumaOf(t) == Approx(2 - 1 / l).epsilon(1e-12));
    REQUIRE(f64::lumaOf(t) < 2);
    REQUIRE(glm::length(f64::expandLight(t) - c) <= 1e-7 * glm::length(c));
    const glm::vec3 back = f32::expandLight(f32::compressLight(glm::vec3(c)));
    // 2 - luma loses l times what luma is off: half an ulp of 2 for each of its three products and two sums.
    REQUIRE(double(glm::length(back - glm::vec3(c))) <= (4e-6 + 6e-7 * l) * glm::length(c));
  }
  // Smooth where the curve begins.
  CHECK(f64::lumaOf(f64::compressLight(dvec3(1 + 1e-6))) - f64::lumaOf(f64::compressLight(dvec3(1 - 1e-6))) == Approx(2e-6).epsilon(1e-3));
}

TEST_CASE("what was seen before is clipped to the box of what is around, along its line to the middle") {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> some(-1, 1), size(0, 0.5);
  for (int i = 0; i < 100'000; ++i) {
    const dvec3 middle(some(random), some(random), some(random)), old(some(random), some(random), some(random)), extent(size(random), size(random), i % 3 ? size(random) : 0.0);
    const dvec3 clipped = f64::clippedToward(middle, extent, old), d = clipped - middle, whole = old - middle;
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      REQUIRE(std::abs(d[k]) <= extent[k] + 1e-12);
      inside &= std::abs(whole[k]) <= extent[k];
    }
    if (inside) REQUIRE(glm::length(clipped - old) < 1e-12);
    REQUIRE(glm::length(glm::cross(d, whole)) < 1e-12);
    REQUIRE(glm::dot(d, whole) >= 0);
  }
  CHECK(f64::clippedToward(dvec3(0.5), dvec3(0), dvec3(0.5)) == dvec3(0.5));
}

TEST_CASE("a grey is not clipped for what rounding makes of it, a colour that was not there is") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<float> some(0.01f, 1), off(-1, 1);
  for (int i = 0; i < 10'000; ++i) {
    // Three neighbours of one grey each, no two alike: differences of colour have no spread.
    const float grey = some(random), wide = 0.2f * grey, step = grey / 4096;
    const glm::vec3 middle(grey, 0, 0), spread(wide, 0, 0);
    const glm::vec3 rounded(grey + 0.5f * wide, off(random) * step, off(random) * step);
    REQUIRE(f32::clippedToward(middle, f32::clipBox(middle, spread), rounded) == rounded);
    const glm::vec3 red(grey, 0.2f * grey, 0), clipped = f32::clippedToward(middle, f32::clipBox(middle, spread), red);
    REQUIRE(double(glm::length(clipped - middle)) < 0.003 * double(grey));
  }
}

TEST_CASE("Catmull-Rom weights add up to 1, pass through pixels and keep straight lines and parabolas") {
  for (int i = 0; i <= 100; ++i) {
    const double f = i / 100.0;
    const auto w = f64::catmullRom(f);
    CHECK(w.x + w.y + w.z + w.w == Approx(1).epsilon(1e-12));
    CHECK(-w.x + w.z + 2 * w.w == Approx(f).margin(1e-12));
    CHECK(w.x + w.z + 4 * w.w == Approx(f * f).margin(1e-12));
  }
  const auto at = f64::catmullRom(0);
  CHECK((at.x == 0 && at.y == 1 && at.z == 0 && at.w == 0));
}
