// Rungs through the whole pipeline against the double oracle: a sphere under one light, and the white furnace.
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "plan/rungs.h"
#include "reference/oracle.h"
#include "render/scenes.h"

using namespace burnish;
using namespace burnish::test;
namespace f64 = burnish::shading::f64;

namespace {

constexpr glm::ivec2 kSize{120, 120};
const View kView = lookAt({0, 0.5, 4}, {0, 0, 0}, {0, 1, 0}, 0.6f);
const dvec3 kToLight = glm::normalize(dvec3(0.6, 0.7, 0.5));

/// Where a pixel's ray meets the unit sphere.
struct Seen {
  int x, y;
  dvec3 n, v;
};
std::vector<Seen> seenSphere(double leastNov, int step = 1) {
  std::vector<Seen> all;
  for (int y = step / 2; y < kSize.y; y += step)
    for (int x = step / 2; x < kSize.x; x += step) {
      const Ray r = rayThrough(kView, kSize, x + 0.5, y + 0.5);
      const double b = glm::dot(r.origin, r.direction), d = b * b - glm::dot(r.origin, r.origin) + 1;
      if (d <= 0) continue;
      const dvec3 n = r.origin + r.direction * (-b - std::sqrt(d));
      if (glm::dot(n, -r.direction) >= leastNov) all.push_back({x, y, n, -r.direction});
    }
  return all;
}

/// A half metal whose numbers lie on the G-buffer's codes: what is left is the normal's rounding.
struct OnCodes {
  dvec3 albedo{std::pow(220.0 / 255, 2), std::pow(150.0 / 255, 2), std::pow(90.0 / 255, 2)};
  double substance = 160.0 / 255, alpha = f64::decodeAlpha(200.0 / 255);
  [[nodiscard]] Material material() const {
    Material m;
    m.albedo = vec3(albedo);
    m.substance = float(substance);
    m.roughness = float(std::sqrt(alpha));
    return m;
  }
};

/// Every rung of the terms of one light direction, each distribution with each geometry.
std::vector<std::pair<std::string, Quality>> directQualities() {
  std::vector<std::pair<std::string, Quality>> all;
  for (std::size_t t = 0; t < 8; ++t)
    for (std::size_t r = 0; r < terms()[t].rungs.size(); ++r) {
      Quality q;
      if (terms()[t].name == "normalization") q.geometry = Geometry::Void;
      if (terms()[t].name == "distribution" || terms()[t].name == "geometry") continue;
      setRung(q, t, r);
      if (forwardOnlyRung(q).empty()) all.emplace_back(fmt::format("{}={}", terms()[t].name, terms()[t].rungs[r].name), q);
    }
  for (std::size_t d = 0; d < terms()[1].rungs.size(); ++d)
    for (std::size_t g = 0; g < terms()[2].rungs.size(); ++g) {
      Quality q;
      setRung(q, 1, d);
      setRung(q, 2, g);
      all.emplace_back(fmt::format("{}, {}", terms()[1].rungs[d].name, terms()[2].rungs[g].name), q);
    }
  Quality whole;
  whole.compensation = Compensation::MultipleScattering;
  whole.diffuse = Diffuse::Coupled;
  all.emplace_back("compensation and coupled diffuse", whole);
  whole.specular = Specular::GgxSmith;
  all.emplace_back("the same with ggx-smith", whole);
  // The table of void geometry is made with the exact normalization: others scale it.
  for (Normalization n : {Normalization::LinearFit, Normalization::Plus2, Normalization::Plus8}) {
    Quality bare;
    bare.geometry = Geometry::Void;
    bare.diffuse = Diffuse::Coupled;
    bare.compensation = Compensation::MultipleScattering;
    bare.normalization = n;
    all.emplace_back(fmt::format("{}, compensation and coupled diffuse", terms()[3].rungs[std::size_t(n)].name), bare);
  }
  REQUIRE(setPreset(whole, "seed"));
  all.emplace_back("seed", whole);
  REQUIRE(setPreset(whole, "exact"));
  all.emplace_back("exact", whole);
  return all;
}

/// The furnace: radiance over the surroundings' at each pixel seen, first channel.
std::vector<std::pair<Seen, double>> furnace(Stage& stage, const Material& m, const Quality& quality) {
  Scene scene;
  place(scene, sphere(1, 96, 192), m);
  scene.environment.color = vec3(10);
  const Picture p = stage.linear(scene, kView, kSize, quality);
  std::vector<std::pair<Seen, double>> all;
  for (const Seen& s : seenSphere(0.2, 12)) all.emplace_back(s, p.at(s.x, s.y).x / 10);
  REQUIRE(all.size() > 25);
  return all;
}

Material white(double roughness, float substance) {
  Material m;
  m.albedo = vec3(1);
  m.substance = substance;
  m.roughness = float(roughness);
  return m;
}

}  // namespace

