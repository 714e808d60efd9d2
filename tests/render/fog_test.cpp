// Fog in the picture against closed forms: what it takes, what it scatters, the white room, both paths, what is seen through, what emits, the background; and a plan without it.
#include <fmt/format.h>

#include <iostream>

#include "reference/shading.h"
#include "render/transparent.h"

using namespace burnish;
using namespace burnish::test;

namespace f64 = burnish::shading::f64;

namespace {

constexpr glm::ivec2 kSize{96, 64};

Fog fogOf(float density, float falloff = 0, float height = 0) {
  Fog f;
  f.density = density;
  f.falloff = falloff;
  f.height = height;
  return f;
}

/// A wall across the view at z = -distance that gives off `radiance` and reflects nothing.
Id<Instance> addWall(Scene& scene, float distance, vec3 radiance) { return place(scene, quad({0, 0, -distance}, {4 * distance, 0, 0}, {0, 4 * distance, 0}), shining(radiance)); }

View level(bool orthographic = false) {
  View v = lookAt({0, 2, 0}, {0, 2, -1}, {0, 1, 0}, 0.9f);
  v.orthographic = orthographic;
  v.height = 6;
  v.far = orthographic ? 500.0f : 0.0f;
  return v;
}

double depthTo(const Fog& f, const Ray& ray, double way) {
  const double from = ray.origin.y - double(f.height);
  return f64::fogDepth(from, from + ray.direction.y * way, way, f.start, f.density, f.falloff);
}

/// Largest error of the picture against f(ray), relative to the largest value of f.
template <class F>
double worstAgainst(const Picture& p, const View& view, F&& f) {
  double worst = 0, largest = 0;
  for (int y = 0; y < p.image.height; ++y)
    for (int x = 0; x < p.image.width; ++x) {
      const dvec3 exact = f(rayThrough(view, {p.image.width, p.image.height}, x + 0.5, y + 0.5));
      const dvec3 d = glm::abs(p.at(x, y) - exact);
      largest = std::max({largest, exact.x, exact.y, exact.z});
      if (const double e = std::max({d.x, d.y, d.z}); !(e <= worst)) worst = e;
    }
  return worst / largest;
}

bool defines(const FramePlan& plan, std::string_view text) {
  return std::any_of(plan.programs.begin(), plan.programs.end(), [&](const ProgramPlan& p) { return std::find(p.defines.begin(), p.defines.end(), text) != p.defines.end(); });
}

}  // namespace

TEST_CASE("fog takes what the optical depth says, both projections, both paths, from a start on") {
  Stage stage;
  for (const bool orthographic : {false, true})
    for (const Fog& given : {fogOf(0.02f), fogOf(0.03f, 0.4f, 1), fogOf(0.01f, -0.0f, -50), fogOf(0.05f, 1.5f, 2)})
      for (const float start : {0.0f, 12.0f}) {
        Scene scene;
        scene.fog = given;
        scene.fog.start = start;
        addWall(scene, 20, {4, 2, 1});
        const View view = level(orthographic);
        for (const Path path : {Path::Deferred, Path::Forward}) {
          const Picture p = stage.linear(scene, view, kSize, onPath(path));
          CHECK(stage.renderer->lastPlan().on("fog"));
          const double worst = worstAgainst(p, view, [&](const Ray& ray) { return dvec3(4, 2, 1) * std::exp(-depthTo(scene.fog, ray, -20 / ray.direction.z)); });
          INFO(fmt::format("orthographic {}, density {}, falloff {}, start {}, path {}", orthographic, given.density, given.falloff, start, int(path)));
          CHECK(worst < 2e-5);
        }
      }
}

