// H24 and H25 with captured places: the deferred path equals the forward one, blended surfaces equal opaque ones, glass under a place equals glass under the sky that the place was made from.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "probe/reflection_room.h"
#include "render/transparent.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{144, 108};

/// Uneven light with all bands.
dvec3 paint(const dvec3& at, int axis, bool positive) {
  return dvec3(2 + std::sin(2 * at.x + axis), 2 + std::cos(1.5 * at.y - at.z), positive ? 3 : 1) * (axis == 1 && positive ? 2.0 : 0.7);
}

/// Three boxes that overlap around what stands in the workshop, turned and of different sizes; the sky lights what is outside of them.
std::vector<ReflectionProbe> places() {
  std::vector<ReflectionProbe> all;
  const auto add = [&](const dvec3& center, const dvec3& half, const glm::dmat3& axes, const dvec3& capture, const char* name) {
    ReflectionProbe p = boxed(bakedFrom(paintedCube(32, axes, capture, half, paint), 32), center, half, axes);
    p.capture = center + axes * capture;
    p.fade = half * 0.4;
    p.margin = 0.3;
    p.name = name;
    all.push_back(std::move(p));
  };
  add({-0.6, 0.1, 0.1}, {0.9, 1.1, 1}, turned(0.4, 0.1, 0), {0.1, 0.2, 0}, "left");
  add({0.8, -0.2, 0.5}, {0.8, 0.9, 0.9}, turned(-0.3, 0, 0.2), {0, 0, 0.3}, "right");
  add({0, 0, 0.3}, {1.5, 0.7, 1.2}, glm::dmat3(1), {-0.4, 0, 0.2}, "all");
  return all;
}

double meanOf(const Picture& p) {
  double mean = 0;
  for (int y = 0; y < p.image.height; ++y)
    for (int x = 0; x < p.image.width; ++x) mean += p.at(x, y).y / double(p.image.pixelCount());
  return mean;
}

/// Shares of what the reference shows plus 2 % of its mean.
Errors compare(const Picture& a, const Picture& reference, double bound) {
  const double mean = meanOf(reference);
  Errors e;
  for (int y = 0; y < reference.image.height; ++y)
    for (int x = 0; x < reference.image.width; ++x) {
      const dvec3 p = a.at(x, y), q = reference.at(x, y), d = glm::abs(p - q);
      if (p != dvec3(0) || q != dvec3(0)) e.add(std::max({d.x, d.y, d.z}) / (std::max({q.x, q.y, q.z}) + 0.02 * mean), bound);
    }
  return e;
}

}  // namespace

// As tests/render/forward_test.cpp, whose bounds these are: what the G-buffer's formats lose.
TEST_CASE("H24: forward and deferred agree under captured places: rungs, presets, projections", "[reflection][sweep]") {
  Stage stage;
  Workshop w;
  const std::vector<ReflectionProbe> all = places();
  const auto check = [&](const View& view, Quality quality, const std::string& what, double largest, double usual) {
    INFO(what);
    setProbes(w.scene, all);
    quality.path = Path::Forward;
    const Picture forward = stage.linear(w.scene, view, kSize, quality);
    CHECK(stage.renderer->lastPlan().on("forward_reference"));
    quality.path = Path::Deferred;
    const Picture deferred = stage.linear(w.scene, view, kSize, quality);
    CHECK(!stage.renderer->lastPlan().on("forward_reference"));
    CHECK(stage.renderer->lastPlan().on("reflection_probes"));
    const Errors e = compare(deferred, forward, usual);
    std::cout << fmt::format("  {:<28} largest {:6.3f} %, {:6.2f} % of {} pixels within {:.1f} %\n", what, 100 * e.largest, 100 * e.share(), e.count, 100 * usual);
    CHECK(e.largest < largest);
    CHECK(e.share() > 0.99);
    // Without the places the picture is another one: a path that drops them fails.
    setProbes(w.scene, {});
    CHECK(compare(stage.linear(w.scene, view, kSize, quality), forward, usual).share() < 0.95);
  };
  View parallel = w.view;
  parallel.orthographic = true;
  parallel.height = 2.6f;
  parallel.far = 20;
  for (const Reflection rung : {Reflection::Infinite, Reflection::Box, Reflection::BoxRough}) {
    Quality q;
    q.reflection = rung;
    check(w.view, q, fmt::format("reflection={}", terms()[10].rungs[std::size_t(rung)].name), 0.06, 0.03);
  }
  check(parallel, {}, "orthographic", 0.06, 0.03);
  for (const Ambient ambient : {Ambient::None, Ambient::Constant, Ambient::ShL1}) {
    Quality q;
    q.ambient = ambient;
    check(w.view, q, fmt::format("ambient {}", int(ambient)), 0.06, 0.03);
  }
  for (const std::string_view preset : {"seed", "exact"}) {
    Quality q;
    REQUIRE(setPreset(q, preset));
    check(w.view, q, std::string(preset), 0.08, 0.04);
  }
  w.setMaterial([](Material& m) { m.anisotropy = 0.7f, m.roughness = 0.4f, m.substance = 1; });
  check(w.view, {}, "brushed", 0.09, 0.045);
}

