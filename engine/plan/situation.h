// What one frame is about: the scene as its views see it, the settings, the machine. Effects judge it (effects.h), passes are planned from it (builder.h).
#pragma once
#include <burnish/plan.h>

#include <array>
#include <set>

#include "plan/variants.h"
#include "scene/grid.h"
#include "scene/probes.h"
#include "scene/shadows.h"
#include "scene/motion.h"
#include "scene/transparency.h"

namespace burnish::plan {

/// One view and what it sees.
struct Seen {
  scene::ViewFrame frame;
  std::vector<scene::VisibleInstance> instances;  ///< nearest first, batches brought together
  std::vector<scene::Batch> batches;              ///< of `instances`
  scene::LightSet lights;
  scene::ShadowSet shadows;                          ///< of the first of `lights`
  std::vector<scene::TransparentGroup> transparent;  ///< farthest first; indices into instances
  std::vector<scene::SeenProbe> probes;              ///< smaller boxes before larger ones
  bool grid = false;                                 ///< the scene's ambient lattice can light something in view
  double fogDepth = 0;                               ///< no more than so much fog lies before anything in view (optical depth)
  std::vector<scene::Moved> moved;                   ///< since the frame before; filled in by whoever remembers it
};
/// What a view sees. `shaded`: the size at which pixels are shaded (none: the target's). `lights` is filled too; what is mended goes into the report.
void look(const Scene& scene, const scene::Derived& derived, const View& view, glm::ivec2 targetSize, const Quality& quality, Report& report, Seen& out, glm::dvec2 jitter = {0, 0}, glm::ivec2 shaded = {0, 0});
/// As if everything were in view (PlanOptions::wholeScene).
void lookEverywhere(const Scene& scene, const scene::Derived& derived, const View& view, glm::ivec2 targetSize, const Quality& quality, Report& report, Seen& out, glm::ivec2 shaded = {0, 0});

/// What a scene holds that effects are called by.
enum class Call : std::uint8_t { Geometry, Deformation, TwoSided, AlphaTest, BakedOcclusion, Anisotropy, RoughDiffuse, Emissive, Directional, Local, Environment, Background, AlphaBlend, Glass, Fog, SunDisc, SunShadows, LocalShadows, Moving, ReflectionProbe, AmbientGrid, Count };
struct Facts {
  std::array<std::string, std::size_t(Call::Count)> why;  ///< the first thing that calls; empty: nothing does
  std::array<int, std::size_t(Call::Count)> objects{};    ///< how many call, instances or lights, counted once a view
  int directionalLights = 0, localLights = 0;              ///< of the view that has most
  int probes = 0;                                          ///< reflection probes, likewise
  bool spots = false;
  int shadowSuns = 0;                            ///< directional lights with shadows, of the view that has most
  std::set<std::uint64_t> sunMaps, localMaps;    ///< shadow maps of all views: their contents
  std::set<ShadowVariant> shadowVariants;        ///< of casters
  std::set<DeformVariant> shadowDeformVariants;  ///< of casters
  std::set<DeformVariant> deformVariants;
  std::set<GeometryVariant> variants, emissiveVariants;  ///< of opaque surfaces
  std::set<TransparentVariant> blended, glass;
  bool details = false;  ///< opaque surfaces among those that are brushed or rough
  bool peels = false;    ///< some transparent surfaces are in no order that holds for the whole picture
  bool refracts = false, blurs = false;  ///< glass that reads the picture behind it; from its mip levels too

  [[nodiscard]] bool has(Call call) const { return !why[std::size_t(call)].empty(); }
  /// Counts `count` callers and keeps the first: a thing of that kind and name, and why it calls.
  void call(Call call, std::string_view kind, const std::string& name, std::string_view because, int count = 1);
};
/// `options`: transparent surfaces are opaque ones where their effect is taken off the list or the debug view shows none.
Facts factsOf(const Scene& scene, std::span<const Seen> views, const Quality& quality, const PlanOptions& options);

struct Situation {
  const Scene& scene;
  std::span<const Seen> views;
  const Quality& quality;
  const Capabilities& caps;
  const PlanOptions& options;
  glm::ivec2 shaded{0};           ///< size of what is shaded, pixels (plan/scaling.h)
  Facts facts;                    ///< of what is in view
  const Facts* whole = nullptr;   ///< of the whole scene, for the reasons of what is off; may be absent
  std::vector<EffectPlan> effects;  ///< judged so far

  [[nodiscard]] bool on(std::string_view effect) const;
  /// The frame ends in a picture of light, not in a view of a buffer.
  [[nodiscard]] bool final() const { return options.debugView == DebugView::Final || options.debugView == DebugView::Nonfinite; }
  [[nodiscard]] bool viewsLights() const { return options.debugView == DebugView::Lights; }
  /// There is a depth buffer: instances or the host's depth are in it.
  [[nodiscard]] bool hasDepth() const { return on("geometry") || options.hostDepthIn; }
  [[nodiscard]] bool lit() const { return on("directional_lights") || on("local_lights") || on("environment_lighting") || on("reflection_probes") || on("ambient_grid"); }
  /// Lighting looks captured places up.
  [[nodiscard]] bool probes() const { return on("reflection_probes") && facts.probes > 0; }
  /// And the ambient lattice (which may be forced on where there is none).
  [[nodiscard]] bool grid() const { return on("ambient_grid") && facts.has(Call::AmbientGrid); }
  /// Lighting writes what the display takes straight into the target: no effect needs the light buffer. Asked once all effects are judged.
  [[nodiscard]] bool developsInPlace() const;
  /// Of the light buffer. A picture for a display is pre-exposed, so that half floats suffice; linear output keeps radiance in floats.
  [[nodiscard]] std::string_view lightFormat() const;
  /// Fog is lit by suns or surroundings, so that it shows before an empty background too.
  [[nodiscard]] bool fogShines() const { return on("fog") && (on("directional_lights") || on("environment_lighting")); }
  /// What nothing was drawn over is filled: with the surroundings, or with fog.
  [[nodiscard]] bool fillsBackground() const { return on("background") || fogShines(); }
  [[nodiscard]] bool forward() const { return on("forward_reference"); }
  /// The view is cut into tiles that say which lights reach them and which show the background.
  [[nodiscard]] bool hasTiles() const { return hasDepth() && !forward() && ((lit() && final()) || viewsLights() || on("screen_occlusion")); }
  [[nodiscard]] bool reducesDepth() const { return options.tileBounds == TileBounds::Reduction || (options.tileBounds == TileBounds::Automatic && !caps.software); }
  /// The projections that views have: perspective (false), orthographic (true).
  [[nodiscard]] std::vector<bool> projections() const;
  /// Of a tile that no captured place lights.
  [[nodiscard]] LightingVariant lighting(bool orthographic) const;
  /// The G-buffer has its target for brushed and rough surfaces.
  [[nodiscard]] bool detailTarget() const;
  [[nodiscard]] Details details() const { return {on("anisotropy"), on("rough_diffuse")}; }
  /// Of surfaces that are shaded where they are drawn: occlusion found on the screen is none of theirs.
  [[nodiscard]] LightingVariant drawnLighting(bool orthographic) const;
  [[nodiscard]] ShadowLighting shadows() const;
  /// Layers of the shadow maps.
  [[nodiscard]] int shadowLayers() const;
};

}  // namespace burnish::plan