TEST_CASE("rungs of one light equal the double oracle on a sphere", "[sweep]") {
  Stage stage;
  const OnCodes surface;
  Scene scene;
  place(scene, sphere(1, 192, 384), surface.material());
  addLight(scene, light(LightKind::Directional, vec3(1), 100), {0, 0, 0}, -kToLight);
  const std::vector<Seen> seen = seenSphere(0.2);
  double worst = 0;
  std::string where;
  for (const auto& [name, quality] : directQualities()) {
    INFO(name);
    const shading::Rungs rungs = plan::rungsOf(quality);
    const auto energy = needsAlbedoTable(rungs) ? std::make_unique<reference::LobeEnergy>(rungs, surface.alpha) : nullptr;
    const Picture p = stage.linear(scene, kView, kSize, quality);
    std::vector<dvec3> wanted;
    double peak = 0;
    for (const Seen& s : seen) {
      const f64::Surface m = reference::surfaceOf({s.n, s.v, surface.albedo, surface.substance, surface.alpha}, energy.get());
      wanted.push_back(f64::shadeDirection(m, kToLight, energy ? energy->at(glm::dot(m.n, kToLight)) : glm::dvec2(0), rungs) * 100.0);
      peak = std::max(peak, wanted.back().x);
    }
    Errors e;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      // The models without a cosine end with a step, where a rounded normal decides.
      if (std::abs(glm::dot(seen[i].n, kToLight)) < 0.01) continue;
      const dvec3 d = glm::abs(p.at(seen[i].x, seen[i].y) - wanted[i]);
      for (int c = 0; c < 3; ++c) e.add(d[c] / (wanted[i][c] + 0.01 * peak), 0.005);
    }
    if (e.largest > worst) worst = e.largest, where = name;
    CHECK(e.count > 15000);
    CHECK(e.largest < 0.015);
    CHECK(e.share() > 0.99);
  }
  std::cout << fmt::format("  {} qualities: largest error {:.2f} % ({})\n", directQualities().size(), 100 * worst, where);
}

TEST_CASE("white furnace: default rungs show their directional albedo, compensated ones all of it") {
  Stage stage;
  Quality whole;
  whole.compensation = Compensation::MultipleScattering;
  whole.diffuse = Diffuse::Coupled;
  Quality wholeGgx = whole;
  wholeGgx.specular = Specular::GgxSmith;
  for (const auto& [material, substance] : {std::pair("metal", 1.0f), std::pair("plastic", 1.0f / 3)})
    for (double roughness : {0.1, 0.3, 0.6, 1.0}) {
      const Material m = white(roughness, substance);
      double specular = 0, all = 0, one = 0, sampled = 0;
      const shading::Rungs rungs = plan::rungsOf({});
      for (const auto& [s, got] : furnace(stage, m, {})) {
        const auto wanted = reference::directionalAlbedo({s.n, s.v, dvec3(1), double(substance), roughness * roughness}, rungs);
        all = std::max(all, std::abs(got / (wanted.specular.x + wanted.diffuse.x) - 1));
        specular = std::max(specular, got);
      }
      for (const Quality& q : {whole, wholeGgx})
        for (const auto& [s, got] : furnace(stage, m, q)) one = std::max(one, std::abs(got - 1));
      Quality brute;
      brute.environmentSpecular = EnvironmentSpecular::Sampled;
      const auto table = furnace(stage, m, {}), samples = furnace(stage, m, brute);
      for (std::size_t i = 0; i < table.size(); ++i) sampled = std::max(sampled, std::abs(samples[i].second / table[i].second - 1));
      std::cout << fmt::format("  white {:<7} roughness {:<3}: default off its directional albedo by {:.2f} %, at most {:.4f}; compensated off 1 by {:.2f} %; sampled off dfg by {:.2f} %\n", material, roughness,
                               100 * all, specular, 100 * one, 100 * sampled);
      CHECK(all < 0.02);
      CHECK(one < 0.02);
      CHECK(sampled < 0.02);
    }
}
