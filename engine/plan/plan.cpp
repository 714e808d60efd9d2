// makePlan: what the scene, the views, the quality and the machine call for. Nothing else decides what a frame does.
#include <burnish/plan.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "interface/limits.h"
#include "plan/variants.h"

namespace burnish {
namespace {

/// What the scene holds that effects are called by, each with the first thing that calls for it.
struct Needs {
  std::string geometry, occlusion, alphaTest, emissive;
  std::string directional, local, environment, background;
  int directionalLights = 0, localLights = 0;
  bool spots = false;
  std::set<plan::GeometryVariant> variants, emissiveVariants;
};

std::string named(std::string_view kind, const std::string& name) { return name.empty() ? fmt::format("an unnamed {}", kind) : fmt::format("{} '{}'", kind, name); }

void call(std::string& reason, std::string_view kind, const std::string& name, std::string_view why) {
  if (reason.empty()) reason = fmt::format("{}{}", named(kind, name), why);
}

void needsOfInstances(const Scene& scene, const Quality& quality, Needs& needs) {
  static const Material kDefault;
  scene.instances.each([&](Id<Instance>, const Instance& instance) {
    const Mesh* mesh = scene.meshes.get(instance.mesh);
    if (!instance.visible || !mesh || mesh->indices.empty()) return;
    const Material* found = scene.materials.get(instance.material);
    const Material& material = found ? *found : kDefault;
    plan::GeometryVariant variant = plan::variantOf(material, *mesh);
    if (quality.occlusion == Occlusion::None) variant.occlusionMap = variant.packed = false;
    call(needs.geometry, "instance", instance.name, "");
    if (variant.occlusionMap) call(needs.occlusion, "material", material.name, " has an occlusion map");
    if (variant.alphaTest) call(needs.alphaTest, "material", material.name, " is alpha tested");
    needs.variants.insert(variant);
    if (plan::emits(material)) {
      call(needs.emissive, "material", material.name, material.unlit ? " is unlit" : " emits");
      variant.occlusionMap = variant.packed = false;
      needs.emissiveVariants.insert(variant);
    }
  });
}

void needsOfLights(const Scene& scene, Needs& needs) {
  scene.lights.each([&](Id<Light>, const Light& light) {
    if (!light.enabled || !(light.intensity > 0)) return;
    if (light.kind == LightKind::Directional) {
      ++needs.directionalLights;
      call(needs.directional, "light", light.name, "");
    } else {
      ++needs.localLights;
      needs.spots |= light.kind == LightKind::Spot;
      call(needs.local, "light", light.name, "");
    }
  });
  const Environment& e = scene.environment;
  const bool lit = e.scale > 0 && (!e.map.empty() || e.color.r > 0 || e.color.g > 0 || e.color.b > 0);
  if (lit) needs.environment = e.map.empty() ? "the environment's colour" : "the environment map";
  if (lit && e.background) needs.background = needs.environment;
}

class Builder {
 public:
  Builder(const Scene& scene, std::span<const View> views, const Quality& quality, const Capabilities& caps, const PlanOptions& options)
      : views_(views), quality_(quality), caps_(caps), options_(options) {
    needsOfInstances(scene, quality, needs_);
    needsOfLights(scene, needs_);
    final_ = options.debugView == DebugView::Final || options.debugView == DebugView::Nonfinite;
    lightsView_ = options.debugView == DebugView::Lights;
    geometry_ = !needs_.geometry.empty() || options.hostDepthIn;
    occlusion_ = !needs_.occlusion.empty() && (final_ || options.debugView == DebugView::Occlusion);
    environment_ = !needs_.environment.empty() && (quality.environmentSpecular != EnvironmentSpecular::None || quality.ambient != Ambient::None);
    lit_ = geometry_ && (needs_.directionalLights > 0 || needs_.localLights > 0 || environment_);
    forwardRung_ = forwardOnlyRung(quality);
    forward_ = final_ && !needs_.geometry.empty() && (quality.path == Path::Forward || !forwardRung_.empty());
    automatic_ = final_ && options.output == Output::Display && !quality.exposureEv && options.debugView == DebugView::Final;
  }
  FramePlan build() {
    addEffects();
    addTargets();
    addPasses();
    return std::move(plan_);
  }