TEST_CASE("fog shows the suns by its phase function and the surroundings' mean, in front of a wall and of nothing") {
  Stage stage;
  Scene scene;
  scene.fog = fogOf(0.05f, 0.1f, 0);
  scene.fog.albedo = {0.9f, 0.6f, 0.3f};
  scene.fog.anisotropy = 0.6f;
  const dvec3 toSun = glm::normalize(dvec3(0.2, 0.35, -1));
  addLight(scene, light(LightKind::Directional, {1, 0.8f, 0.5f}, 50), {0, 0, 0}, -toSun);
  addWall(scene, 30, {1, 1, 1});
  const View view = level();
  const auto sunlit = [&](const Ray& ray) { return dvec3(1, 0.8, 0.5) * dvec3(0.9, 0.6, 0.3) * (50 * f64::phaseHenyeyGreenstein(glm::dot(toSun, ray.direction), 0.6)); };
  const auto wall = [&](const Ray& ray) {
    const double t = std::exp(-depthTo(scene.fog, ray, -30 / ray.direction.z));
    return dvec3(t) + sunlit(ray) * (1 - t);
  };
  const Picture p = stage.linear(scene, view, kSize);
  CHECK(worstAgainst(p, view, wall) < 2e-4);
  // What emits and is lit as well (by nothing here: the sun stands behind the wall) is added to what the fog shows already.
  Material lamp;
  lamp.albedo = vec3(0);
  lamp.emission = vec3(1);
  lamp.useVertexColor = false;
  *scene.materials.edit(scene.instances.get(scene.instances.at(0))->material) = lamp;
  for (const Path path : {Path::Deferred, Path::Forward}) CHECK(worstAgainst(stage.linear(scene, view, kSize, onPath(path)), view, wall) < 2e-4);
  scene.instances.remove(scene.instances.at(0));
  const auto nothing = [&](const Ray& ray) { return sunlit(ray) * (1 - std::exp(-depthTo(scene.fog, ray, 1e6))); };
  for (const bool orthographic : {false, true}) {
    const View sky = level(orthographic);
    const Picture empty = stage.linear(scene, sky, kSize);
    CHECK(stage.renderer->lastPlan().pass("background") != nullptr);
    CHECK(!stage.renderer->lastPlan().on("background"));
    CHECK(worstAgainst(empty, sky, nothing) < 2e-4);
  }
  // Light from all around, with a first band: fog of albedo 1 that scatters evenly shows its mean.
  scene.lights.remove(scene.lights.at(0));
  scene.environment.map = makeImage(64, 32, 3, PixelType::F32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c) scene.environment.map.f32()[(y * 64 + x) * 3 + c] = float(2 + 1.5 * std::cos(kPi * (y + 0.5) / 32));
  ++scene.environment.revision;
  scene.environment.background = false;
  for (const float g : {0.0f, 0.5f, -0.5f}) {
    scene.fog.anisotropy = g;
    const Picture glow = stage.linear(scene, view, kSize);
    CHECK(worstAgainst(glow, view, [&](const Ray& ray) { return dvec3(0.9, 0.6, 0.3) * ((2 + 1.5 * double(g) * ray.direction.y) * (1 - std::exp(-depthTo(scene.fog, ray, 1e6)))); }) < 0.005);
  }
}

TEST_CASE("a white room: fog that absorbs nothing, between walls and sky that shine alike, is not seen") {
  Stage stage;
  for (const float falloff : {0.0f, 0.3f}) {
    Scene scene;
    scene.fog = fogOf(0.08f, falloff);
    scene.environment.color = vec3(3);
    Material m = shining(vec3(3));
    m.useVertexColor = false;
    place(scene, quad({0, 0, -6}, {3, 0, 0}, {0, 3, 0}), m);
    for (const Path path : {Path::Deferred, Path::Forward}) {
      const Picture p = stage.linear(scene, level(), kSize, onPath(path));
      CHECK(worstAgainst(p, level(), [](const Ray&) { return dvec3(3); }) < 2e-5);
    }
  }
}

TEST_CASE("with fog, forward and deferred agree, opaque, emissive and seen through", "[sweep]") {
  Stage stage;
  Workshop w;
  w.scene.fog = fogOf(0.12f, 0.5f, -0.5f);
  w.scene.fog.anisotropy = 0.5f;
  w.scene.fog.albedo = {0.9f, 0.8f, 0.7f};
  w.scene.environment.background = true;
  w.setMaterial([&](Material& m) { m.mapA = w.albedo, m.emission = {1, 2, 0.5f}, m.emissiveMap = w.emissive; });
  Material blended = Workshop::base();
  blended.blend = true;
  blended.opacity = 0.4f;
  place(w.scene, quad({0.2f, 0.1f, 1.9f}, {0.4f, 0, 0}, {0, 0.4f, 0}), blended);
  for (const bool orthographic : {false, true}) {
    View view = w.view;
    view.orthographic = orthographic;
    view.height = 2.6f;
    view.far = 20;
    const Picture forward = stage.linear(w.scene, view, kSize, onPath(Path::Forward)), deferred = stage.linear(w.scene, view, kSize, onPath(Path::Deferred));
    double mean = 0;
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) mean += forward.at(x, y).y / (kSize.x * kSize.y);
    const Errors e = difference(forward, deferred, 0.02 * mean);
    std::cout << fmt::format("  fog, forward against deferred: largest {:.2f} % of the mean, {:.2f} % within 2 %\n", 100 * e.largest / mean, 100 * e.share());
    CHECK(e.share() > 0.97);  // the bounds of forward_test.cpp: the G-buffer's quantisation
    CHECK(e.largest < 0.15 * mean);
    w.scene.fog.density = 0;
    const Picture clear = stage.linear(w.scene, view, kSize, onPath(Path::Deferred));
    w.scene.fog.density = 0.12f;
    CHECK(difference(clear, deferred, 0.02 * mean).share() < 0.5);
  }
}

