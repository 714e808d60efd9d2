// The plan as data: what is in view decides, reasons name who calls or would, effects can be taken off the list or forced, every pass and target has an owner.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

#include "gl/formats.h"
#include "plan/formats.h"
#include "render/workshop.h"

namespace burnish::test {
namespace {

FramePlan planOf(const Scene& scene, const View& view, const PlanOptions& options = {.size = {64, 64}}) { return makePlan(scene, {&view, 1}, {}, Capabilities{}, options); }

const EffectPlan& effectOf(const FramePlan& plan, std::string_view name) {
  const auto found = std::find_if(plan.effects.begin(), plan.effects.end(), [&](const EffectPlan& e) { return e.name == name; });
  REQUIRE(found != plan.effects.end());
  return *found;
}

bool lists(const std::vector<std::string>& names, std::string_view name) { return std::find(names.begin(), names.end(), name) != names.end(); }

}  // namespace

TEST_CASE("the plan is of what the views see: turning away turns effects off, and the reason says who is out of view") {
  Workshop w;
  w.scene.materials.edit(w.material)->emission = vec3(1);
  w.scene.materials.edit(w.material)->alphaTest = true;
  const View away = lookAt(w.view.eye, w.view.eye * 2.0, {0, 1, 0}, 0.6f);
  const FramePlan here = planOf(w.scene, w.view), there = planOf(w.scene, away);
  for (const char* name : {"geometry", "alpha_test", "emissive", "local_lights"}) {
    CAPTURE(name);
    CHECK(here.on(name));
    CHECK(!there.on(name));
    if (std::string_view(name) != "local_lights") CHECK(effectOf(there, name).reason.starts_with("out of view: "));
  }
  CHECK(there.target("gbuffer_a") == nullptr);
  CHECK(there.pass("emissive") == nullptr);
  CHECK(there.programs.size() < here.programs.size());
  PlanOptions whole{.size = {64, 64}};
  whole.wholeScene = true;
  const FramePlan all = planOf(w.scene, away, whole);
  for (const ProgramPlan& p : here.programs) CHECK(std::count(all.programs.begin(), all.programs.end(), p) == 1);
}

TEST_CASE("a local light out of reach of the view is not planned for") {
  Scene scene;
  place(scene, sphere(1, 8, 16), Material{});
  addLight(scene, light(LightKind::Point, vec3(1), 10, 2), {0, 0, 40});
  const View view = lookAt({0, 0, 5}, {0, 0, 0});
  const FramePlan plan = planOf(scene, view);
  CHECK(!plan.on("local_lights"));
  CHECK(plan.pass("tiles") == nullptr);
}

TEST_CASE("effects taken off the list are not planned; scene effects can be forced") {
  Workshop w;
  const FramePlan usual = planOf(w.scene, w.view);
  for (const EffectInfo& info : effectList()) {
    CAPTURE(info.name);
    PlanOptions without{.size = {64, 64}}, forced = without;
    without.removed = {std::string(info.name)};
    forced.forced = {std::string(info.name)};
    const FramePlan off = planOf(w.scene, w.view, without);
    CHECK(off.effects.size() + 1 == usual.effects.size());
    CHECK(!off.on(info.name));
    const bool scene = info.calledBy == CalledBy::Scene;
    CHECK(planOf(w.scene, w.view, forced).on(info.name) == (scene || usual.on(info.name)));
    for (const PassPlan& pass : off.passes) CHECK(!lists(pass.effects, info.name));
  }
}

TEST_CASE("every pass and target of a plan has an effect that calls for it, and effects list them") {
  Workshop w;
  w.scene.materials.edit(w.material)->emission = vec3(1);
  w.scene.materials.edit(w.material)->mapC = w.occlusion;
  for (DebugView view : {DebugView::Final, DebugView::Lights, DebugView::Normal, DebugView::Nonfinite}) {
    PlanOptions options{.size = {64, 48}};
    options.debugView = view;
    options.countNonfinite = true;
    const FramePlan plan = planOf(w.scene, w.view, options);
    for (const PassPlan& pass : plan.passes) {
      CAPTURE(pass.name);
      CHECK(!pass.effects.empty());
      for (const std::string& e : pass.effects) CHECK(lists(effectOf(plan, e).passes, pass.name));
      for (const std::string& name : pass.programs) CHECK(lists(effectOf(plan, pass.effects.front()).programs, name));
    }
    for (const TargetPlan& target : plan.targets) {
      CAPTURE(target.name);
      CHECK(!target.effects.empty());
      for (const std::string& e : target.effects) CHECK(effectOf(plan, e).bytes >= target.bytes);
      CHECK(target.bytes > 0);
    }
    for (const EffectPlan& e : plan.effects)
      if (!e.on) CHECK((e.passes.empty() && e.targets.empty() && e.programs.empty() && e.bytes == 0));
  }
}

TEST_CASE("effects count the objects in view that call for them, in every view") {
  Scene scene;
  const Id<Mesh> ball = scene.meshes.add(sphere(0.3f, 8, 16));
  Material glowing;
  glowing.emission = vec3(1);
  const Id<Material> emits = scene.materials.add(std::move(glowing)), plain = scene.materials.add(Material{});
  const auto put = [&](Id<Material> material, float x, float z) {
    Instance i;
    i.mesh = ball;
    i.material = material;
    i.node = scene.nodes.add(Node{.local = glm::translate(glm::dmat4(1), dvec3(x, 0, z))});
    scene.instances.add(std::move(i));
  };
  for (int i = 0; i < 12; ++i) put(plain, float(i % 4) - 1.5f, -float(i / 4));  // enough of them to become one draw
  for (int i = 0; i < 3; ++i) put(emits, float(i) - 1.0f, -4);
  put(emits, 0, 40);  // behind the eye
  addLight(scene, light(LightKind::Point, vec3(1), 10, 50), {0, 2, 0});
  addLight(scene, light(LightKind::Point, vec3(1), 10, 50), {0, -2, 0});
  const std::array<View, 2> views{lookAt({0, 0, 6}, {0, 0, 0}), lookAt({0, 0, 6}, {0, 0, 0})};
  const FramePlan one = planOf(scene, views[0]), two = makePlan(scene, views, {}, Capabilities{}, {.size = {64, 64}});
  CHECK(effectOf(one, "geometry").objects == 15);
  CHECK(effectOf(one, "emissive").objects == 3);
  CHECK(effectOf(one, "local_lights").objects == 2);
  CHECK(effectOf(one, "directional_lights").objects == 0);
  CHECK(effectOf(one, "tone_mapping").objects == 0);
  CHECK(effectOf(two, "emissive").objects == 6);
}

TEST_CASE("the log says which effects went on and off, once, and why") {
  std::vector<std::string> lines;
  RendererOptions options;
  options.log = [&](LogLevel level, std::string_view text) {
    if (level == LogLevel::Info) lines.emplace_back(text);
  };
  Stage stage(options);
  Workshop w;
  stage.display(w.scene, w.view, {32, 32}, {});
  CHECK(lists(lines, "effect 'tone_mapping' on: tone map 'neutral'"));
  lines.clear();
  stage.display(w.scene, w.view, {32, 32}, {});
  CHECK(lines.empty());
  w.scene.materials.edit(w.material)->name = "lamp";
  w.scene.materials.edit(w.material)->emission = vec3(1);
  stage.display(w.scene, w.view, {32, 32}, {});
  CHECK(lines == std::vector<std::string>{"effect 'emissive' on: material 'lamp' emits"});
}

TEST_CASE("where nothing needs the light buffer there is none: lighting and background develop in place, within 1/255", "[sweep]") {
  Workshop w;
  w.scene.environment.map = {};
  w.scene.environment.color = vec3(3, 5, 9);
  w.scene.environment.background = true;
  Stage stage;
  for (ToneMap map : {ToneMap::None, ToneMap::Neutral, ToneMap::AgX, ToneMap::Aces})
    for (bool orthographic : {false, true}) {
      CAPTURE(int(map), orthographic);
      View view = w.view;
      view.orthographic = orthographic;
      view.far = 100;
      Quality quality;
      quality.toneMap = map;
      quality.exposureEv = 2;
      const Picture direct = stage.draw(w.scene, {&view, 1}, {75, 53}, quality, {});
      const FramePlan plan = stage.renderer->lastPlan();
      CHECK(plan.target("light") == nullptr);
      CHECK(plan.pass("tonemap") == nullptr);
      CHECK(lists(effectOf(plan, "tone_mapping").passes, "lighting"));
      RenderRequest counted;
      counted.countNonfinite = true;  // it reads the light buffer
      const Picture buffered = stage.draw(w.scene, {&view, 1}, {75, 53}, quality, counted);
      CHECK(stage.renderer->lastPlan().target("light") != nullptr);
      double worst = 0, mean = 0;
      for (int y = 0; y < 53; ++y)
        for (int x = 0; x < 75; ++x) {
          const dvec3 d = glm::abs(direct.at(x, y) - buffered.at(x, y));
          worst = std::max({worst, d.x, d.y, d.z});
          mean += direct.at(x, y).y;
        }
      CHECK(worst <= 1.01 / 255);
      CHECK(mean > 75 * 53 * 0.05);
    }
  // Two views in one target: neither writes outside its rectangle.
  View left = w.view, right = w.view;
  left.viewport = {0, 0, 40, 53};
  right.viewport = {40, 10, 30, 30};
  const View views[] = {left, right};
  Quality quality;
  quality.exposureEv = 2;
  const Picture both = stage.draw(w.scene, views, {75, 53}, quality, {});
  CHECK(stage.renderer->lastPlan().target("light") == nullptr);
  const Picture alone = stage.draw(w.scene, {&left, 1}, {75, 53}, quality, {});
  for (int y = 0; y < 53; ++y)
    for (int x = 0; x < 40; ++x) REQUIRE(both.at(x, y) == alone.at(x, y));
}

TEST_CASE("bytes of target formats agree with OpenGL's table") {
  int known = 0;
  for (const gl::FormatInfo& f : gl::formats())
    if (const int bytes = plan::bytesOf(f.name)) {
      CHECK(bytes == f.bytes);
      ++known;
    }
  CHECK(known >= 16);
  CHECK(plan::bytesOf("RGBA7") == 0);
}

}  // namespace burnish::test