 private:
  void effect(std::string name, bool on, CalledBy by, std::string reason) { plan_.effects.push_back({std::move(name), on, by, std::move(reason)}); }
  void sceneEffect(std::string name, const std::string& need, bool wanted, std::string_view otherwise, std::string_view unwanted = "the debug view does not show it") {
    const bool on = wanted && !need.empty();
    effect(std::move(name), on, CalledBy::Scene, on ? need : need.empty() ? std::string(otherwise) : std::string(unwanted));
  }
  std::string program(const ProgramPlan& p) {
    if (std::find(plan_.programs.begin(), plan_.programs.end(), p) == plan_.programs.end()) plan_.programs.push_back(p);
    return p.name;
  }
  [[nodiscard]] plan::LightingVariant lighting(bool orthographic) const { return {std::min(needs_.directionalLights, MAX_DIRECTIONAL), environment_, occlusion_, orthographic}; }
  std::string screen(std::string name, std::string fragment, std::vector<std::string> defines) {
    return program({std::move(name), "post/screen.vert", std::move(fragment), std::move(defines)});
  }
  void target(std::string name, std::string format, int bytes, int w, int h) {
    plan_.targets.push_back({std::move(name), std::move(format), w, h, std::uint64_t(bytes) * std::uint64_t(w) * std::uint64_t(h)});
  }
  [[nodiscard]] bool reduceDepth() const { return options_.tileBounds == TileBounds::Reduction || (options_.tileBounds == TileBounds::Automatic && !caps_.software); }
  [[nodiscard]] bool anyView(bool orthographic) const {
    return std::any_of(views_.begin(), views_.end(), [&](const View& v) { return v.orthographic == orthographic; });
  }
  [[nodiscard]] std::vector<bool> projections() const {
    std::vector<bool> result;
    for (bool o : {false, true})
      if (anyView(o)) result.push_back(o);
    return result;
  }

  void addEffects();
  void addTargets();
  void addPasses();
  void addGeometry();
  void addLighting();
  void addForward();
  void addPost();