TEST_CASE("what is seen through is in the fog once: clear panes vanish, half-opaque ones lie in it") {
  Stage stage;
  Scene scene;
  scene.fog = fogOf(0.05f, 0.2f, 0);
  scene.environment.color = vec3(2, 1.5f, 1);
  addWall(scene, 30, {5, 3, 1});
  const View view = level();
  const Picture bare = stage.linear(scene, view, kSize);
  // Air in a frame: it neither reflects nor tints.
  Material air;
  air.transmission = 1;
  air.ior = 1;
  air.albedo = vec3(1);
  const Id<Instance> pane = place(scene, quad({0, 2, -10}, {20, 0, 0}, {0, 20, 0}), air);
  CHECK(worstAgainst(stage.linear(scene, view, kSize), view, [&](const Ray&) { return dvec3(0); }) > 0);
  CHECK(difference(bare, stage.linear(scene, view, kSize), 1e-4).largest < 2e-3);
  // The same as a body that looks behind itself.
  air.thickness = 0.2f;
  *scene.materials.edit(scene.instances.get(pane)->material) = air;
  CHECK(difference(bare, stage.linear(scene, view, kSize), 1e-4).largest < 0.02);
  // Half a pixel covered by what shines: half of it, through its part of the fog, over half of what is behind, which has the whole.
  Material half = shining({1, 4, 2});
  half.blend = true;
  half.opacity = 0.5f;
  half.mapC = scene.textures.add(painted(MapKind::Occlusion, 4, [](float, float) { return vec4(1, 0.4f, 0, 0); }));
  *scene.materials.edit(scene.instances.get(pane)->material) = half;
  const Picture over = stage.linear(scene, view, kSize);
  const double cover = std::lround(0.4 * 255) / 255.0;
  double worst = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const Ray ray = rayThrough(view, kSize, x + 0.5, y + 0.5);
      const double t = std::exp(-depthTo(scene.fog, ray, -10 / ray.direction.z));
      // Unlit with an opacity: its share of pigment emits nothing here (albedo 0) but hides half of what is behind the covered part.
      const dvec3 covered = dvec3(1, 4, 2) * t + dvec3(2, 1.5, 1) * ((1 - t) * 0.5) + bare.at(x, y) * 0.5;
      const dvec3 d = glm::abs(over.at(x, y) - (covered * cover + bare.at(x, y) * (1 - cover)));
      worst = std::max({worst, d.x, d.y, d.z});
    }
  CHECK(worst < 1e-3);
}

TEST_CASE("fog leaves lighting in place where it was, within 1/255, and glows in the developed picture") {
  Stage stage;
  Workshop w;
  w.scene.environment.map = {};
  w.scene.environment.color = vec3(3, 5, 9);
  w.scene.environment.background = true;
  w.scene.fog = fogOf(0.1f, 0.2f);
  Quality quality;
  quality.exposureEv = 2;
  for (const bool background : {true, false}) {
    w.scene.environment.background = background;
    const Picture direct = stage.display(w.scene, w.view, {75, 53}, quality);
    CHECK(stage.renderer->lastPlan().target("light") == nullptr);
    RenderRequest counted;
    counted.countNonfinite = true;
    const Picture buffered = stage.draw(w.scene, {&w.view, 1}, {75, 53}, quality, counted);
    CHECK(stage.renderer->lastPlan().target("light") != nullptr);
    CHECK(buffered.stats.nonfinitePixels == 0);
    CHECK(difference(direct, buffered, 1.01 / 255).largest <= 1.01 / 255);
  }
}

