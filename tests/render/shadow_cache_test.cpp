// Shadow maps are drawn when what they show changes and at no other time; limits that are passed are said; only lights that reach something in view have maps.
#include <fmt/format.h>

#include <algorithm>

#include "render/shadowed.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{160, 100};

View viewOfYard() { return lookAt({1.5, 2.2, 5}, {-0.2, 0.3, 0}, {0, 1, 0}, 0.8f); }

struct Lit {
  Yard yard;
  Stage stage;
  Id<Light> sun, spot, point;
  View view = viewOfYard();
  Lit() {
    Light l = light(LightKind::Directional, vec3(1), 1000);
    l.castsShadow = true;
    sun = addLight(yard.scene, l, {0, 0, 0}, {0.8, -0.6, -0.3});
    l = light(LightKind::Spot, vec3(1), 300, 20);
    l.castsShadow = true;
    l.outerCone = 0.7f;
    spot = addLight(yard.scene, l, {-3, 3, 2}, {1, -1, -0.7});
    l.kind = LightKind::Point;
    point = addLight(yard.scene, l, {2.5, 1.5, 1.5});
  }
  FrameStats frame() { return stage.linear(yard.scene, view, kSize).stats; }
  Node& node(Id<Instance> i) { return *yard.scene.nodes.edit(yard.scene.instances.get(i)->node); }
  Node& node(Id<Light> i) { return *yard.scene.nodes.edit(yard.scene.lights.get(i)->node); }
};

const EffectPlan& effectOf(const FramePlan& plan, std::string_view name) {
  const auto found = std::find_if(plan.effects.begin(), plan.effects.end(), [&](const EffectPlan& e) { return e.name == name; });
  REQUIRE(found != plan.effects.end());
  return *found;
}

bool warned(const Renderer& renderer, std::string_view place, std::string_view what) {
  const auto& all = renderer.report().warnings();
  return std::any_of(all.begin(), all.end(), [&](const Warning& w) { return w.place == place && w.what.find(what) != std::string::npos; });
}

}  // namespace

TEST_CASE("shadow maps are drawn once, and again only where something changed", "[shadow]") {
  Lit s;
  const FrameStats first = s.frame();
  const int maps = first.shadowMapsDrawn;
  CHECK(maps >= 4 + 1 + 3);
  CHECK(first.shadowMapsKept == 0);
  CHECK(first.shadowDraws > maps);
  const auto kept = [&](const FrameStats& f) { return f.shadowMapsDrawn == 0 && f.shadowDraws == 0 && f.shadowMapsKept == maps; };
  CHECK(kept(s.frame()));
  // What casts no shadow and lights nothing: still kept.
  s.yard.scene.materials.edit(s.yard.scene.instances.get(s.yard.wall)->material)->albedo = vec3(0.9f);
  s.yard.scene.lights.edit(s.spot)->intensity = 200;
  CHECK(kept(s.frame()));
  // The eye turns a little: maps of lights in place stay, and those of the sun too as long as the eye moves less than a step.
  const View before = s.view;
  s.view.eye += dvec3(0.001, 0, 0.001);
  CHECK(kept(s.frame()));
  s.view = before;
  // A caster moves that every light sees.
  const dvec3 at = dvec3(s.node(s.yard.sphereInstance).local[3]);
  s.node(s.yard.sphereInstance).local[3] += glm::dvec4(0, 0.2, 0, 0);
  const FrameStats moved = s.frame();
  CHECK(moved.shadowMapsDrawn >= 3);
  CHECK(moved.shadowMapsDrawn + moved.shadowMapsKept == maps);
  s.node(s.yard.sphereInstance).local[3] = glm::dvec4(at, 1);
  s.frame();
  CHECK(kept(s.frame()));
  // A light moves: its maps alone.
  s.node(s.spot).local[3] += glm::dvec4(0.1, 0, 0, 0);
  const FrameStats light = s.frame();
  CHECK(light.shadowMapsDrawn == 1);
  CHECK(light.shadowMapsKept == maps - 1);
  CHECK(kept(s.frame()));
  // A caster that is far from the spot's cone: the spot's map stays.
  const Id<Instance> far = place(s.yard.scene, box({-0.1f, 0, -0.1f}, {0.1f, 0.3f, 0.1f}), Material{}, translation({4.5, 0, -4}));
  const FrameStats added = s.frame();
  CHECK(added.shadowMapsDrawn > 0);
  CHECK(added.shadowMapsDrawn < added.shadowMapsDrawn + added.shadowMapsKept);
  s.frame();
  s.yard.scene.instances.edit(far)->castsShadow = false;
  CHECK(s.frame().shadowMapsDrawn > 0);
  CHECK(s.frame().shadowMapsDrawn == 0);
}

