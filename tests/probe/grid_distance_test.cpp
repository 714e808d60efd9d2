// Where directions lie in a map of distances.
#include <burnish/scene.h>

#include <catch2/catch.hpp>
#include <random>

#include "reference/shading.h"

using namespace burnish;
namespace f32 = shading::f32;
namespace f64 = shading::f64;

TEST_CASE("a direction's texel and back") {
  constexpr double kSize = AmbientGrid::kDistanceSize;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, kSize);
  for (int i = 0; i < 100'000; ++i) {
    const double x = place(random), y = place(random);
    const glm::dvec3 d = f64::distanceDirection(x, y, kSize);
    REQUIRE(glm::length(d) == Approx(1).margin(1e-12));
    const glm::dvec2 back = f64::distanceTexel(d * place(random), kSize);
    REQUIRE(glm::length(back - glm::dvec2(x, y)) < 1e-9);
    REQUIRE(glm::length(glm::dvec2(f32::distanceTexel(f32::distanceDirection(float(x), float(y), float(kSize)), float(kSize))) - glm::dvec2(x, y)) < 1e-4);
  }
}

TEST_CASE("the axes of a map of distances") {
  const double half = AmbientGrid::kDistanceSize / 2.0, size = 2 * half;
  CHECK(glm::length(f64::distanceDirection(half, half, size) - glm::dvec3(0, 0, 1)) < 1e-12);
  CHECK(glm::length(f64::distanceDirection(size, half, size) - glm::dvec3(1, 0, 0)) < 1e-12);
  CHECK(glm::length(f64::distanceDirection(half, size, size) - glm::dvec3(0, 1, 0)) < 1e-12);
  for (const glm::dvec2 corner : {glm::dvec2(0, 0), glm::dvec2(size, 0), glm::dvec2(0, size), glm::dvec2(size, size)})
    CHECK(glm::length(f64::distanceDirection(corner.x, corner.y, size) - glm::dvec3(0, 0, -1)) < 1e-12);
  CHECK(f64::distanceLimit(glm::dvec3(1, 2, 2)) == 4.5);
}