TEST_CASE("a plan without fog has nothing of it; fog too thin or too near is off and says so") {
  Workshop w;
  const PlanOptions options{.size = {64, 64}};
  const auto plan = [&](const View& view) { return makePlan(w.scene, {&view, 1}, {}, Capabilities{}, options); };
  const auto fog = [&](const FramePlan& p) { return *std::find_if(p.effects.begin(), p.effects.end(), [](const EffectPlan& e) { return e.name == "fog"; }); };
  const FramePlan without = plan(w.view);
  CHECK(!without.on("fog"));
  CHECK(fog(without).reason == "fog in the scene would call for it");
  CHECK(!defines(without, "FOG 1"));
  w.scene.fog = fogOf(0.01f);
  const FramePlan with = plan(w.view);
  CHECK(fog(with).reason == "the scene's fog");
  CHECK(defines(with, "FOG 1"));
  CHECK(fog(with).targets.size() == 1);  // the light buffer, which others call for too
  // The background, for the fog before it, takes the place of clearing the light buffer.
  CHECK(with.passes.size() == without.passes.size());
  CHECK((without.pass("light_clear") && !without.pass("background")));
  CHECK((with.pass("background") && !with.pass("light_clear")));
  // Nothing is farther than nine metres; the way to the background is, but no light comes from there.
  w.scene.environment = {};
  for (std::uint32_t i = 0; i < 2; ++i) w.scene.lights.remove(w.scene.lights.at(i));
  w.scene.fog.density = 0.01f;
  CHECK(plan(w.view).on("fog"));
  w.scene.fog.density = 1e-4f;
  const FramePlan thin = plan(w.view);
  CHECK(!thin.on("fog"));
  CHECK(fog(thin).reason == "nothing in view is far enough for the scene's fog to take 1/1024 of its light");
  CHECK(!defines(thin, "FOG 1"));
  // Up out of a layer the sky is clear; level or down it is not.
  w.scene.environment.color = vec3(1);
  w.scene.fog = fogOf(1e-3f, 1, -10);
  const View up = lookAt({0, 0, 0}, {0, 1, 0.01}, {0, 1, 0}, 0.5f), along = lookAt({0, 0, 0}, {0, 0.05, -1}, {0, 1, 0}, 0.5f);
  CHECK(!plan(up).on("fog"));
  CHECK(plan(along).on("fog"));
}

TEST_CASE("fog that is drawn never takes less than the bound says, and the bound is no less than what is drawn") {
  // What a pixel of the picture loses, against the verdict: a scene that loses 1/1024 anywhere must have its fog on.
  Stage stage;
  for (const float height : {-4.0f, 0.0f, 3.0f})
    for (const float pitch : {-0.6f, 0.0f, 0.5f}) {
      Scene scene;
      scene.fog = fogOf(0.0004f, 0.7f, height);
      place(scene, box({-6, -3, -8}, {6, 5, 2}, true), shining(vec3(1)));
      const View view = lookAt({0, 1, 0}, {0, 1 + pitch, -1}, {0, 1, 0}, 1.2f);
      double deepest = 0;
      for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x) {
          const Ray r = rayThrough(view, kSize, x + 0.5, y + 0.5);
          double way = 1e9;
          for (int a = 0; a < 3; ++a) {
            const double low = a == 0 ? -6 : a == 1 ? -3 : -8, high = a == 0 ? 6 : a == 1 ? 5 : 2;
            if (r.direction[a] != 0) way = std::min(way, ((r.direction[a] > 0 ? high : low) - r.origin[a]) / r.direction[a]);
          }
          deepest = std::max(deepest, depthTo(scene.fog, r, way));
        }
      const FramePlan plan = makePlan(scene, {&view, 1}, {}, Capabilities{}, {.size = kSize});
      CAPTURE(height, pitch, deepest);
      if (deepest > 1.0 / 1024) CHECK(plan.on("fog"));
      if (deepest < 1e-5) CHECK(!plan.on("fog"));
    }
}

TEST_CASE("numbers that are no fog are mended and reported; the picture stays finite") {
  Stage stage;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNan, kInf, -kInf, -1.0f, 1e30f})
    for (int field = 0; field < 6; ++field) {
      Scene scene;
      addWall(scene, 20, vec3(1));
      scene.environment.color = vec3(1);
      addLight(scene, light(LightKind::Directional, vec3(1), 5), {0, 0, 0}, {0.3, -1, -0.2});
      scene.fog = fogOf(0.05f, 0.1f);
      float* fields[] = {&scene.fog.density, &scene.fog.falloff, &scene.fog.height, &scene.fog.anisotropy, &scene.fog.start, &scene.fog.albedo.y};
      *fields[field] = bad;
      const Picture p = stage.linear(scene, level(), {16, 12});
      for (int i = 0; i < 16; ++i) REQUIRE(std::isfinite(p.at(i, 6).x + p.at(i, 6).y + p.at(i, 6).z));
    }
  const auto& warnings = stage.renderer->report().warnings();
  const auto says = [&](std::string_view text) { return std::any_of(warnings.begin(), warnings.end(), [&](const Warning& w) { return w.message().find(text) != std::string::npos; }); };
  CHECK(says("fog: its anisotropy is -1: -0.95 is taken"));
  CHECK(says("fog: its albedo is nan: 1 is taken"));
  CHECK(says("fog: its falloff is inf: 0 is taken"));
}
