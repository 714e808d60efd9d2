#include "plan/effects.h"

#include <fmt/format.h>

#include <algorithm>

#include "plan/rungs.h"
#include "plan/scaling.h"
#include "plan/temporal.h"

namespace burnish::plan {
namespace {

constexpr std::string_view kNotShown = "the debug view does not show it";

Verdict geometry(const Situation& s) { return sceneCalls(s, Call::Geometry, "no visible instance"); }
Verdict deformation(const Situation& s) { return sceneCalls(s, Call::Deformation, "an instance with a skin or morph weights would call for it"); }
Verdict twoSided(const Situation& s) { return sceneCalls(s, Call::TwoSided, "a two-sided material would call for it"); }
Verdict alphaTest(const Situation& s) { return sceneCalls(s, Call::AlphaTest, "a material with an alpha test would call for it"); }

Verdict anisotropy(const Situation& s) {
  const char* otherwise = s.quality.anisotropy == Anisotropy::None ? "the quality turns it off" : drawsBrushed(s.quality) ? "a material with anisotropy would call for it" : "the specular model has one width";
  return provided(sceneCalls(s, Call::Anisotropy, otherwise), s.final() || s.options.debugView == DebugView::Anisotropy, kNotShown);
}
Verdict roughDiffuse(const Situation& s) {
  const char* otherwise = s.quality.roughDiffuse == RoughDiffuse::None ? "the quality turns it off" : "a material with a diffuse roughness would call for it";
  return provided(sceneCalls(s, Call::RoughDiffuse, otherwise), s.final() || s.options.debugView == DebugView::DiffuseRoughness, kNotShown);
}

Verdict emissive(const Situation& s) { return provided(sceneCalls(s, Call::Emissive, "a material with emission would call for it"), s.final(), kNotShown); }

Verdict alphaBlend(const Situation& s) { return provided(sceneCalls(s, Call::AlphaBlend, "a blended material would call for it"), s.final(), kNotShown); }
Verdict glass(const Situation& s) { return provided(sceneCalls(s, Call::Glass, "a material with transmission would call for it"), s.final(), kNotShown); }

Verdict fog(const Situation& s) {
  const bool scene = s.scene.fog.density > 0;
  Verdict v = sceneCalls(s, Call::Fog, "fog in the scene would call for it");
  if (!v.on && scene) v.reason = "nothing in view is far enough for the scene's fog to take 1/1024 of its light";
  return provided(v, s.final(), kNotShown);
}

/// Suns and surroundings shine on surfaces and on fog.
bool anythingToLight(const Situation& s) { return s.hasDepth() || s.on("fog"); }
std::string_view notLit(const Situation& s) { return anythingToLight(s) ? kNotShown : "nothing to light"; }

Verdict countedLights(const Situation& s, Call call, int count, std::string_view otherwise) {
  Verdict v = sceneCalls(s, call, otherwise);
  if (v.on && count > 0) v.reason = fmt::format("{} of them, the first is {}", count, v.reason);
  return v;
}
Verdict directionalLights(const Situation& s) {
  return provided(countedLights(s, Call::Directional, s.facts.directionalLights, "a directional light would call for it"), s.final() && anythingToLight(s), notLit(s));
}
Verdict localLights(const Situation& s) {
  return provided(countedLights(s, Call::Local, s.facts.localLights, "a point or spot light would call for it"), (s.final() || s.viewsLights()) && s.hasDepth(), notLit(s));
}
Verdict shadows(const Situation& s) {
  Verdict v{false, s.quality.shadow == Shadow::None ? "shadow=none turns it off" : "a light that casts shadows would call for it"};
  const std::string otherwise = v.reason;
  for (const auto& [call, lights] : {std::pair(Call::LocalShadows, "local_lights"), std::pair(Call::SunShadows, "directional_lights")}) {
    const Verdict called = sceneCalls(s, call, otherwise);
    if (called.on && s.on(lights)) v = {true, fmt::format("{} map{}: {}", s.shadowLayers(), s.shadowLayers() == 1 ? "" : "s", called.reason), v.objects + called.objects};
    if (!called.on && !v.on && called.reason != otherwise) v = called;
  }
  return provided(v, s.final() && s.hasDepth(), notLit(s));
}
Verdict environmentLighting(const Situation& s) {
  const bool quality = s.quality.environmentSpecular != EnvironmentSpecular::None || s.quality.ambient != Ambient::None;
  const Verdict called = sceneCalls(s, Call::Environment, "an environment map or colour would call for it");
  return provided(provided(called, quality, "the quality turns it off"), s.final() && anythingToLight(s), notLit(s));
}
Verdict reflectionProbes(const Situation& s) {
  const bool quality = s.quality.environmentSpecular != EnvironmentSpecular::None || s.quality.ambient != Ambient::None;
  const auto& probes = s.scene.probes.reflections;
  const auto dark = std::find_if(probes.begin(), probes.end(), [](const ReflectionProbe& p) { return p.radiance.levels.empty(); });
  const std::string otherwise = dark == probes.end() ? "a reflection probe would call for it" : fmt::format("reflection probe '{}' is not baked", dark->name);
  return provided(provided(countedLights(s, Call::ReflectionProbe, s.facts.probes, otherwise), quality, "the quality turns it off"), s.final() && s.hasDepth(), notLit(s));
}
Verdict ambientGrid(const Situation& s) {
  const auto& grid = s.scene.probes.grid;
  const std::string otherwise = grid && grid->points.empty() ? "the ambient lattice is not baked" : "a baked ambient lattice would call for it";
  const bool ambient = s.quality.ambient != Ambient::None, source = s.quality.ambientSource == AmbientSource::Grid;
  const Verdict called = provided(sceneCalls(s, Call::AmbientGrid, otherwise), ambient, "the quality turns ambient light off");
  return provided(provided(called, source, "ambient-source=probes turns it off"), s.final() && s.hasDepth(), notLit(s));
}
Verdict background(const Situation& s) { return provided(sceneCalls(s, Call::Background, "an environment shown as background would call for it"), s.final(), kNotShown); }

/// Occlusion is taken from the light of the surroundings, and from that of lights where the quality says so.
constexpr std::string_view kHoldsNothingBack = "no light that it holds back: it takes from the surroundings'";
bool holdsBack(const Situation& s) {
  const bool lights = s.quality.directOcclusion != DirectOcclusion::None && (s.on("directional_lights") || s.on("local_lights"));
  return s.options.debugView == DebugView::Occlusion || s.on("environment_lighting") || s.on("reflection_probes") || s.on("ambient_grid") || lights;
}
Verdict bakedOcclusion(const Situation& s) {
  const Verdict called = sceneCalls(s, Call::BakedOcclusion, s.quality.occlusion == Occlusion::None ? "the quality turns it off" : "a material with an occlusion map would call for it");
  return provided(provided(called, s.final() || s.options.debugView == DebugView::Occlusion, kNotShown), holdsBack(s), kHoldsNothingBack);
}
Verdict sunDisc(const Situation& s) {
  if (s.scene.environment.sun && !s.scene.environment.background) return {false, "the environment is not shown as background"};
  const bool scene = s.scene.environment.sun.has_value();
  return provided({s.facts.has(Call::SunDisc), scene ? s.facts.has(Call::SunDisc) ? s.facts.why[std::size_t(Call::SunDisc)] : "out of view: the environment's sun" : "an environment with a sun would call for it"},
                  s.on("background"), "there is no background to show it in");
}

Verdict forwardReference(const Situation& s) {
  const std::string rung = forwardOnlyRung(s.quality);
  if (s.quality.path != Path::Forward && rung.empty()) return {false, "path=forward or a forward-only rung would call for it"};
  if (!s.final()) return {false, "the debug view shows the G-buffer"};
  if (!s.on("geometry")) return {false, "nothing to shade"};
  return {true, rung.empty() ? "path=forward" : rung + " needs what the G-buffer does not hold"};
}
Verdict screenOcclusion(const Situation& s) {
  const OcclusionSamples samples = occlusionSamples(s.quality.occlusion);
  if (samples.slices == 0) return {false, "occlusion=screen-4, screen-8 or screen-16 would call for it"};
  if (!s.on("geometry")) return {false, "nothing to shade"};
  if (s.forward()) return {false, "the forward reference path has no G-buffer to find it in"};
  if (s.options.debugView != DebugView::Occlusion && !s.final()) return {false, std::string(kNotShown)};
  if (!holdsBack(s)) return {false, std::string(kHoldsNothingBack)};
  return {true, fmt::format("occlusion=screen-{}", 2 * samples.slices * samples.steps)};
}
Verdict autoExposure(const Situation& s) {
  if (s.options.output == Output::Linear) return {false, "linear output is untouched by exposure"};
  if (s.quality.exposureEv) return {false, "the exposure is set"};
  if (s.options.debugView != DebugView::Final) return {false, "the debug view does not need it"};
  return {true, "no exposure is set"};
}
Verdict toneMapping(const Situation& s) {
  if (s.options.debugView != DebugView::Final) return {false, "the debug view does not need it"};
  if (s.options.output != Output::Display) return {false, "the output is linear"};
  return {true, fmt::format("tone map '{}'", toneMapNames()[std::size_t(s.quality.toneMap)])};
}
Verdict bloom(const Situation& s) {
  if (s.quality.bloom == Bloom::None) return {false, "bloom=scatter would call for it"};
  if (s.options.debugView != DebugView::Final) return {false, "the debug view does not need it"};
  if (s.options.output == Output::Linear) return {false, "linear output is what reaches the lens, not what the lens scatters"};
  return {true, "bloom=scatter"};
}
Verdict edgeAntialiasing(const Situation& s) {
  if (s.quality.antialiasing != Antialiasing::Edge) return {false, "antialiasing=edge would call for it"};
  if (s.options.debugView != DebugView::Final) return {false, "the debug view does not need it"};
  if (s.options.output == Output::Linear) return {false, "linear output has no display values to find edges in"};
  return {true, "antialiasing=edge"};
}
Verdict temporalAntialiasing(const Situation& s) {
  if (s.quality.antialiasing != Antialiasing::Temporal) return {false, "antialiasing=temporal would call for it"};
  if (s.options.debugView != DebugView::Final) return {false, "the debug view does not need it"};
  if (!keepsHistory(s.quality, s.options)) return {false, "the target brings depth, and what the host drew has no history"};
  return {true, "antialiasing=temporal"};
}
Verdict motionVectors(const Situation& s) {
  return provided(sceneCalls(s, Call::Moving, "an instance that moved since the frame before would call for it"), s.on("temporal_antialiasing"), "antialiasing=temporal would call for it where something moves");
}
Verdict upscaling(const Situation& s) {
  if (scaleOf(s.quality) >= 1) return {false, "resolutionScale below 1 would call for it"};
  if (s.options.debugView != DebugView::Final) return {false, "the debug view shows pixels as they are"};
  if (s.options.hostDepthIn) return {false, "the target brings depth, which has its size"};
  if (s.shaded == s.options.size) return {false, "the target has no pixel to spare"};
  return {true, fmt::format("{} x {} pixels for {} x {}", s.shaded.x, s.shaded.y, s.options.size.x, s.options.size.y)};
}
Verdict linearOutput(const Situation& s) {
  const bool on = s.options.output == Output::Linear && s.options.debugView == DebugView::Final;
  return {on, on ? "radiance is asked for" : "a request for linear output would call for it"};
}
Verdict debugView(const Situation& s) {
  if (s.options.debugView == DebugView::Final) return {false, "a debug view would call for it"};
  return {true, fmt::format("view '{}'", debugViewNames()[std::size_t(s.options.debugView)])};
}
Verdict asked(bool on, std::string_view yes, std::string_view no) { return {on, std::string(on ? yes : no)}; }
Verdict hostDepthIn(const Situation& s) { return asked(s.options.hostDepthIn, "the target brings depth", "a target that brings depth would call for it"); }
Verdict hostDepthOut(const Situation& s) { return asked(s.options.hostDepthOut, "the target takes depth", "a target that takes depth would call for it"); }
Verdict hostDraw(const Situation& s) { return asked(s.options.hostDraw && s.final(), "the host draws into the frame", "a draw callback would call for it"); }
Verdict nonfiniteCount(const Situation& s) { return asked(s.options.countNonfinite && s.final(), "asked for", "a request to count would call for it"); }

constexpr EffectRow kRows[] = {
    {{"geometry", CalledBy::Scene, "instances in the G-buffer"}, geometry, false},
    {{"deformation", CalledBy::Scene, "skins and morph targets"}, deformation, false},
    {{"two_sided", CalledBy::Scene, "surfaces seen from both sides"}, twoSided, false},
    {{"alpha_test", CalledBy::Scene, "holes where opacity is under the cutoff"}, alphaTest, false},
    {{"anisotropy", CalledBy::Scene, "brushed surfaces: highlights of two widths"}, anisotropy, false},
    {{"rough_diffuse", CalledBy::Scene, "surfaces with a diffuse roughness of their own"}, roughDiffuse, false},
    {{"emissive", CalledBy::Scene, "surfaces that emit"}, emissive},
    {{"alpha_blend", CalledBy::Scene, "surfaces drawn over what is behind them"}, alphaBlend},
    {{"glass", CalledBy::Scene, "surfaces that refract what is behind them"}, glass},
    {{"fog", CalledBy::Scene, "air that takes light and scatters it"}, fog, false},
    {{"directional_lights", CalledBy::Scene, "suns"}, directionalLights, false},
    {{"local_lights", CalledBy::Scene, "point and spot lights"}, localLights, false},
    {{"shadows", CalledBy::Scene, "what stands in a light keeps it from what is behind"}, shadows, false},
    {{"environment_lighting", CalledBy::Scene, "light of the surroundings"}, environmentLighting, false},
    {{"reflection_probes", CalledBy::Scene, "light of captured places"}, reflectionProbes, false},
    {{"ambient_grid", CalledBy::Scene, "ambient light of a lattice of points"}, ambientGrid, false},
    {{"background", CalledBy::Scene, "the surroundings where nothing was drawn"}, background, false},
    {{"baked_occlusion", CalledBy::Scene, "occlusion maps"}, bakedOcclusion, false},
    {{"sun_disc", CalledBy::Scene, "the sun itself in the background"}, sunDisc, false},
    {{"forward_reference", CalledBy::Setting, "surfaces shaded where they are drawn, unquantised"}, forwardReference},
    {{"screen_occlusion", CalledBy::Setting, "ambient occlusion found on the screen"}, screenOcclusion, false},
    {{"auto_exposure", CalledBy::Setting, "exposure metered from the picture"}, autoExposure},
    {{"bloom", CalledBy::Setting, "light that scatters in the lens"}, bloom},
    {{"tone_mapping", CalledBy::Setting, "radiance developed for a display"}, toneMapping, false},
    {{"edge_antialiasing", CalledBy::Setting, "edges smoothed in the developed picture"}, edgeAntialiasing},
    {{"temporal_antialiasing", CalledBy::Setting, "samples of each pixel averaged over frames"}, temporalAntialiasing},
    {{"motion_vectors", CalledBy::Scene, "where what moves was in the frame before"}, motionVectors, false},
    {{"upscaling", CalledBy::Setting, "pixels shaded at a smaller size and enlarged"}, upscaling},
    {{"linear_output", CalledBy::Setting, "radiance in cd/m2, not developed"}, linearOutput},
    {{"debug_view", CalledBy::Setting, "a buffer in place of the picture"}, debugView},
    {{"host_depth_in", CalledBy::Setting, "the host's depth occludes the scene"}, hostDepthIn},
    {{"host_depth_out", CalledBy::Setting, "the scene's depth for the host"}, hostDepthOut, false},
    {{"host_draw", CalledBy::Setting, "the host's own things in the frame"}, hostDraw},
    {{"nonfinite_count", CalledBy::Setting, "pixels that are not finite, counted"}, nonfiniteCount},
};

bool lists(const std::vector<std::string>& names, std::string_view name) { return std::find(names.begin(), names.end(), name) != names.end(); }

}  // namespace

std::span<const EffectRow> effectRows() { return kRows; }

Verdict sceneCalls(const Situation& s, Call call, std::string_view otherwise) {
  if (s.facts.has(call)) return {true, s.facts.why[std::size_t(call)], s.facts.objects[std::size_t(call)]};
  if (s.whole && s.whole->has(call)) return {false, "out of view: " + s.whole->why[std::size_t(call)]};
  return {false, std::string(otherwise)};
}

Verdict provided(Verdict verdict, bool wanted, std::string_view unwanted) {
  if (verdict.on && !wanted) return {false, std::string(unwanted)};
  return verdict;
}

void judgeEffects(Situation& s) {
  for (const EffectRow& row : kRows) {
    if (lists(s.options.removed, row.info.name)) continue;
    Verdict verdict = row.judge(s);
    if (!verdict.on && row.info.calledBy == CalledBy::Scene && lists(s.options.forced, row.info.name)) verdict = {true, "forced on: " + verdict.reason};
    EffectPlan& effect = s.effects.emplace_back();
    effect.name = row.info.name;
    effect.on = verdict.on;
    effect.calledBy = row.info.calledBy;
    effect.reason = std::move(verdict.reason);
    effect.objects = verdict.objects;
  }
}

// Only where lighting and background fill the view between them, so that nobody else writes a pixel.
bool Situation::developsInPlace() const {
  if (!on("tone_mapping") || !on("geometry") || !lit() || !fillsBackground()) return false;
  return std::none_of(std::begin(kRows), std::end(kRows), [&](const EffectRow& row) { return row.needsLightBuffer && on(row.info.name); });
}

}  // namespace burnish::plan

namespace burnish {

std::span<const EffectInfo> effectList() {
  static const std::vector<EffectInfo> list = [] {
    std::vector<EffectInfo> infos;
    for (const plan::EffectRow& row : plan::effectRows()) infos.push_back(row.info);
    return infos;
  }();
  return list;
}

}  // namespace burnish
