// Rooms lit by captured places: no sky inside, no seam between boxes of one light, glass and blended surfaces lit as opaque ones, and the plan's reasons.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "probe/reflection_room.h"
#include "render/transparent.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{128, 96};
constexpr float kWest = -3, kEast = 3, kHeight = 1.5f, kDepth = 2;

/// A closed room of 6 x 3 x 4 m under a bright sky, with a ball of metal, one of plastic and a rough box; nothing else gives light.
struct Room {
  Scene scene;
  View view = lookAt({-2.4, 0.6, 1.6}, {0.8, -0.6, -0.4}, {0, 1, 0}, 1.1f);

  explicit Room(float sky = 1e4f) {
    scene.environment.color = {sky, sky, sky};
    Material walls, metal, plastic;
    walls.albedo = {0.6f, 0.55f, 0.5f};
    walls.roughness = 0.35f;
    metal.albedo = {0.9f, 0.7f, 0.4f};
    metal.substance = 1;
    metal.roughness = 0.15f;
    plastic.albedo = {0.2f, 0.4f, 0.7f};
    plastic.roughness = 0.5f;
    place(scene, box({kWest, -kHeight, -kDepth}, {kEast, kHeight, kDepth}, true), walls);
    place(scene, sphere(0.6f, 32, 64), metal, translation({-0.5, -0.9, 0}));
    place(scene, sphere(0.5f, 32, 64), plastic, translation({1.2, -1, 0.4}));
    place(scene, box({1.6f, -1.5f, -1.4f}, {2.4f, -0.3f, -0.6f}), walls);
  }
  /// Two boxes that overlap in the middle, exactly as large as the room together: its walls are their faces.
  void light(ReflectionProbe a, ReflectionProbe b) {
    a = boxed(std::move(a), {-1.25, 0, 0}, {1.75, kHeight, kDepth});
    b = boxed(std::move(b), {1, 0, 0}, {2, kHeight, kDepth});
    a.capture = {-2, 0.3, 0.1};
    setProbes(scene, {std::move(a), std::move(b)});
  }
};

/// The largest difference, as a share of what the second shows.
double largestShare(const Picture& a, const Picture& b) {
  double largest = 0;
  for (int y = 0; y < a.image.height; ++y)
    for (int x = 0; x < a.image.width; ++x) {
      const dvec3 p = a.at(x, y), q = b.at(x, y), d = glm::abs(p - q);
      for (int c = 0; c < 3; ++c)
        if (p[c] != q[c]) largest = std::max(largest, d[c] / std::max(q[c], 1e-12));
    }
  return largest;
}

dvec3 brightest(const Picture& p) {
  dvec3 most(0);
  for (int y = 0; y < p.image.height; ++y)
    for (int x = 0; x < p.image.width; ++x) most = glm::max(most, p.at(x, y));
  return most;
}

const EffectPlan& effectOf(const FramePlan& plan) {
  const auto found = std::find_if(plan.effects.begin(), plan.effects.end(), [](const EffectPlan& e) { return e.name == "reflection_probes"; });
  REQUIRE(found != plan.effects.end());
  return *found;
}

void addGlass(Scene& scene) {
  Material blend;
  blend.blend = true;
  blend.opacity = 0.5f;
  blend.roughness = 0.3f;
  blend.albedo = {0.8f, 0.3f, 0.3f};
  place(scene, quad({-0.4f, -0.4f, 0.9f}, {0.5f, 0, -0.1f}, {0, 0.4f, 0.1f}), blend);
  place(scene, sphere(0.35f, 24, 48), glassOf(1.5f, 0.7f, 0.1f), translation({0.6, -0.5, 1.1}));
  place(scene, quad({-1.4f, 0.1f, 0.8f}, {0.3f, 0, 0.1f}, {0, 0.3f, 0}), glassOf(1.5f, 0));
}

}  // namespace