  std::span<const View> views_;
  const Quality& quality_;
  const Capabilities& caps_;
  const PlanOptions& options_;
  Needs needs_;
  FramePlan plan_;
  std::string forwardRung_;
  bool final_ = true, lightsView_ = false, geometry_ = false, occlusion_ = false, environment_ = false, lit_ = false, automatic_ = false, forward_ = false;
};

void Builder::addEffects() {
  sceneEffect("geometry", needs_.geometry, true, "no visible instance");
  sceneEffect("alpha_test", needs_.alphaTest, true, "a material with an alpha test would call for it");
  sceneEffect("baked_occlusion", needs_.occlusion, occlusion_, quality_.occlusion == Occlusion::None ? "the quality turns it off" : "a material with an occlusion map would call for it");
  sceneEffect("emissive", needs_.emissive, final_, "a material with emission would call for it");
  sceneEffect("directional_lights", needs_.directional.empty() ? "" : fmt::format("{} of them, the first is {}", needs_.directionalLights, needs_.directional),
              final_ && geometry_, "a directional light would call for it", geometry_ ? "the debug view does not show it" : "nothing to light");
  sceneEffect("local_lights", needs_.local.empty() ? "" : fmt::format("{} of them, the first is {}", needs_.localLights, needs_.local),
              (final_ || lightsView_) && geometry_, "a point or spot light would call for it", geometry_ ? "the debug view does not show it" : "nothing to light");
  sceneEffect("environment_lighting", environment_ ? needs_.environment : "", final_ && geometry_,
              needs_.environment.empty() ? "an environment map or colour would call for it" : "the quality turns it off",
              geometry_ ? "the debug view does not show it" : "nothing to light");
  sceneEffect("background", needs_.background, final_, "an environment shown as background would call for it");
  effect("forward_reference", forward_, CalledBy::Setting,
         forward_ ? (forwardRung_.empty() ? "path=forward" : forwardRung_ + " needs what the G-buffer does not hold")
                  : quality_.path == Path::Forward || !forwardRung_.empty() ? (geometry_ ? "the debug view shows the G-buffer" : "nothing to shade") : "path=forward or a forward-only rung would call for it");
  effect("auto_exposure", automatic_, CalledBy::Setting,
         automatic_ ? "no exposure is set" : options_.output == Output::Linear ? "linear output is untouched by exposure" : quality_.exposureEv ? "the exposure is set" : "the debug view does not need it");
  const bool toneMapped = options_.output == Output::Display && options_.debugView == DebugView::Final;
  effect("tone_mapping", toneMapped, CalledBy::Setting,
         toneMapped ? fmt::format("tone map '{}'", toneMapNames()[std::size_t(quality_.toneMap)]) : final_ ? "the output is linear" : "the debug view does not need it");
  effect("debug_view", options_.debugView != DebugView::Final, CalledBy::Setting,
         options_.debugView != DebugView::Final ? fmt::format("view '{}'", debugViewNames()[std::size_t(options_.debugView)]) : "a debug view would call for it");
  effect("host_depth_in", options_.hostDepthIn, CalledBy::Setting, options_.hostDepthIn ? "the target brings depth" : "a target that brings depth would call for it");
  effect("host_depth_out", options_.hostDepthOut, CalledBy::Setting, options_.hostDepthOut ? "the target takes depth" : "a target that takes depth would call for it");
  effect("host_draw", options_.hostDraw && final_, CalledBy::Setting, options_.hostDraw ? "the host draws into the frame" : "a draw callback would call for it");
  effect("nonfinite_count", options_.countNonfinite && final_, CalledBy::Setting, options_.countNonfinite ? "asked for" : "a request to count would call for it");
}

void Builder::addTargets() {
  const int w = options_.size.x, h = options_.size.y;
  if (geometry_) {
    target("depth", "DEPTH_COMPONENT32F", 4, w, h);
  }
  if (geometry_ && !forward_) {
    target("gbuffer_a", "RGBA8", 4, w, h);
    target("gbuffer_b", "RGBA8", 4, w, h);
    plan_.gbufferBytesPerPixel = 8;
    if (occlusion_) {
      target("gbuffer_c", "R8", 1, w, h);
      plan_.gbufferBytesPerPixel += 1;
    }
  }
  if (final_) {
    // Linear output keeps radiance in floats; a picture for a display is pre-exposed, so that half floats suffice.
    const bool wide = options_.output == Output::Linear;
    target("light", wide ? "RGBA32F" : "RGBA16F", wide ? 16 : 8, w, h);
  }
  if (automatic_) target("exposure", "RG32F", 8, 1, 1);
  const bool tiles = geometry_ && !forward_ && ((final_ && lit_) || lightsView_);
  if (tiles && reduceDepth()) target("tile_depth", "RGBA32F", 16, (w + 15) / 16, (h + 15) / 16);
}

void Builder::addGeometry() {
  if (options_.hostDepthIn) plan_.passes.push_back({"depth_in", {"host depth"}, {"depth"}, {screen("depth_in", "post/depth_in.frag", {})}});
  if (!geometry_) return;
  PassPlan pass{"gbuffer", {"meshes", "materials"}, {"gbuffer_a", "gbuffer_b"}, {}};
  if (occlusion_) pass.writes.push_back("gbuffer_c");
  pass.writes.push_back("depth");
  for (const plan::GeometryVariant& v : needs_.variants) pass.programs.push_back(program(plan::geometryProgram(plan::GeometryPass::GBuffer, v, occlusion_)));
  plan_.passes.push_back(std::move(pass));
}

void Builder::addLighting() {
  if (!geometry_ || !((lit_ && final_) || lightsView_)) return;
  const bool local = needs_.localLights > 0;
  PassPlan bounds{"tiles", {"depth", "lights"}, {"light lists"}, {}};
  if (reduceDepth()) {
    bounds.writes.push_back("tile_depth");
    for (bool o : projections()) bounds.programs.push_back(screen(o ? "tile_depth+ortho" : "tile_depth", "lighting/tile_depth.frag", {fmt::format("ORTHOGRAPHIC {}", int(o))}));
  }
  plan_.passes.push_back(std::move(bounds));
  if (lightsView_) return;
  PassPlan pass{"lighting", {"gbuffer_a", "gbuffer_b", "depth", "lights", "light lists"}, {"light"}, {}};
  if (occlusion_) pass.reads.push_back("gbuffer_c");
  if (plan::needsCube(quality_, environment_)) pass.reads.push_back("environment cube");
  if (plan::needsDfg(quality_, environment_)) pass.reads.push_back("dfg");
  for (bool orthographic : projections()) {
    for (int bucket : plan::kTileBuckets) {
      if (bucket > 0 && !local) break;
      pass.programs.push_back(program(plan::lightingProgram(bucket, quality_, lighting(orthographic))));
      if (bucket >= needs_.localLights) break;
    }
    if (local) pass.programs.push_back(program(plan::lightingProgram(plan::kLoop, quality_, lighting(orthographic))));
    if (needs_.spots) pass.programs.push_back(program(plan::lightingProgram(plan::kLoopSpots, quality_, lighting(orthographic))));
  }
  plan_.passes.push_back(std::move(pass));
}

void Builder::addPost() {
  if (final_) {
    if (!needs_.emissive.empty()) {
      PassPlan pass{"emissive", {"meshes", "materials", "depth"}, {"light"}, {}};
      for (const plan::GeometryVariant& v : needs_.emissiveVariants) pass.programs.push_back(program(plan::geometryProgram(plan::GeometryPass::Emissive, v, false)));
      plan_.passes.push_back(std::move(pass));
    }
    if (!needs_.background.empty()) {
      PassPlan pass{"background", {"environment"}, {"light"}, {}};
      if (geometry_) pass.reads.push_back("depth");
      const bool map = needs_.background == "the environment map";
      for (bool o : projections())
        pass.programs.push_back(screen(o ? "background+ortho" : "background", "lighting/sky.frag", {fmt::format("ORTHOGRAPHIC {}", int(o)), fmt::format("SKY_MAP {}", int(map))}));
      plan_.passes.push_back(std::move(pass));
    }
    if (options_.hostDraw) plan_.passes.push_back({"host_draw", {"depth"}, {"light"}, {}});
    if (automatic_) plan_.passes.push_back({"exposure", {"light"}, {"exposure"}, {screen("exposure", "post/exposure.frag", {})}});
    if (options_.countNonfinite) plan_.passes.push_back({"nonfinite_count", {"light"}, {}, {}});
  }
  const std::string hostMask = fmt::format("HOST_DEPTH {}", int(options_.hostDepthIn));
  if (options_.debugView == DebugView::Final) {
    PassPlan pass{"tonemap", {"light"}, {"target"}, {}};
    if (automatic_) pass.reads.push_back("exposure");
    if (options_.hostDepthIn) pass.reads.insert(pass.reads.end(), {"gbuffer_b", "depth"});
    const bool linear = options_.output == Output::Linear;
    pass.programs.push_back(screen("tonemap", "post/tonemap.frag", {fmt::format("AUTO_EXPOSURE {}", int(automatic_)), hostMask, fmt::format("LINEAR {}", int(linear)), fmt::format("TONEMAP {}", linear ? 0 : int(quality_.toneMap))}));
    plan_.passes.push_back(std::move(pass));
  } else if (lightsView_) {
    plan_.passes.push_back({"debug_view", {"light lists"}, {"target"}, {program({"debug_lights", "post/lights.vert", "post/lights.frag", {}})}});
  } else {
    PassPlan pass{"debug_view", {"gbuffer_a", "gbuffer_b", "depth"}, {"target"}, {}};
    if (options_.debugView == DebugView::Nonfinite) pass.reads = {"light"};
    for (bool o : projections())
      pass.programs.push_back(screen(o ? "debug_view+ortho" : "debug_view", "post/debug.frag",
                                     {fmt::format("GEOMETRY {}", int(geometry_)), fmt::format("OCCLUSION {}", int(occlusion_)), fmt::format("ORTHOGRAPHIC {}", int(o)), fmt::format("VIEW {}", int(options_.debugView))}));
    plan_.passes.push_back(std::move(pass));
  }
  if (options_.hostDepthOut) plan_.passes.push_back({"depth_out", {"depth"}, {"host depth"}, {screen("depth_out", "post/depth_out.frag", {fmt::format("GEOMETRY {}", int(geometry_))})}});
}

// One pass in place of G-buffer, tiles and lighting.
void Builder::addForward() {
  PassPlan pass{"forward", {"meshes", "materials", "lights"}, {"light", "depth"}, {}};
  if (plan::needsCube(quality_, environment_)) pass.reads.push_back("environment cube");
  if (plan::needsDfg(quality_, environment_)) pass.reads.push_back("dfg");
  for (bool orthographic : projections())
    for (const plan::GeometryVariant& v : needs_.variants) pass.programs.push_back(program(plan::forwardProgram(v, quality_, lighting(orthographic))));
  plan_.passes.push_back(std::move(pass));
}

void Builder::addPasses() {
  if (forward_) {
    addForward();
  } else {
    addGeometry();
    addLighting();
  }
  addPost();
}

constexpr std::array<std::string_view, 4> kToneMaps{"none", "neutral", "agx", "aces"};
constexpr std::array<std::string_view, 10> kDebugViews{"final", "albedo", "substance", "normal", "roughness", "depth", "position", "occlusion", "lights", "nonfinite"};

template <class Row>
const Row* byName(const std::vector<Row>& rows, std::string_view name) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.name == name; });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace

std::span<const std::string_view> toneMapNames() { return kToneMaps; }
std::span<const std::string_view> debugViewNames() { return kDebugViews; }

bool FramePlan::on(std::string_view effect) const {
  const EffectPlan* e = byName(effects, effect);
  return e && e->on;
}
const PassPlan* FramePlan::pass(std::string_view name) const { return byName(passes, name); }
const TargetPlan* FramePlan::target(std::string_view name) const { return byName(targets, name); }

FramePlan makePlan(const Scene& scene, std::span<const View> views, const Quality& quality, const Capabilities& caps, const PlanOptions& options) {
  return Builder(scene, views, quality, caps, options).build();
}

}  // namespace burnish
