// Light sources: punctual ones, balls, mirrors of emitters, surroundings; techniques that must agree.
#include <catch2/catch.hpp>

#include "light_scenes.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
using glm::vec3;
using pathtrace::Technique;

namespace {

constexpr double kPi = kTurn / 2;

void checkAgree(const pathtrace::World& world, const pathtrace::PathRay& ray, int samples) {
  const Mean both = see(world, ray, samples).light[0], lights = see(world, ray, samples, -1, Technique::Lights, 2).light[0], surfaces = see(world, ray, samples, -1, Technique::Surfaces, 3).light[0];
  CAPTURE(both.value(), both.error(), lights.value(), lights.error(), surfaces.value(), surfaces.error());
  CHECK(both.error() < 0.01 * both.value());
  CHECK(std::abs(both.value() - lights.value()) < 3 * std::hypot(both.error(), lights.error()));
  CHECK(std::abs(both.value() - surfaces.value()) < 3 * std::hypot(both.error(), surfaces.error()));
  // The weights are worth having: the two together are not much worse than the better one.
  CHECK(both.error() < 1.6 * std::min(lights.error(), surfaces.error()));
}

}  // namespace

TEST_CASE("light: a Lambertian ball under a directional light and under even surroundings") {
  Setting s;
  s.add(ball(vec3(0), 1, 48), lambert(vec3(0.8f)));
  const dvec3 toLight = glm::normalize(dvec3(1, 1, 0.5));
  s.light({.kind = LightKind::Directional, .intensity = 3, .castsShadow = true, .angularDiameter = 0}, dvec3(0), -toLight);
  const pathtrace::World world = s.world(lambertQuality());
  int lit = 0, dark = 0;
  for (double x = -0.9; x < 1; x += 0.19)
    for (double y = -0.85; y < 0.9; y += 0.17) {
      const auto ray = rayFrom({x, y, 4}, {x, y, 0});
      pathtrace::SurfacePoint p;
      if (!world.nearest(ray, p)) continue;
      const double above = glm::dot(dvec3(p.geometric), toLight), cosine = glm::dot(glm::normalize(dvec3(p.normal)), toLight);
      if (std::abs(above) < 0.03) continue;  // facets and smooth normals disagree there on what is lit
      const Seen seen = see(world, ray, 8);
      (above > 0 ? lit : dark) += 1;
      CAPTURE(x, y, above);
      CHECK(seen.value() == Approx(above > 0 ? 0.8 / kPi * 3 * std::max(cosine, 0.0) : 0.0).epsilon(1e-4).margin(1e-5));
    }
  CHECK(lit > 30);
  CHECK(dark > 10);
  s.scene.lights = {};
  s.scene.environment.color = vec3(1);
  const pathtrace::World even = s.world(lambertQuality());
  for (const double x : {0.0, 0.5, 0.9}) checkSeen(see(even, rayFrom({x, 0.1, 4}, {x, 0.1, 0}), 4096).light[0], 0.8);
}

TEST_CASE("light: a ball of light over a plane lights it as pi L (r/d)^2 cos") {
  Setting s;
  s.add(rectangle(vec3(0), {3, 0, 0}, {0, 0, -3}), lambert(vec3(0.5f)));
  s.add(ball({0, 2, 0}, 0.5f, 64), lambert(vec3(0), vec3(10)));
  const pathtrace::World world = s.world(lambertQuality());
  for (const double x : {0.0, 1.0, 2.5}) {
    const double d2 = 4 + x * x, exact = 0.5 * 10 * (0.25 / d2) * (2 / std::sqrt(d2));
    CAPTURE(x);
    // Corners lie on the ball, faces within: by up to 1 - cos²(pi/128) smaller.
    checkSeen(see(world, rayFrom({x, 1, 1.5}, {x, 0, 0}), 32768).light[0], exact, 1.5e-3);
  }
}

TEST_CASE("light: many lamps, of which one is chosen, give what all of them give") {
  for (const int count : {3, 40, 150}) {
    Setting s;
    s.add(rectangle(vec3(0), {5, 0, 0}, {0, 0, -5}), {.name = "floor", .albedo = {0.7f, 0.4f, 0.2f}, .substance = 0.7f, .roughness = 0.5f});
    Dice dice(11);
    for (int i = 0; i < count; ++i) {
      const dvec3 place(8 * dice.next() - 4, 0.2 + 2 * dice.next(), 8 * dice.next() - 4);
      Light lamp{.kind = i % 3 == 0 ? LightKind::Spot : LightKind::Point, .color = {1, dice.next(), dice.next()}, .intensity = 1 + 20 * dice.next(), .range = i % 7 == 0 ? 0 : 1 + 5 * dice.next(), .innerCone = 0.3f, .outerCone = 1.2f};
      lamp.castsShadow = i % 2 == 0;
      s.light(lamp, place, {dice.next() - 0.5, -1, dice.next() - 0.5});
    }
    s.light({.kind = LightKind::Directional, .intensity = 0.7f}, dvec3(0), {0.3, -1, 0.1});
    const Quality quality;
    const pathtrace::World world = s.world(quality);
    for (const dvec3& at : {dvec3(0), dvec3(2, 0, -1.5), dvec3(-3.9, 0, 3)}) {
      const dvec3 eye = at + dvec3(0.3, 1, 0.8);
      reference::OracleSurface o;
      o.n = {0, 1, 0}, o.v = glm::normalize(eye - at), o.albedo = {0.7, 0.4, 0.2}, o.substance = 0.7, o.alpha = 0.25;
      std::vector<reference::OracleLight> lights;
      for (const pathtrace::PunctualLight& l : world.lights()) {
        const dvec3 to = l.position - at, dir = l.directional ? dvec3(l.toLight) : glm::normalize(to);
        const double d2 = glm::dot(to, to), w = std::clamp(1 - d2 * d2 * double(l.invRange4), 0.0, 1.0);
        double e = l.directional ? 1 : w * w / d2;
        if (l.spot) e *= std::pow(std::clamp(-glm::dot(dvec3(l.axis), dir) * double(l.spotScale) + double(l.spotOffset), 0.0, 1.0), 2);
        lights.push_back({dir, dvec3(l.power) * e});
      }
      const dvec3 exact = reference::shade(o, lights, world.rungs());
      CAPTURE(count, at.x);
      const Seen seen = see(world, rayFrom(eye, at), 8192);
      for (std::size_t c = 0; c < 3; ++c) checkSeen(seen.light[c], exact[int(c)], 5e-4);
    }
  }
}