TEST_CASE("what is kept is what would be drawn: pictures after changes equal a fresh renderer's", "[shadow]") {
  Lit s;
  s.frame();
  const auto same = [&] {
    const Picture kept = s.stage.linear(s.yard.scene, s.view, kSize);
    Stage fresh;
    const Picture made = fresh.linear(s.yard.scene, s.view, kSize);
    return test::same(kept, made);
  };
  s.node(s.yard.sphereInstance).local[3] += glm::dvec4(0.3, 0.2, 0.1, 0);
  CHECK(same());
  s.node(s.point).local[3] += glm::dvec4(-0.5, 0.4, 0, 0);
  CHECK(same());
  s.view.eye += dvec3(0.7, 0.1, -0.4);
  CHECK(same());
  s.yard.scene.instances.edit(s.yard.wall)->visible = false;
  CHECK(same());
  s.yard.scene.lights.remove(s.spot);
  CHECK(same());
  // A mesh that is replaced under the same id.
  *s.yard.scene.meshes.edit(s.yard.scene.instances.get(s.yard.sphereInstance)->mesh) = box({-0.3f, -0.6f, -0.3f}, {0.3f, 0.9f, 0.3f});
  CHECK(same());
}

TEST_CASE("several views: each has its own cascades, local lights' maps are shared, nothing is drawn twice", "[shadow]") {
  Lit s;
  View left = s.view, right = lookAt({-3, 1.5, 4}, {0, 0.3, 0}, {0, 1, 0}, 0.8f);
  left.viewport = {0, 0, 80, 100};
  right.viewport = {80, 0, 80, 100};
  const View views[] = {left, right};
  RenderRequest request;
  request.output = Output::Linear;
  const FrameStats first = s.stage.draw(s.yard.scene, views, kSize, {}, request).stats;
  const FramePlan plan = s.stage.renderer->lastPlan();
  CHECK(first.shadowMapsDrawn == plan.target("shadow_maps")->layers);
  CHECK(first.shadowMapsKept > 0);
  const Picture again = s.stage.draw(s.yard.scene, views, kSize, {}, request);
  CHECK(again.stats.shadowMapsDrawn == 0);
  CHECK(again.stats.shadowDraws == 0);
  View alone = left;
  alone.viewport = {0, 0, 0, 0};
  Stage fresh;
  const Picture one = fresh.draw(s.yard.scene, {&alone, 1}, {80, 100}, {}, request);
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 80; ++x) REQUIRE(glm::length(one.at(x, y) - again.at(x, y)) < 1e-4 * (1 + glm::length(one.at(x, y))));
}

