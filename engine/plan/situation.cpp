#include "plan/situation.h"

#include <fmt/format.h>

#include <algorithm>

#include "interface/limits.h"
#include "plan/rungs.h"
#include "scene/fog.h"

namespace burnish::plan {
namespace {

std::string named(std::string_view kind, const std::string& name) { return name.empty() ? fmt::format("an unnamed {}", kind) : fmt::format("{} '{}'", kind, name); }

/// Which transparent surfaces and which details there can be at all.
struct Allowed {
  bool blend, glass;
  Details details;
  Allowed(const PlanOptions& o, const Quality& quality) {
    const bool final = o.debugView == DebugView::Final || o.debugView == DebugView::Nonfinite;
    const auto listed = [&](std::string_view name) { return std::find(o.removed.begin(), o.removed.end(), name) == o.removed.end(); };
    blend = final && listed("alpha_blend");
    glass = final && listed("glass");
    details.brushed = (final || o.debugView == DebugView::Anisotropy) && drawsBrushed(quality) && listed("anisotropy");
    details.rough = (final || o.debugView == DebugView::DiffuseRoughness) && quality.roughDiffuse != RoughDiffuse::None && listed("rough_diffuse");
  }
};

void callDetails(const Material& material, const GeometryVariant& variant, int count, Facts& facts) {
  if (variant.brushed) facts.call(Call::Anisotropy, "material", material.name, " is brushed", count);
  if (variant.rough) facts.call(Call::RoughDiffuse, "material", material.name, " is rough", count);
}

void addTransparent(const Material& material, const Mesh& mesh, int count, const Quality& quality, Details details, Facts& facts) {
  const TransparentVariant variant = transparentVariantOf(material, mesh, quality.occlusion != Occlusion::None, details);
  callDetails(material, variant.geometry, count, facts);
  const bool glass = scene::isGlass(material);
  facts.call(glass ? Call::Glass : Call::AlphaBlend, "material", material.name, glass ? " is glass" : " is blended", count);
  (glass ? facts.glass : facts.blended).insert(variant);
}

void addBatch(const Scene& scene, const scene::VisibleInstance& seen, int count, const Quality& quality, Allowed allowed, Facts& facts) {
  static const Material kDefault;
  const Material* found = scene.materials.get(seen.instance->material);
  const Material& material = found ? *found : kDefault;
  GeometryVariant variant = variantOf(material, *seen.mesh, allowed.details);
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
  if (drawnTransparent(material, allowed.blend, allowed.glass)) return addTransparent(material, *seen.mesh, count, quality, allowed.details, facts);
  callDetails(material, variant, count, facts);
  facts.details |= variant.detail();
  facts.variants.insert(variant);
  if (!emits(material)) return;
  facts.call(Call::Emissive, "material", material.name, material.unlit ? " is unlit" : " emits", count);
  facts.emissiveVariants.insert(variant.shapeOnly());
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

void addProbes(const Scene& scene, std::span<const scene::SeenProbe> probes, Facts& facts) {
  for (const scene::SeenProbe& p : probes) facts.call(Call::ReflectionProbe, "reflection probe", scene.probes.reflections[p.index].name, "");
  facts.probes = std::max(facts.probes, int(probes.size()));
}

void addGrid(const Scene& scene, bool seen, Facts& facts) {
  if (seen) facts.call(Call::AmbientGrid, "ambient lattice", scene.probes.grid->name, "");
}

void addShadows(const Scene& scene, const scene::ShadowSet& shadows, Facts& facts) {
  for (std::size_t i = 0; i < shadows.callers.size(); ++i) facts.call(i < shadows.suns.size() ? Call::SunShadows : Call::LocalShadows, "light", shadows.callers[i], " casts shadows");
  facts.shadowSuns = std::max(facts.shadowSuns, int(shadows.suns.size()));
  std::vector<bool> counted(shadows.casters.size());
  for (const scene::ShadowMap& map : shadows.maps) {
    (map.sun ? facts.sunMaps : facts.localMaps).insert(map.content);
    for (const std::uint32_t i : map.casters) {
      const scene::Placed& p = shadows.casters[i].placed;
      const Material* m = scene.materials.get(p.instance->material);
      facts.shadowVariants.insert(m ? shadowVariantOf(*m, *p.mesh) : ShadowVariant{});
      if (!p.pose) continue;
      facts.call(Call::Deformation, "instance", p.instance->name, p.pose->skinned ? " has a skin" : " has morph weights", counted[i] || shadows.casters[i].seen ? 0 : 1);
      counted[i] = true;
      facts.shadowDeformVariants.insert({p.pose->skinned, p.pose->morphed});
    }
  }
}

void addEnvironment(const Environment& e, Facts& facts) {
  if (!(e.scale > 0) || (e.map.empty() && !(e.color.r > 0 || e.color.g > 0 || e.color.b > 0))) return;
  const std::string why = e.map.empty() ? "the environment's colour" : "the environment map";
  facts.why[std::size_t(Call::Environment)] = why;
  if (e.background) facts.why[std::size_t(Call::Background)] = why;
}

/// Its disc, with room for its smooth edge, is in a perspective view.
bool sees(const scene::ViewFrame& v, const Environment::Sun& sun) {
  if (v.orthographic) return false;
  const glm::dvec3 s(sun.toSun);
  const double forward = -glm::dot(v.axes[2], s), pixel = 2 * std::max(v.tanX / std::max(v.viewport.z, 1), v.tanY / std::max(v.viewport.w, 1)), room = double(sun.radius) + 2 * pixel;
  const auto within = [&](double along, double tan) { return std::abs(along) <= forward * tan + room * std::sqrt(1 + tan * tan); };
  return within(glm::dot(v.axes[0], s), v.tanX) && within(glm::dot(v.axes[1], s), v.tanY);
}

}  // namespace

void look(const Scene& scene, const scene::Derived& derived, const View& view, glm::ivec2 targetSize, const Quality& quality, Report& report, Seen& out, glm::dvec2 jitter, glm::ivec2 shaded) {
  out.frame = scene::frameOf(view, targetSize, jitter, shaded);
  scene::findVisible(scene, derived, out.frame, out.instances);
  out.batches = scene::batch(out.instances);
  out.transparent = scene::orderTransparent(scene, derived, out.frame, out.instances);
  out.lights = scene::gatherLights(scene, derived, out.frame, quality, report);
  out.probes = scene::findProbes(scene, out.frame, report);
  const AmbientGrid* grid = scene::usableGrid(scene, &report);
  out.grid = grid && scene::meetsGrid(*grid, out.frame);
  out.fogDepth = scene::deepestFog(scene, derived, out.frame, out.instances, out.lights);
  scene::gatherShadows(scene, derived, out.frame, quality, out.instances, scene::Reach::InView, out.lights, report, out.shadows);
}

void lookEverywhere(const Scene& scene, const scene::Derived& derived, const View& view, glm::ivec2 targetSize, const Quality& quality, Report& report, Seen& out, glm::ivec2 shaded) {
  out.frame = scene::frameOf(view, targetSize, {0, 0}, shaded);
  scene::findVisible(scene, derived, out.frame, out.instances, scene::Reach::Everywhere);
  out.batches = scene::batch(out.instances);
  out.transparent = scene::orderTransparent(scene, derived, out.frame, out.instances);
  out.lights = scene::gatherLights(scene, derived, out.frame, quality, report, scene::Reach::Everywhere);
  out.probes = scene::findProbes(scene, out.frame, report, scene::Reach::Everywhere);
  out.grid = scene::usableGrid(scene, &report) != nullptr;
  out.fogDepth = scene::deepestFog(scene, derived, out.frame, out.instances, out.lights);
  scene::gatherShadows(scene, derived, out.frame, quality, out.instances, scene::Reach::Everywhere, out.lights, report, out.shadows);
}

void Facts::call(Call call, std::string_view kind, const std::string& name, std::string_view because, int count) {
  objects[std::size_t(call)] += count;
  std::string& reason = why[std::size_t(call)];
  if (reason.empty()) reason = fmt::format("{}{}", named(kind, name), because);
}

Facts factsOf(const Scene& scene, std::span<const Seen> views, const Quality& quality, const PlanOptions& options) {
  Facts facts;
  const Allowed allowed(options, quality);
  for (const Seen& view : views) {
    for (const scene::Batch& b : view.batches) addBatch(scene, view.instances[b.first], int(b.count), quality, allowed, facts);
    addGroups(scene, view, allowed, facts);
    addLights(scene, view.lights, facts);
    addProbes(scene, view.probes, facts);
    addGrid(scene, view.grid, facts);
    if (view.fogDepth > scene::kLeastFog || (options.wholeScene && scene.fog.density > 0)) facts.why[std::size_t(Call::Fog)] = "the scene's fog";
    addShadows(scene, view.shadows, facts);
    if (!view.moved.empty()) facts.call(Call::Moving, "instance", view.instances[view.moved.front().visible].instance->name, " moves", int(view.moved.size()));
  }
  addEnvironment(scene.environment, facts);
  if (const auto& sun = scene.environment.sun; sun && scene.environment.background)
    if (options.wholeScene || std::any_of(views.begin(), views.end(), [&](const Seen& v) { return sees(v.frame, *sun); })) facts.why[std::size_t(Call::SunDisc)] = "the environment's sun";
  return facts;
}

std::string_view Situation::lightFormat() const {
  if (options.output == Output::Linear && !options.displayLight) return "RGBA32F";
  switch (quality.lightBuffer) {
    case LightBuffer::R11G11B10: return "R11F_G11F_B10F";
    case LightBuffer::Rgba16F: break;
    case LightBuffer::Rgba32F: return "RGBA32F";
  }
  return "RGBA16F";
}

bool Situation::on(std::string_view effect) const {
  const auto found = std::find_if(effects.begin(), effects.end(), [&](const EffectPlan& e) { return e.name == effect; });
  return found != effects.end() && found->on;
}

// Of transparent ones alone the forward shading knows all that it needs; an effect that is forced has its target.
bool Situation::detailTarget() const {
  const bool called = (on("anisotropy") && facts.has(Call::Anisotropy)) || (on("rough_diffuse") && facts.has(Call::RoughDiffuse));
  return hasDepth() && !forward() && (on("anisotropy") || on("rough_diffuse")) && (facts.details || !called);
}

std::vector<bool> Situation::projections() const {
  std::vector<bool> result;
  for (bool o : {false, true})
    if (std::any_of(views.begin(), views.end(), [&](const Seen& v) { return v.frame.orthographic == o; })) result.push_back(o);
  return result;
}

LightingVariant Situation::lighting(bool orthographic) const {
  return {on("directional_lights") ? std::min(facts.directionalLights, MAX_DIRECTIONAL) : 0, on("environment_lighting"), on("baked_occlusion") || on("screen_occlusion"), orthographic, developsInPlace() ? int(quality.toneMap) : -1, on("fog"), on("local_lights"), {false, false}, shadows(), Places::None, grid()};
}

ShadowLighting Situation::shadows() const {
  if (!on("shadows") || shadowLayers() == 0) return {};
  ShadowLighting s;
  s.suns = on("directional_lights") ? facts.shadowSuns : 0;
  s.locals = on("local_lights") && !facts.localMaps.empty();
  s.rung = s.suns > 0 || s.locals ? quality.shadow : Shadow::None;
  return s;
}

int Situation::shadowLayers() const {
  const std::size_t suns = on("directional_lights") ? facts.sunMaps.size() : 0, locals = on("local_lights") ? facts.localMaps.size() : 0;
  return int(suns + locals);
}

LightingVariant Situation::drawnLighting(bool orthographic) const {
  LightingVariant variant = lighting(orthographic);
  variant.occlusion = on("baked_occlusion");
  variant.places = probes() ? Places::Many : Places::None;
  return variant;
}

}  // namespace burnish::plan
