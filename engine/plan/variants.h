// Which variant of the geometry programs an instance needs: data, shared by the plan (which lists them) and the passes (which use them).
#pragma once
#include <burnish/plan.h>

namespace burnish::plan {

struct GeometryVariant {
  bool general = false;    ///< second uv set, uv transforms, vertex colour or metal-rough kept apart
  bool alphaTest = false;
  bool occlusionMap = false;
  bool instanced = false;  ///< many at once: DrawData comes as vertex attributes
  bool packed = false;     ///< its occlusion map rides in map B's third channel (gpu_scene), read or not, so that two lookups do: the normal's z follows from x and y
  bool brushed = false;    ///< anisotropy: two widths along the tangents
  bool rough = false;      ///< a diffuse roughness of its own
  /// It writes the G-buffer's fourth target (shaders/shading/detail.h).
  [[nodiscard]] bool detail() const { return brushed || rough; }
  [[nodiscard]] GeometryVariant withoutOcclusion() const {
    GeometryVariant v = *this;
    v.occlusionMap = v.packed = false;
    return v;
  }
  /// Without what only shading and the G-buffer ask for.
  [[nodiscard]] GeometryVariant shapeOnly() const {
    GeometryVariant v = withoutOcclusion();
    v.brushed = v.rough = false;
    return v;
  }
  friend auto operator<=>(const GeometryVariant&, const GeometryVariant&) = default;
};
/// What a frame draws of the details that surfaces can have.
struct Details {
  bool brushed = true, rough = true;
};
GeometryVariant variantOf(const Material& material, const Mesh& mesh, Details details);
/// Of a frame with that plan.
Details detailsOf(const FramePlan& plan);
/// Occlusion that can ride in map B: the same uv mapping as B's, and nothing else is read from map C.
bool packsOcclusion(const Material& material);
/// Emission of any kind, unlit included.
bool emits(const Material& material);

/// The geometry passes read the mesh's tangents, or make them.
bool wantsTangents(const Material& material);

/// What a deformed instance's program does (shaders/deform).
struct DeformVariant {
  bool skin = false, morph = false;
  friend auto operator<=>(const DeformVariant&, const DeformVariant&) = default;
};
ProgramPlan deformProgram(DeformVariant variant);
/// How a transparent surface shows what is behind it.
enum class Through : std::uint8_t { Blend, Clear, Refract };  ///< by opacity alone; a thin pane that tints; by a copy of the picture, shifted or blurred
struct TransparentVariant {
  GeometryVariant geometry;
  Through through = Through::Blend;
  bool coverage = false;  ///< map C or the vertex colours say how much of a pixel it covers
  bool emits = false;
  bool faint = false;     ///< glass whose index is under water's, and which has a diffuse share
  friend auto operator<=>(const TransparentVariant&, const TransparentVariant&) = default;
};
/// Whether a surface is drawn by the pass "transparent". `blend`, `glass`: whether those effects are on.
bool drawnTransparent(const Material& material, bool blend, bool glass);
TransparentVariant transparentVariantOf(const Material& material, const Mesh& mesh, bool occlusion, Details details);

/// A shadow caster's program: where it has holes it looks its opacity up.
struct ShadowVariant {
  bool alphaTest = false, general = false;
  friend auto operator<=>(const ShadowVariant&, const ShadowVariant&) = default;
};
ShadowVariant shadowVariantOf(const Material& material, const Mesh& mesh);
ProgramPlan shadowProgram(ShadowVariant variant);

/// The passes that draw geometry.
enum class GeometryPass : std::uint8_t { GBuffer, Emissive, Pick, Forward };
/// occlusionTarget: the frame has a third target. specularAntialiasing: of what the G-buffer takes. Not for Emissive and Forward, which emissiveProgram and forwardProgram make.
ProgramPlan geometryProgram(GeometryPass pass, GeometryVariant variant, bool occlusionTarget, SpecularAntialiasing specularAntialiasing = SpecularAntialiasing::None);

/// How the screen-space rungs of occlusion sample: slices, each a half turn around the direction to the eye, and samples to either side of it. No slices: the rung is another.
struct OcclusionSamples {
  int slices = 0, steps = 0;
};
OcclusionSamples occlusionSamples(Occlusion rung);

/// The shadows that lighting looks up.
struct ShadowLighting {
  Shadow rung = Shadow::None;
  int suns = 0;         ///< directional lights that have them: the first ones
  bool locals = false;  ///< some point and spot lights have them
};
/// How many captured places may light what a program draws. A software renderer pays for a loop: one place has none.
enum class Places : std::uint8_t { None, One, Many };
inline constexpr Places kPlaces[] = {Places::None, Places::One, Places::Many};
inline Places placesOf(int count) { return count == 0 ? Places::None : count == 1 ? Places::One : Places::Many; }

/// What the lighting programs of a frame have in common.
struct LightingVariant {
  int directional = 0;        ///< directional lights
  bool environment = false;   ///< the surroundings light the scene
  bool occlusion = false;     ///< ambient occlusion is there, baked or of the screen
  bool orthographic = false;
  int inPlace = -1;           ///< tone map (ToneMap's number) of what is written straight into the target; -1: radiance is written
  bool fog = false;           ///< lies before what is lit
  bool local = false;         ///< point and spot lights, in programs that are no tile's
  Details details{false, false};  ///< of what the program's tiles may show
  [[nodiscard]] bool detail() const { return details.brushed || details.rough; }
  ShadowLighting shadows{};
  Places places = Places::None;  ///< that may light what the program draws
  bool grid = false;             ///< an ambient lattice lights the scene
  [[nodiscard]] bool surroundings() const { return environment || places != Places::None || grid; }
};
/// Fog is there and lit by the surroundings.
bool fogAmbient(const Quality& quality, const LightingVariant& lighting);
/// What emits, through the fog if there is any.
ProgramPlan emissiveProgram(GeometryVariant variant, const Quality& quality, const LightingVariant& lighting);
/// The lobe's table (prefilter/dfg.h) is read. reflections: the sky or captured places light the scene; ambient: a lattice does.
bool needsDfg(const Quality& quality, bool reflections, bool ambient);
/// The prefiltered cube, of the sky or of captured places, is read where that lights the scene.
bool needsCube(const Quality& quality, bool lights);

/// Sizes of the unrolled lighting programs (10 lights, rays and irradiance fill 30 of 32 varyings): a tile's list is padded to the next one; longer lists are looped over.
inline constexpr int kTileBuckets[] = {0, 1, 2, 3, 4, 6, 8, 10};
inline constexpr int kLoop = -1;       ///< the program that loops over long lists of point lights
inline constexpr int kLoopSpots = -2;  ///< the program that loops over lists with spots among them
inline constexpr int kLoopShadows = -3;  ///< and over lists with lights among them that cast shadows
/// Tiles that may show brushed or rough surfaces have programs of their own; what is unrolled is the empty list alone, for they are few.
inline constexpr int kDetailBuckets[] = {0, kLoop, kLoopSpots, kLoopShadows};
inline constexpr Details kDetailClasses[] = {{true, false}, {false, true}, {true, true}};
ProgramPlan lightingProgram(int bucket, const Quality& quality, const LightingVariant& lighting);
/// A transparent surface's program, and the one that finds its depth when layers are peeled.
ProgramPlan transparentProgram(const TransparentVariant& variant, const Quality& quality, const LightingVariant& lighting);
ProgramPlan peelProgram(const TransparentVariant& variant);
/// The forward reference path's program of a geometry variant.
ProgramPlan forwardProgram(GeometryVariant variant, const Quality& quality, const LightingVariant& lighting);

}  // namespace burnish::plan