TEST_CASE("shadows are called for by a light that casts them and reaches something in view", "[shadow]") {
  Lit s;
  const auto planOf = [&](const View& view, const Quality& quality) { return makePlan(s.yard.scene, {&view, 1}, quality, Capabilities{}, {.size = kSize}); };
  s.yard.scene.lights.edit(s.sun)->name = "sun";
  s.yard.scene.lights.edit(s.spot)->name = "lamp";
  const FramePlan all = planOf(s.view, {});
  REQUIRE(all.on("shadows"));
  CHECK(effectOf(all, "shadows").reason.find("light 'sun' casts shadows") != std::string::npos);
  REQUIRE(all.target("shadow_maps"));
  const TargetPlan maps = *all.target("shadow_maps");
  CHECK(maps.bytes == std::uint64_t(maps.layers) * 1024 * 1024 * 4);
  CHECK(effectOf(all, "shadows").bytes == maps.bytes);
  CHECK(all.pass("shadow_maps") != nullptr);
  Quality off;
  off.shadow = Shadow::None;
  const FramePlan none = planOf(s.view, off);
  CHECK(!none.on("shadows"));
  CHECK(none.pass("shadow_maps") == nullptr);
  CHECK(none.target("shadow_maps") == nullptr);
  // Fewer lights, fewer layers; the spot alone takes one.
  s.yard.scene.lights.edit(s.sun)->castsShadow = false;
  s.yard.scene.lights.edit(s.point)->enabled = false;
  const FramePlan spot = planOf(s.view, {});
  CHECK(spot.target("shadow_maps")->layers == 1);
  CHECK(effectOf(spot, "shadows").reason.find("light 'lamp' casts shadows") != std::string::npos);
  // Away from what the lamp reaches.
  const View away = lookAt({40, 2, 0}, {80, 2, 0});
  place(s.yard.scene, box({50, 0, -5}, {60, 3, 5}), Material{});
  const FramePlan gone = planOf(away, {});
  CHECK(!gone.on("shadows"));
  CHECK(effectOf(gone, "shadows").reason.find("out of view: light 'lamp'") != std::string::npos);
  // No program of the frame without shadows knows of them.
  for (const ProgramPlan& p : none.programs) CHECK(p.name.find("shadow") == std::string::npos);
}

TEST_CASE("limits of shadows are said: too many maps, too many suns, a distance, sizes that cannot be, glass", "[shadow][sweep]") {
  Lit s;
  s.yard.scene.lights.edit(s.point)->name = "bulb";
  Quality few;
  few.shadowMaps = 5;
  s.stage.linear(s.yard.scene, s.view, kSize, few);
  CHECK(s.stage.renderer->lastPlan().target("shadow_maps")->layers <= 5);
  CHECK(warned(*s.stage.renderer, "light 'bulb'", "more than 5 shadow maps"));
  Quality near;
  near.shadowDistance = 3;
  s.stage.linear(s.yard.scene, s.view, kSize, near);
  CHECK(warned(*s.stage.renderer, "quality", "no shadows beyond 3 m"));
  Quality odd;
  odd.shadowResolution = 7;
  odd.shadowCascades = 9;
  s.stage.linear(s.yard.scene, s.view, kSize, odd);
  CHECK(warned(*s.stage.renderer, "quality", "shadowResolution is 7: 16 is used"));
  CHECK(warned(*s.stage.renderer, "quality", "shadowCascades is 9: 4 is used"));
  for (int i = 0; i < 4; ++i) {
    Light l = light(LightKind::Directional, vec3(1), 10);
    l.castsShadow = true;
    l.name = "extra";
    addLight(s.yard.scene, l, {0, 0, 0}, {0.1 * i, -1, 0.2});
  }
  s.yard.scene.lights.edit(s.sun)->angularDiameter = std::nanf("");
  Material pane;
  pane.name = "pane";
  pane.blend = true;
  place(s.yard.scene, quad({0, 1, 1}, {0.5f, 0, 0}, {0, 0.5f, 0}), pane);
  s.stage.linear(s.yard.scene, s.view, kSize);
  CHECK(warned(*s.stage.renderer, "light 'extra'", "past the limit of 4"));
  CHECK(warned(*s.stage.renderer, "an unnamed light", "angularDiameter"));
  CHECK(warned(*s.stage.renderer, "material 'pane'", "casts no shadow"));
  Quality soft;
  soft.shadow = Shadow::Pcss;
  s.yard.scene.lights.edit(s.spot)->name = "lamp";
  s.yard.scene.lights.edit(s.spot)->sourceRadius = 2;
  s.stage.linear(s.yard.scene, s.view, kSize, soft);
  CHECK(warned(*s.stage.renderer, "light 'lamp'", "held at 16 texels"));
  s.stage.linear(s.yard.scene, s.view, kSize);
  const std::size_t told = s.stage.renderer->report().warnings().size();
  s.stage.linear(s.yard.scene, s.view, kSize);
  CHECK(s.stage.renderer->report().warnings().size() == told);
}