// H1. What is inside the boxes, or on their faces, has nothing of the sky: with black places the picture is black, under a sky of 1e4.
TEST_CASE("H1: a closed room under a bright sky with overlapping places: no sky in any pixel", "[reflection]") {
  Stage stage;
  for (const Path path : {Path::Deferred, Path::Forward})
    for (const bool glass : {false, true})
      for (const Reflection rung : {Reflection::Infinite, Reflection::Box, Reflection::BoxRough}) {
        INFO(fmt::format("path {}, glass {}, rung {}", int(path), glass, int(rung)));
        Quality q = onPath(path);
        q.reflection = rung;
        Room room;
        if (glass) addGlass(room.scene);
        const dvec3 sky = brightest(stage.linear(room.scene, room.view, kSize, q));
        CHECK(sky.y > 1000);
        room.light(constantProbe(dvec3(0)), constantProbe(dvec3(0)));
        CHECK(brightest(stage.linear(room.scene, room.view, kSize, q)) == dvec3(0));
      }
}

// H1 and H2. Places of one constant give what a sky of that constant gives, in every pixel and so across the border of the boxes. Powers of two are exact in half floats.
TEST_CASE("H2: two overlapping places of one constant give what a sky of it gives", "[reflection]") {
  Stage stage;
  double worst = 0;
  for (const Path path : {Path::Deferred, Path::Forward})
    for (const bool glass : {false, true})
      for (const Ambient ambient : {Ambient::Constant, Ambient::ShL2}) {
        Quality q = onPath(path);
        q.ambient = ambient;
        Room open(4), lit(1e4f);
        if (glass) addGlass(open.scene), addGlass(lit.scene);
        lit.light(constantProbe(dvec3(4)), constantProbe(dvec3(4)));
        const Picture a = stage.linear(lit.scene, lit.view, kSize, q), b = stage.linear(open.scene, open.view, kSize, q);
        worst = std::max(worst, largestShare(a, b));
      }
  std::cout << fmt::format("  places of one constant against a sky of it: {:.2g} of the pixel\n", worst);
  CHECK(worst < 2e-3);  // the sky's own harmonics and filtering are within 1e-3 of a constant
}

TEST_CASE("a scene with places and no sky is lit by them alone", "[reflection]") {
  Stage stage;
  Room room(0), lit(8);
  room.light(constantProbe(dvec3(8)), constantProbe(dvec3(8)));
  const Picture a = stage.linear(room.scene, room.view, kSize);
  CHECK(!stage.renderer->lastPlan().on("environment_lighting"));
  CHECK(stage.renderer->lastPlan().on("reflection_probes"));
  CHECK(largestShare(a, stage.linear(lit.scene, lit.view, kSize)) < 2e-3);
}

TEST_CASE("the plan says why places light the frame and why not", "[reflection]") {
  Stage stage;
  const auto reason = [&](const Scene& scene, const View& view, const Quality& quality = {}) {
    PlanOptions options;
    options.size = kSize;
    const FramePlan plan = makePlan(scene, {&view, 1}, quality, stage.renderer->capabilities(), options);
    return std::pair(plan.on("reflection_probes"), effectOf(plan).reason);
  };
  Room room;
  CHECK(reason(room.scene, room.view) == std::pair(false, std::string("a reflection probe would call for it")));
  room.light(constantProbe(dvec3(1)), constantProbe(dvec3(1)));
  room.scene.probes.reflections[1].name = "hall";
  room.scene.probes.reflections[0].name = "porch";
  CHECK(reason(room.scene, room.view) == std::pair(true, std::string("2 of them, the first is reflection probe 'porch'")));
  CHECK(reason(room.scene, lookAt({0, 0, 100}, {0, 0, 200})).second == "out of view: reflection probe 'porch'");
  Quality none;
  none.ambient = Ambient::None;
  none.environmentSpecular = EnvironmentSpecular::None;
  CHECK(reason(room.scene, room.view, none).second == "the quality turns it off");
  for (ReflectionProbe& p : room.scene.probes.reflections) p.radiance.levels.clear();
  CHECK(reason(room.scene, room.view) == std::pair(false, std::string("reflection probe 'porch' is not baked")));
  Scene bare;
  setProbes(bare, {boxed(constantProbe(dvec3(1)), dvec3(0), dvec3(1))});
  CHECK(reason(bare, room.view).second == "nothing to light");
}

