// Which variant of the geometry programs an instance needs: data, shared by the plan (which lists them) and the passes (which use them).
#pragma once
#include <burnish/plan.h>

namespace burnish::plan {

struct GeometryVariant {
  bool general = false;    ///< second uv set, uv transforms, vertex colour or metal-rough kept apart
  bool alphaTest = false;
  bool occlusionMap = false;
  bool packed = false;     ///< with occlusionMap: it rides in map B's third channel (gpu_scene), so that two lookups do
  friend auto operator<=>(const GeometryVariant&, const GeometryVariant&) = default;
};
GeometryVariant variantOf(const Material& material, const Mesh& mesh);
/// Occlusion that can ride in map B: the same uv mapping as B's, and nothing else is read from map C.
bool packsOcclusion(const Material& material);
/// Emission of any kind, unlit included.
bool emits(const Material& material);

/// The passes that draw geometry.
enum class GeometryPass : std::uint8_t { GBuffer, Emissive, Pick };
/// occlusionTarget: the frame has a third target.
ProgramPlan geometryProgram(GeometryPass pass, GeometryVariant variant, bool occlusionTarget);

/// Sizes of the unrolled lighting programs (10 lights, rays and irradiance fill 30 of 32 varyings): a tile's list is padded to the next one; longer lists are looped over.
inline constexpr int kTileBuckets[] = {0, 1, 2, 3, 4, 6, 8, 10};
inline constexpr int kLoop = -1;       ///< the program that loops over long lists of point lights
inline constexpr int kLoopSpots = -2;  ///< the program that loops over lists with spots among them
/// `directional` lights, `environment`: the surroundings light the scene.
ProgramPlan lightingProgram(int bucket, const Quality& quality, int directional, bool environment, bool occlusion, bool orthographic);

}  // namespace burnish::plan
