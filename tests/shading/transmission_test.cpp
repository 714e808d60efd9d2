// Light that crosses a surface (shaders/shading/transmission.h), against geometry and Fresnel's equations worked out here.
#include <catch2/catch.hpp>

#include <random>

#include "reference/shading.h"

namespace f32 = burnish::shading::f32;
namespace f64 = burnish::shading::f64;
using glm::dvec3;

namespace {

dvec3 toEyeAt(double cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }
const dvec3 kNormal(0, 0, 1);

}  // namespace

TEST_CASE("index and reflectance at normal incidence are each other's inverse", "[transmission]") {
  for (double eta : {1.0, 1.2, 1.33, 1.5, 2.4, 10.0}) {
    CHECK(f64::indexFromF0(f64::f0FromIndex(eta)) == Approx(eta));
    CHECK(f32::indexFromF0(f32::f0FromIndex(float(eta))) == Approx(eta).epsilon(1e-3));
  }
  CHECK(std::isfinite(f64::indexFromF0(1)));
}

TEST_CASE("Schlick's equation with schlickF0 gives the exact reflectance", "[transmission]") {
  for (double f0 : {0.02, 0.04, 0.25, 1.0})
    for (double c : {1.0, 0.8, 0.5, 0.2, 0.02}) {
      const double w = std::pow(1 - c, 5), s = f64::schlickF0(f0, c, FRESNEL_DIELECTRIC);
      CHECK(s + (1 - s) * w == Approx(f64::F_dielectric(f0, c)).epsilon(1e-6));
      CHECK(f64::schlickF0(f0, c, FRESNEL_SCHLICK) == f0);
      CHECK(std::isfinite(f32::schlickF0(float(f0), 0.0f, FRESNEL_DIELECTRIC)));
    }
}

TEST_CASE("a slab lets light out as it came in, after thickness / cos t", "[transmission]") {
  for (double eta : {1.0, 1.33, 1.8})
    for (double c : {1.0, 0.7, 0.3, 0.05}) {
      dvec3 way, direction;
      const double path = f64::throughBody(toEyeAt(c), kNormal, eta, 0.4, 0.0, way, direction);
      const double c2 = std::sqrt(1 - (1 - c * c) / (eta * eta));
      CHECK(path == Approx(0.4 / c2));
      CHECK(way.z == Approx(-0.4));
      CHECK(glm::length(direction + toEyeAt(c)) < 1e-9);
    }
}

TEST_CASE("a ball: the way ends on its surface, and light leaves at the angle at which it came", "[transmission]") {
  for (double eta : {1.0, 1.33, 1.8})
    for (double c : {1.0, 0.7, 0.3, 0.05}) {
      dvec3 way, direction;
      const double radius = 0.6, path = f64::throughBody(toEyeAt(c), kNormal, eta, 2 * radius, 1.0, way, direction);
      const dvec3 outward = kNormal + way / radius;
      CHECK(glm::length(way) == Approx(path));
      CHECK(glm::length(outward) == Approx(1));
      CHECK(glm::dot(direction, outward) == Approx(c).margin(1e-6));
      CHECK(glm::length(direction) == Approx(1));
    }
}

TEST_CASE("bodies between slab and ball, absurd numbers and grazing eyes stay finite", "[transmission]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const float c = i % 3 ? any(random) : any(random) * 1e-6f, eta = 1 + (i % 5 ? any(random) : any(random) * 99), thickness = i % 7 ? any(random) : 1e9f;
    const glm::vec3 v(std::sqrt(1 - c * c), 0, c);
    glm::vec3 way, direction;
    const float path = f32::throughBody(v, {0, 0, 1}, eta, thickness, any(random) * 2 - 0.5f, way, direction);
    REQUIRE(std::isfinite(path));
    REQUIRE(path >= 0);
    REQUIRE(std::isfinite(way.x + way.y + way.z));
    REQUIRE(std::abs(glm::length(direction) - 1) < 1e-3f);
    const glm::vec3 left = f32::absorbed({0, 1, 1e9f}, path);
    REQUIRE((left.x == 1 && left.y >= 0 && left.y <= 1 && left.z >= 0 && left.z <= 1));
  }
}

TEST_CASE("faint reflections fade with F0 and are whole from water on", "[transmission]") {
  CHECK(f64::faintReflection(0) == 0);
  CHECK(f64::faintReflection(0.0098) == Approx(0.5));
  CHECK(f64::faintReflection(0.0196) == Approx(1));
  CHECK(f64::faintReflection(0.2) == 1);
  CHECK(f64::scatteredAngle(0.3, 1.0) == 0);
  CHECK(f64::scatteredAlpha(0.3, 3.0) == Approx(0.3));
}