// H25. A blended surface whose pigment is opaque is the opaque surface, under places as under the sky.
TEST_CASE("H25: blended surfaces are lit by places as opaque ones", "[reflection]") {
  Stage stage;
  double worst = 0;
  for (const Path path : {Path::Deferred, Path::Forward}) {
    Picture pictures[2];
    for (const bool blend : {false, true}) {
      Workshop w;
      setProbes(w.scene, places());
      std::vector<Id<Material>> materials;
      w.scene.materials.each([&](Id<Material> id, const Material&) { materials.push_back(id); });
      for (const Id<Material> id : materials) w.scene.materials.edit(id)->blend = blend;
      // The opaque surfaces by the forward reference too: a blended one is shaded from unquantised values on either path.
      pictures[blend] = stage.linear(w.scene, w.view, kSize, onPath(blend ? path : Path::Forward));
      CHECK(stage.renderer->lastPlan().on("alpha_blend") == blend);
      CHECK(stage.renderer->lastPlan().on("reflection_probes"));
    }
    const Errors e = compare(pictures[1], pictures[0], 1e-4);
    worst = std::max(worst, e.largest);
    CHECK(e.share() > 0.999);  // edges: blended ones cover pixels as opaque ones do, drawn in another order
  }
  std::cout << fmt::format("  blended against opaque under places: {:.2g} of the pixel at most\n", worst);
}

// H25. Glass of every kind under a place that holds the sky's own light, infinitely far away, is as under the sky: reflections, transmission past the picture's edge, diffuse.
TEST_CASE("H25: glass under a place is as under the sky that it was made from", "[reflection]") {
  Stage stage;
  Workshop w;
  const auto glass = [&](Scene& scene) {
    place(scene, sphere(0.45f, 32, 64), glassOf(1.5f, 0.9f, 0.1f), translation({0.2, 0.2, 1.6}));
    place(scene, sphere(0.3f, 32, 64), glassOf(1.2f, 0.6f, 0.6f), translation({-0.9, 0.3, 1.5}));
    place(scene, quad({1.1f, 0.3f, 1.3f}, {0.3f, 0, 0.1f}, {0, 0.3f, 0}), glassOf(1.5f, 0));
    Material blend;
    blend.blend = true;
    blend.opacity = 0.5f;
    place(scene, quad({-0.2f, -0.4f, 2}, {0.3f, 0, 0}, {0, 0.2f, 0}), blend);
  };
  glass(w.scene);
  Quality q;
  q.reflection = Reflection::Infinite;
  const Picture sky = stage.linear(w.scene, w.view, kSize, q);
  ReflectionProbe p;
  auto cube = prefilterCubemap(w.scene.environment.map, {.size = 256});
  auto sh = irradianceSh(w.scene.environment.map);
  REQUIRE((cube && sh));
  p.radiance = std::move(*cube);
  p.irradiance = *sh;
  for (CubeLevel& level : p.radiance.levels)
    for (float& v : level.texels) v *= w.scene.environment.scale;
  for (auto& c : p.irradiance)
    for (double& v : c) v *= double(w.scene.environment.scale);
  setProbes(w.scene, {boxed(std::move(p), dvec3(0), dvec3(50))});
  // The sky itself is another one now: nothing of it may show but the background.
  Image& map = w.scene.environment.map;
  const bool background = w.scene.environment.background;
  CHECK_FALSE(background);
  for (std::size_t i = 0; i < map.pixelCount() * std::size_t(map.channels); ++i) map.f32()[i] *= 50;
  ++w.scene.environment.revision;
  const Picture under = stage.linear(w.scene, w.view, kSize, q);
  const Errors e = compare(under, sky, 2e-3);
  std::cout << fmt::format("  glass under a place against the sky: {:.2g} of the pixel at most, {:.2f} % within 0.2 %\n", e.largest, 100 * e.share());
  // Both are filtered within 1e-4 rms and 1e-3 a texel, and half floats step by 5e-4.
  CHECK(e.share() > 0.999);
  CHECK(e.largest < 0.01);
}
