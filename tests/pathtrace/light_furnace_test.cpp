// Light that goes to and fro: open and closed furnaces, parallel plates.
#include <catch2/catch.hpp>

#include "light_scenes.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
using glm::vec3;
using pathtrace::Technique;

namespace {

/// A room of one emissive, Lambertian material.
Setting room(double albedo, double emission) {
  Setting s;
  s.add(box({-1, -1, -1}, {1, 1.5f, 2}, true), lambert(vec3(float(albedo)), vec3(float(emission))));
  return s;
}

/// Radiance of two parallel strips a metre apart and 2 half wide, long in z: B = e + ρ ∫ K B, K(x) = 1/(2 (1 + x²)^(3/2)), by Nyström's method.
struct Strips {
  reference::GaussRule rule{80};
  std::vector<double> place, radiance;
  double half, albedo, emission;
  Strips(double h, double rho, double e) : radiance(rule.node.size(), e), half(h), albedo(rho), emission(e) {
    for (const double x : rule.node) place.push_back((2 * x - 1) * half);
    for (int i = 0; i < 400; ++i) {
      std::vector<double> next;
      for (const double x : place) next.push_back(at(x));
      radiance = next;
    }
  }
  [[nodiscard]] double at(double x) const {
    double sum = 0;
    for (std::size_t i = 0; i < place.size(); ++i) sum += rule.weight[i] * 2 * half * radiance[i] * 0.5 * std::pow(1 + (x - place[i]) * (x - place[i]), -1.5);
    return emission + albedo * sum;
  }
};

}  // namespace

TEST_CASE("light: a plane in even surroundings shows its directional albedo, for rungs x roughness x angle") {
  std::vector<std::pair<std::string, Quality>> qualities(4);
  qualities[0].first = "default";
  qualities[1].first = "exact";
  REQUIRE(setPreset(qualities[1].second, "exact").has_value());
  qualities[2].first = "seed";
  REQUIRE(setPreset(qualities[2].second, "seed").has_value());
  qualities[3].first = "ward";
  qualities[3].second.specular = Specular::Ward;
  for (const auto& [name, quality] : qualities)
    for (const double r : {0.1, 0.45, 1.0})
      for (const float substance : {1.0f / 3, 0.8f}) {
        Setting s;
        s.scene.environment.color = vec3(1);
        s.add(rectangle(vec3(0), {1, 0, 0}, {0, 1, 0}), {.name = "plane", .albedo = {0.9f, 0.6f, 0.3f}, .substance = substance, .roughness = float(r)});
        const pathtrace::World world = s.world(quality);
        reference::OracleSurface o;
        o.albedo = {0.9, 0.6, 0.3}, o.substance = double(substance), o.alpha = r * r;
        const bool table = needsAlbedoTable(world.rungs());
        const std::optional<reference::LobeEnergy> energy = table ? std::optional<reference::LobeEnergy>(std::in_place, world.rungs(), r * r, 96) : std::nullopt;
        for (const double nov : {0.25, 0.9}) {
          CAPTURE(name, r, substance, nov);
          o.v = dvec3(eyeAt(nov));
          const auto exact = reference::directionalAlbedo(o, world.rungs(), {64, 64}, energy ? &*energy : nullptr);
          const Seen seen = see(world, rayFrom(o.v, dvec3(0)), 4096);
          for (std::size_t c = 0; c < 3; ++c) checkSeen(seen.light[c], exact.diffuse[int(c)] + exact.specular[int(c)], table ? 2e-3 : 5e-4);
        }
      }
}

TEST_CASE("light: a closed room of albedo a and emission e shows e/(1 - a), and with given bounces the sum so far") {
  for (const double a : {0.3, 0.7, 0.9}) {
    const Setting s = room(a, 2);
    const pathtrace::World world = s.world(lambertQuality());
    const auto ray = rayFrom({0.2, 0.3, 0.1}, {-1, -0.3, 1.2});
    CAPTURE(a);
    checkSeen(see(world, ray, 16384).light[0], 2 / (1 - a));
    for (const int bounces : {0, 1, 4}) {
      double sum = 0;
      for (int i = 0; i <= bounces + 1; ++i) sum += 2 * std::pow(a, i);
      const Seen seen = see(world, ray, 8192, bounces);
      CAPTURE(bounces);
      checkSeen(seen.light[0], sum);
      checkSeen(seen.direct[0], 2 + 2 * a);
    }
  }
}

TEST_CASE("light: a room that reflects more than it gets comes to an end") {
  Setting s;
  Material wall{.name = "bright", .albedo = vec3(1), .substance = 1, .roughness = 0.66f, .emission = vec3(1)};
  s.add(box({-1, -1, -1}, {1, 1, 1}, true), wall);
  Quality q;
  q.specular = Specular::NormalizedBlinnPhong, q.fresnel = Fresnel::None;  // albedo up to 1.075
  const pathtrace::World world = s.world(q);
  const Seen seen = see(world, rayFrom({0, 0, 0}, {1, 0.3, 0.2}), 512);
  CHECK(std::isfinite(seen.value()));
  CHECK(seen.value() > 3);
}

TEST_CASE("light: two parallel strips agree with their integral equation") {
  const Strips exact(1, 0.7, 1);
  Setting s;
  s.add(rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, -100}), lambert(vec3(0.7f), vec3(1)));
  s.add(rectangle({0, 1, 0}, {1, 0, 0}, {0, 0, 100}), lambert(vec3(0.7f), vec3(1)));
  const pathtrace::World world = s.world(lambertQuality());
  for (const double x : {0.0, 0.6, 0.95}) {
    CAPTURE(x);
    checkSeen(see(world, rayFrom({0, 0.5, 0.2}, {x, 0, 0}), 8192).light[0], exact.at(x), 1e-3);
  }
}
