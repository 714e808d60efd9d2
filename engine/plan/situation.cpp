#include "plan/situation.h"

#include <fmt/format.h>

#include <algorithm>

#include "interface/limits.h"

namespace burnish::plan {
namespace {

std::string named(std::string_view kind, const std::string& name) { return name.empty() ? fmt::format("an unnamed {}", kind) : fmt::format("{} '{}'", kind, name); }

void addBatch(const Scene& scene, const scene::VisibleInstance& seen, bool instanced, const Quality& quality, Facts& facts) {
  static const Material kDefault;
  const Material* found = scene.materials.get(seen.instance->material);
  const Material& material = found ? *found : kDefault;
  GeometryVariant variant = variantOf(material, *seen.mesh);
  variant.instanced = instanced;
  if (quality.occlusion == Occlusion::None) variant.occlusionMap = variant.packed = false;
  facts.call(Call::Geometry, "instance", seen.instance->name, "");
  if (seen.pose) {
    facts.call(Call::Deformation, "instance", seen.instance->name, seen.pose->skinned ? " has a skin" : " has morph weights");
    facts.deformVariants.insert({seen.pose->skinned, seen.pose->morphed});
  }
  if (material.twoSided) facts.call(Call::TwoSided, "material", material.name, " is two-sided");
  if (variant.occlusionMap) facts.call(Call::BakedOcclusion, "material", material.name, " has an occlusion map");
  if (variant.alphaTest) facts.call(Call::AlphaTest, "material", material.name, " is alpha tested");
  facts.variants.insert(variant);
  if (!emits(material)) return;
  facts.call(Call::Emissive, "material", material.name, material.unlit ? " is unlit" : " emits");
  variant.occlusionMap = variant.packed = false;
  facts.emissiveVariants.insert(variant);
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
  out.lights = scene::gatherLights(scene, derived, out.frame, quality, report);
}

void lookEverywhere(const Scene& scene, const scene::Derived& derived, const View& view, glm::ivec2 targetSize, const Quality& quality, Report& report, Seen& out) {
  out.frame = scene::frameOf(view, targetSize);
  scene::findVisible(scene, derived, out.frame, out.instances, scene::Reach::Everywhere);
  out.batches = scene::batch(out.instances);
  out.lights = scene::gatherLights(scene, derived, out.frame, quality, report, scene::Reach::Everywhere);
}

void Facts::call(Call call, std::string_view kind, const std::string& name, std::string_view because) {
  std::string& reason = why[std::size_t(call)];
  if (reason.empty()) reason = fmt::format("{}{}", named(kind, name), because);
}

Facts factsOf(const Scene& scene, std::span<const Seen> views, const Quality& quality) {
  Facts facts;
  for (const Seen& view : views) {
    for (const scene::Batch& b : view.batches) addBatch(scene, view.instances[b.first], b.count > 1, quality, facts);
    addLights(scene, view.lights, facts);
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
  return {on("directional_lights") ? std::min(facts.directionalLights, MAX_DIRECTIONAL) : 0, on("environment_lighting"), on("baked_occlusion") || on("screen_occlusion"), orthographic, developsInPlace() ? int(quality.toneMap) : -1};
}

}  // namespace burnish::plan
