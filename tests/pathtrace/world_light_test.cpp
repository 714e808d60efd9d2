// Surroundings and emissive triangles as sources: densities integrate to 1 and follow the light.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "world_scenes.h"

using namespace burnish;
using namespace burnish::test;
using pathtrace::EmitterSample;
using pathtrace::EnvironmentSample;
using pathtrace::World;

namespace {

constexpr double kPi = std::numbers::pi;

/// Dim, with a bright spot beside the left edge, a bright pole and a black half.
Environment spotted() {
  Environment e;
  e.map = makeImage(32, 16, 3, PixelType::F32);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x)
      for (int c = 0; c < 3; ++c) e.map.f32()[(y * 32 + x) * 3 + c] = x == 0 && y == 6 ? 500.0f : y == 0 ? 20.0f : x < 16 ? float(c + 1) : 0.0f;
  e.scale = 2;
  return e;
}
glm::dvec3 directionAt(double u, double v) {
  const double turn = (u - 0.5) * 2 * kPi, polar = v * kPi;
  return {std::sin(polar) * std::sin(turn), std::cos(polar), -std::sin(polar) * std::cos(turn)};
}

}  // namespace

TEST_CASE("world: the density of directions to the surroundings integrates to 1 and is above 0 where there is light", "[world]") {
  Scene scene;
  scene.environment = spotted();
  const World world = worldOf(scene);
  REQUIRE(world.hasEnvironment());
  double sum = 0;
  glm::dvec3 light(0);
  const int n = 16;  // places a texel and axis
  for (int y = 0; y < 16 * n; ++y)
    for (int x = 0; x < 32 * n; ++x) {
      const double v = (y + 0.5) / (16 * n), solid = std::sin(v * kPi) * 2 * kPi * kPi / (16 * n * 32 * n);
      const glm::vec3 d(directionAt((x + 0.5) / (32 * n), v)), radiance = world.environment(d);
      const float density = world.environmentDensity(d);
      sum += density * solid;
      light += glm::dvec3(radiance) * solid;
      if (radiance != glm::vec3(0)) REQUIRE(density > 0);
    }
  CHECK(sum == Approx(1).margin(2e-4));  // the midpoint rule over a texel: (pi/256)²/24 of it at the poles
  // The mean of radiance over density is the integral, and no sample is worth more than a few times the mean: light is drawn where it is.
  glm::dvec3 mean(0);
  double most = 0;
  for (int i = 0; i < 256; ++i)
    for (int k = 0; k < 256; ++k) {
      const EnvironmentSample s = world.sampleEnvironment({(float(i) + 0.5f) / 256, (float(k) + 0.5f) / 256});
      REQUIRE(s.density > 0);
      REQUIRE(glm::length(s.direction) == Approx(1).margin(1e-5));
      CHECK(s.density == Approx(world.environmentDensity(s.direction)).epsilon(1e-3));
      mean += glm::dvec3(s.radiance) / double(s.density) / 65536.0;
      most = std::max(most, double(s.radiance.g / s.density));
    }
  for (int c = 0; c < 3; ++c) CHECK(mean[c] == Approx(light[c]).epsilon(0.01));
  // Of a texel's neighbourhood the brightest counts: up to the nine texels around the spot are drawn like it.
  CHECK(most < 12 * light.g);
}

TEST_CASE("world: the lat-long picture's middle lies toward -Z, its right toward +X, its top up", "[world]") {
  Scene scene;
  scene.environment.map = makeImage(64, 32, 3, PixelType::F32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) scene.environment.map.f32()[(y * 64 + x) * 3] = float(x) / 64, scene.environment.map.f32()[(y * 64 + x) * 3 + 1] = float(y) / 32;
  const World world = worldOf(scene);
  CHECK(world.environment({0, 0, -1}).r == Approx(0.5 - 0.5 / 64).margin(1e-4));
  CHECK(world.environment({1, 0, 0}).r == Approx(0.75 - 0.5 / 64).margin(1e-4));
  CHECK(world.environment({0, 1, 0}).g == Approx(0).margin(1e-4));
  CHECK(world.environment({0, -1, 0}).g == Approx(31 / 32.0).margin(1e-4));
}

TEST_CASE("world: emissive triangles are drawn by power, evenly over their area", "[world]") {
  Scene scene;
  Material weak, strong;
  weak.emission = glm::vec3(1);
  strong.emission = glm::vec3(3);
  add(scene, panel(), weak, moved({-2, 0, 0}));
  add(scene, panel(0.5f), strong, moved({2, 0, 0}));
  add(scene, panel(), Material{}, moved({0, 3, 0}));
  const World world = worldOf(scene);
  REQUIRE(world.hasEmitters());
  const auto a = met(world, toward({-2, 0.1, 2}, {-2, 0.1, 0})), b = met(world, toward({2, 0.1, 2}, {2, 0.1, 0})), c = met(world, toward({0, 3, 2}, {0, 3, 0}));
  // Powers 4 and 3.
  CHECK(world.emitterDensity(a.emitter) == Approx(4 / 7.0 / 4).epsilon(1e-4));
  CHECK(world.emitterDensity(b.emitter) == Approx(3 / 7.0 / 1).epsilon(1e-4));
  CHECK(c.emitter == -1);
  CHECK(world.emitterDensity(-1) == 0);
  double area = 0, power = 0;
  int front = 0;
  const int n = 64;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j) {
        EmitterSample s;
        if (!world.sampleEmitter({0, 0, 5}, (float(i) + 0.5f) / n, {(float(k) + 0.5f) / n, (float(j) + 0.5f) / n}, s)) continue;
        ++front;
        area += 1 / double(s.density);
        power += double(s.radiance.r) / double(s.density);
        REQUIRE(s.position.z == Approx(0).margin(1e-5));
        REQUIRE(s.normal.z == Approx(1));
      }
  CHECK(front == n * n * n);
  CHECK(area / (n * n * n) == Approx(5).epsilon(0.02));   // 64 picks split 4/7 : 3/7 to a 64th
  CHECK(power / (n * n * n) == Approx(7).epsilon(1e-3));  // radiance over density is the same everywhere
  EmitterSample s;
  CHECK_FALSE(world.sampleEmitter({0, 0, -5}, 0.5f, {0.5f, 0.5f}, s));  // one-sided
}

TEST_CASE("world: lights are the scene's, without stand-ins and without an end that no range gives", "[world]") {
  Scene scene;
  const Id<Node> node = scene.nodes.add({.local = moved({1, 2, 3})});
  scene.lights.add({.kind = LightKind::Point, .node = node, .intensity = 100});
  scene.lights.add({.kind = LightKind::Point, .node = node, .intensity = 100, .range = 4});
  scene.lights.add({.kind = LightKind::Point, .node = node, .intensity = 100, .standIn = true});
  scene.lights.add({.kind = LightKind::Directional, .node = node, .intensity = 5});
  scene.lights.add({.kind = LightKind::Spot, .node = node, .intensity = 5, .enabled = false});
  const World world = worldOf(scene);
  REQUIRE(world.lights().size() == 3);
  CHECK(world.lights()[0].directional);
  CHECK(world.lights()[0].power.r == 5);
  CHECK(world.lights()[1].invRange4 == 0);
  CHECK(world.lights()[2].invRange4 == Approx(1 / 256.0));
  CHECK(glm::length(world.lights()[1].position - glm::dvec3(1, 2, 3)) < 1e-5);
}
