#include "plan/situation.h"

#include <fmt/format.h>

#include <algorithm>

#include "interface/limits.h"
#include "scene/fog.h"

namespace burnish::plan {
namespace {

std::string named(std::string_view kind, const std::string& name) { return name.empty() ? fmt::format("an unnamed {}", kind) : fmt::format("{} '{}'", kind, name); }

/// Which transparent surfaces there can be at all.
struct Allowed {
  bool blend, glass;
  explicit Allowed(const PlanOptions& o) {
    const bool final = o.debugView == DebugView::Final || o.debugView == DebugView::Nonfinite;
    const auto listed = [&](std::string_view name) { return final && std::find(o.removed.begin(), o.removed.end(), name) == o.removed.end(); };
    blend = listed("alpha_blend");
    glass = listed("glass");
  }
};

void addTransparent(const Material& material, const Mesh& mesh, int count, const Quality& quality, Facts& facts) {
  const TransparentVariant variant = transparentVariantOf(material, mesh, quality.occlusion != Occlusion::None);
  const bool glass = scene::isGlass(material);
  facts.call(glass ? Call::Glass : Call::AlphaBlend, "material", material.name, glass ? " is glass" : " is blended", count);
  (glass ? facts.glass : facts.blended).insert(variant);
}

void addBatch(const Scene& scene, const scene::VisibleInstance& seen, int count, const Quality& quality, Allowed allowed, Facts& facts) {
  static const Material kDefault;
  const Material* found = scene.materials.get(seen.instance->material);
  const Material& material = found ? *found : kDefault;
  GeometryVariant variant = variantOf(material, *seen.mesh);
  variant.instanced = count > 1;
  if (quality.occlusion == Occlusion::None) variant.occlusionMap = false;
  facts.call(Call::Geometry, "instance", seen.instance->name, "", count);
  if (seen.pose) {
    facts.call(Call::Deformation, "instance", seen.instance->name, seen.pose->skinned ? " has a skin" : " has morph weights", count);
    facts.deformVariants.insert({seen.pose->skinned, seen.pose->morphed});
  }
  if (material.twoSided) facts.call(Call::TwoSided, "material", material.name, " is two-sided", count);
  if (variant.occlusionMap) facts.call(Call::BakedOcclusion, "material", material.name, " has an occlusion map", count);
  if (variant.alphaTest) facts.call(Call::AlphaTest, "material", material.name, " is alpha tested", count);
  if (drawnTransparent(material, allowed.blend, allowed.glass)) return addTransparent(material, *seen.mesh, count, quality, facts);
  facts.variants.insert(variant);
  if (!emits(material)) return;
  facts.call(Call::Emissive, "material", material.name, material.unlit ? " is unlit" : " emits", count);
  variant.occlusionMap = variant.packed = false;
  facts.emissiveVariants.insert(variant);
}

void addGroups(const Scene& scene, const Seen& view, Allowed allowed, Facts& facts) {
  for (const scene::TransparentGroup& group : view.transparent) {
    int surfaces = 0;
    for (const scene::TransparentPart& part : group.parts) {
      const Material* m = scene.materials.get(view.instances[part.instance].instance->material);
      if (!m || !drawnTransparent(*m, allowed.blend, allowed.glass)) continue;
      ++surfaces;
      facts.refracts |= part.refracts;
      facts.blurs |= part.blurs;
    }
    facts.peels |= group.peel && surfaces > 0;
  }
}

void addLights(const Scene& scene, const scene::LightSet& lights, Facts& facts) {
  const auto name = [&](Id<Light> id) { return scene.lights.get(id) ? scene.lights.get(id)->name : std::string(); };
  for (const scene::DirectionalLight& l : lights.directional) facts.call(Call::Directional, "light", name(l.id), "");
  for (const scene::LocalLight& l : lights.local) {
    facts.spots |= l.cosOuter > -2;
    facts.call(Call::Local, "light", name(l.id), "");
  }
  facts.directionalLights = std::max(facts.directionalLights, int(lights.directional.size()));
  facts.localLights = std::max(facts.localLights, int(lights.local.size()));
}

void addEnvironment(const Environment& e, Facts& facts) {
  if (!(e.scale > 0) || (e.map.empty() && !(e.color.r > 0 || e.color.g > 0 || e.color.b > 0))) return;
  const std::string why = e.map.empty() ? "the environment's colour" : "the environment map";
  facts.why[std::size_t(Call::Environment)] = why;
  if (e.background) facts.why[std::size_t(Call::Background)] = why;
}

}  // namespace

void look(const Scene& scene, const scene::Derived& derived, const View& view, glm::ivec2 targetSize, const Quality& quality, Report& report, Seen& out) {
  out.frame = scene::frameOf(view, targetSize);
  scene::findVisible(scene, derived, out.frame, out.instances);
  out.batches = scene::batch(out.instances);
  out.transparent = scene::orderTransparent(scene, derived, out.frame, out.instances);
  out.lights = scene::gatherLights(scene, derived, out.frame, quality, report);
  out.fogDepth = scene::deepestFog(scene, derived, out.frame, out.instances, out.lights);
}

void lookEverywhere(const Scene& scene, const scene::Derived& derived, const View& view, glm::ivec2 targetSize, const Quality& quality, Report& report, Seen& out) {
  out.frame = scene::frameOf(view, targetSize);
  scene::findVisible(scene, derived, out.frame, out.instances, scene::Reach::Everywhere);
  out.batches = scene::batch(out.instances);
  out.transparent = scene::orderTransparent(scene, derived, out.frame, out.instances);
  out.lights = scene::gatherLights(scene, derived, out.frame, quality, report, scene::Reach::Everywhere);
  out.fogDepth = scene::deepestFog(scene, derived, out.frame, out.instances, out.lights);
}

void Facts::call(Call call, std::string_view kind, const std::string& name, std::string_view because, int count) {
  objects[std::size_t(call)] += count;
  std::string& reason = why[std::size_t(call)];
  if (reason.empty()) reason = fmt::format("{}{}", named(kind, name), because);
}

Facts factsOf(const Scene& scene, std::span<const Seen> views, const Quality& quality, const PlanOptions& options) {
  Facts facts;
  const Allowed allowed(options);
  for (const Seen& view : views) {
    for (const scene::Batch& b : view.batches) addBatch(scene, view.instances[b.first], int(b.count), quality, allowed, facts);
    addGroups(scene, view, allowed, facts);
    addLights(scene, view.lights, facts);
    if (view.fogDepth > scene::kLeastFog) facts.why[std::size_t(Call::Fog)] = "the scene's fog";
  }
  addEnvironment(scene.environment, facts);
  return facts;
}

bool Situation::on(std::string_view effect) const {
  const auto found = std::find_if(effects.begin(), effects.end(), [&](const EffectPlan& e) { return e.name == effect; });
  return found != effects.end() && found->on;
}

std::vector<bool> Situation::projections() const {
  std::vector<bool> result;
  for (bool o : {false, true})
    if (std::any_of(views.begin(), views.end(), [&](const Seen& v) { return v.frame.orthographic == o; })) result.push_back(o);
  return result;
}

LightingVariant Situation::lighting(bool orthographic) const {
  return {on("directional_lights") ? std::min(facts.directionalLights, MAX_DIRECTIONAL) : 0, on("environment_lighting"), on("baked_occlusion") || on("screen_occlusion"), orthographic, developsInPlace() ? int(quality.toneMap) : -1, on("fog"), on("local_lights")};
}

LightingVariant Situation::drawnLighting(bool orthographic) const {
  LightingVariant variant = lighting(orthographic);
  variant.occlusion = on("baked_occlusion");
  return variant;
}

}  // namespace burnish::plan