TEST_CASE("places that do not fit are left out and named", "[reflection]") {
  Stage stage;
  Room room;
  room.light(constantProbe(dvec3(2)), constantProbe(dvec3(2)));
  const Picture usual = stage.linear(room.scene, room.view, kSize);
  std::vector<ReflectionProbe> probes = room.scene.probes.reflections;
  const auto wrong = [&](const char* name, auto change) {
    ReflectionProbe p = boxed(constantProbe(dvec3(500)), dvec3(0), dvec3(0.5));
    p.name = name;
    change(p);
    probes.push_back(std::move(p));
  };
  wrong("larger", [](ReflectionProbe& p) { p.radiance = constantProbe(dvec3(500), 32).radiance; });
  wrong("fewer levels", [](ReflectionProbe& p) { p.radiance.levels.pop_back(); });
  wrong("nowhere", [](ReflectionProbe& p) { p.center.x = std::nan(""); });
  wrong("cut off", [](ReflectionProbe& p) { p.radiance.levels[1].texels.pop_back(); });
  setProbes(room.scene, probes);
  CHECK(same(stage.linear(room.scene, room.view, kSize), usual));
  for (const char* name : {"larger", "fewer levels", "nowhere", "cut off"}) {
    INFO(name);
    const auto& all = stage.renderer->report().warnings();
    CHECK(std::any_of(all.begin(), all.end(), [&](const Warning& w) { return w.message().find(fmt::format("reflection probe '{}'", name)) != std::string::npos && w.what.find("left out") != std::string::npos; }));
  }
}

TEST_CASE("more places than a tile lists: one warning names how many", "[reflection]") {
  Stage stage;
  Room room;
  std::vector<ReflectionProbe> probes;
  for (int i = 0; i < 6; ++i) probes.push_back(boxed(constantProbe(dvec3(1)), dvec3(0), dvec3(3 + i, 2 + i, 2.5 + i)));
  setProbes(room.scene, probes);
  stage.linear(room.scene, room.view, kSize);
  const auto& all = stage.renderer->report().warnings();
  CHECK(std::count_if(all.begin(), all.end(), [](const Warning& w) { return w.what.starts_with("6 of their boxes meet") && w.what.find("4 is the limit") != std::string::npos; }) == 1);
}

// Values past what half floats hold: the cubes are scaled together by a power of two.
TEST_CASE("light past the range of half floats stays", "[reflection]") {
  Stage stage;
  Room dim(0), bright(0);
  dim.light(constantProbe(dvec3(0.5, 1, 2)), constantProbe(dvec3(1)));
  const double factor = 1048576;
  bright.light(constantProbe(dvec3(0.5, 1, 2) * factor), constantProbe(dvec3(factor)));
  const Picture a = stage.linear(dim.scene, dim.view, kSize), b = stage.linear(bright.scene, bright.view, kSize);
  double worst = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x)
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(b.at(x, y)[c] / factor - a.at(x, y)[c]) / std::max(a.at(x, y)[c], 1e-9));
  CHECK(worst < 1e-5);
}

// One frame, two views: places light the one that sees them, and the other is as on its own.
TEST_CASE("views side by side: each is lit by the places that it sees", "[reflection]") {
  Stage stage;
  Room room(1);
  room.light(constantProbe(dvec3(6, 2, 1)), constantProbe(dvec3(1, 2, 6)));
  Material m;
  place(room.scene, sphere(1, 32, 64), m, translation({0, 0, 50}));
  View in = room.view, out = lookAt({0, 1, 45}, {0, 0, 50});
  in.viewport = {0, 0, 96, 96};
  out.viewport = {96, 0, 96, 96};
  for (const Path path : {Path::Deferred, Path::Forward}) {
    RenderRequest request;
    request.output = Output::Linear;
    const View both[] = {in, out};
    const Picture together = stage.draw(room.scene, both, {192, 96}, onPath(path), request);
    CHECK(stage.renderer->lastPlan().on("reflection_probes"));
    for (const View& view : both) {
      const Picture alone = stage.draw(room.scene, {&view, 1}, {192, 96}, onPath(path), request);
      CHECK(stage.renderer->lastPlan().on("reflection_probes") == (view.viewport.x == 0));
      double worst = 0, most = 0;
      for (int y = 0; y < 96; ++y)
        for (int x = view.viewport.x; x < view.viewport.x + 96; ++x) {
          const dvec3 d = glm::abs(alone.at(x, y) - together.at(x, y));
          worst = std::max(worst, std::max({d.x, d.y, d.z}));
          most = std::max(most, alone.at(x, y).y);
        }
      CHECK(most > 0.1);
      CHECK(worst < 1e-5 * most);
    }
  }
}