TEST_CASE("light: half of a light's disc behind an edge is half its light") {
  for (const bool sun : {false, true}) {
    Setting s;
    s.add(rectangle(vec3(0), {2, 0, 0}, {0, 0, -2}), lambert(vec3(0.9f)));
    // Its edge is at x = 0, on the way from the origin to the light's middle.
    s.add(rectangle({-2, 1, 0}, {2, 0, 0}, {0, 0, -2}), lambert(vec3(0)));
    if (sun) s.light({.kind = LightKind::Directional, .intensity = 4, .castsShadow = true, .angularDiameter = 0.2f}, dvec3(0), {0, -1, 0});
    else s.light({.kind = LightKind::Point, .intensity = 16, .castsShadow = true, .sourceRadius = 0.3f}, {0, 2, 0}, {0, -1, 0});
    const pathtrace::World world = s.world(lambertQuality());
    CAPTURE(sun);
    checkSeen(see(world, rayFrom({0.4, 0.5, 0.2}, {0, 0, 0}), 16384).light[0], 0.5 * 0.9 / kPi * 4, 2e-3);
    const double beside = glm::length(dvec3(1, 2, 0));
    checkSeen(see(world, rayFrom({1.2, 0.5, 0.2}, {1, 0, 0}), 64).light[0], 0.9 / kPi * (sun ? 4 : 16 / (beside * beside) * 2 / beside), 2e-3);
    CHECK(see(world, rayFrom({-0.6, 0.5, 0.2}, {-1, 0, 0}), 64).value() == 0);
  }
}

TEST_CASE("light: a smooth metal mirrors an emitter") {
  Setting s;
  s.add(rectangle(vec3(0), {2, 0, 0}, {0, 0, -2}), {.name = "mirror", .albedo = vec3(0.6f), .substance = 1, .roughness = 0});
  s.add(rectangle({3, 2, 0}, {0, 0, 1}, {0, 1, 0}), lambert(vec3(0), vec3(5)));
  Quality q;
  q.fresnel = Fresnel::None;
  const pathtrace::World world = s.world(q);
  checkSeen(see(world, rayFrom({-1.5, 1, 0}, {0, 0, 0}), 1024).light[0], 0.6 * 5, 2e-3);
}

TEST_CASE("light: light sampling, surface sampling and both together agree") {
  for (const float r : {0.15f, 0.4f, 0.9f}) {
    CAPTURE(r);
    Setting s;
    s.add(rectangle(vec3(0), {2, 0, 0}, {0, 0, -2}), {.name = "floor", .albedo = vec3(0.8f), .substance = 0.7f, .roughness = r});
    s.add(rectangle({1.5, 1, 0}, {0, 0, 0.4f}, {0, 0.4f, 0}), lambert(vec3(0.3f), vec3(20)));
    s.add(rectangle({-1.5, 0.5f, 0}, {0, 0, 0.3f}, {0.1f, 0.3f, 0}), lambert(vec3(0.5f), vec3(0)));
    Quality q;
    REQUIRE(setPreset(q, "exact").has_value());
    checkAgree(s.world(q), rayFrom({-1.2, 0.9, 0.1}, {0.1, 0, 0}), 32768);

    Setting sky;
    sky.add(rectangle(vec3(0), {2, 0, 0}, {0, 0, -2}), {.name = "floor", .albedo = vec3(0.8f), .substance = 0.7f, .roughness = r});
    sky.add(box({0.5, 0, -0.5}, {0.8f, 0.4f, 0.5f}, false), lambert(vec3(0.5f)));
    Image map = makeImage(64, 32, 3, PixelType::F32);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 64; ++x) {
        const float light = std::abs(x - 48) < 4 && std::abs(y - 8) < 4 ? 30.0f : 0.5f + 0.5f * float(y) / 32;
        std::fill_n(map.f32() + 3 * (64 * y + x), 3, light);
      }
    sky.scene.environment.map = std::move(map);
    checkAgree(sky.world(q), rayFrom({-1.2, 0.9, 0.1}, {-0.1, 0, 0}), 32768);
  }
}
