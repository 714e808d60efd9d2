// The scene's triangles for rays, and what shading wants to know at a place on one of them.
#pragma once
#include <burnish/scene.h>

#include <memory>
#include <vector>

#include "pathtrace/textures.h"
#include "reference/rays.h"
#include "scene/material_factors.h"
#include "scene/visibility.h"

namespace burnish::pathtrace {

/// Bits of rays' masks.
enum Look : std::uint32_t {
  kSolid = 1,      ///< opaque
  kHoles = 2,      ///< alpha-tested
  kThin = 4,       ///< blended, or a pane of glass
  kBody = 8,       ///< glass with thickness
  kCasters = 16,   ///< times the bits above: it keeps the light of punctual lights off (Instance::castsShadow)
};

/// A material with its maps.
struct MaterialInputs {
  scene::MaterialFactors factors;
  const MapSampler* maps[5] = {};  ///< A, B, C, metal-rough, emissive
  bool packed = false, alphaTest = false, twoSided = false, glass = false, emits = false;
  bool emissiveMap = false;
};

/// One instance's triangles, in the order of the ray scene's meshes.
struct Part {
  std::uint32_t instance = 0;
  std::uint32_t material = 0;              ///< index into Geometry::materials
  Look look = kSolid;
  bool flipped = false;
  bool open = false;                       ///< a body whose mesh has edges with one triangle
  std::shared_ptr<const Mesh> mesh;        ///< prepared: texture coordinates and colours
  std::vector<std::uint32_t> turned;       ///< indices of a mirrored instance, so that triangles turn as they are seen; empty: the mesh's
  std::vector<glm::vec3> positions;        ///< from Geometry::middle, world axes
  std::vector<glm::vec3> normals;          ///< world, unit or zero
  std::vector<glm::vec4> tangents;
  glm::mat3 model{1};                      ///< directions of the mesh's space to the world, for thicknesses
  [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return turned.empty() ? mesh->indices : turned; }
  [[nodiscard]] std::size_t triangles() const { return indices().size() / 3; }
};

struct Geometry {
  reference::RayScene rays;
  std::vector<Part> parts;
  std::vector<MaterialInputs> materials;   ///< the last one is the default material
  Maps maps;
  glm::dvec3 middle{0};
  bool holes = false, thin = false, bodies = false;  ///< the scene has such surfaces

  /// Errors: too many triangles, memory runs out. Meshes that cannot be drawn are left out with a warning.
  static Result<Geometry> create(const Scene& scene, const scene::Derived& derived, Report& report);
  [[nodiscard]] glm::dvec3 corner(const Part& part, std::size_t triangle, int c) const { return middle + glm::dvec3(part.positions[part.indices()[triangle * 3 + std::size_t(c)]]); }
};

/// What is interpolated over a triangle.
struct Corners {
  glm::vec2 uv[2]{};          ///< sets 0 and 1
  Footprint footprint[2]{};   ///< of them
  glm::vec4 color{1};
};
Corners cornersAt(const Part& part, std::size_t triangle, const glm::vec2& barycentric);

/// Texture coordinates of a slot, and how far they move over a pixel.
struct MapPlace {
  glm::vec2 uv{0};
  Footprint footprint;
};
MapPlace placeOf(const MaterialInputs& material, int slot, const Corners& corners);
inline glm::vec4 lookUp(const MaterialInputs& material, int slot, const Corners& corners) {
  const MapPlace p = placeOf(material, slot, corners);
  return material.maps[slot]->at(p.uv, p.footprint);
}
/// gbuffer/fetch.glsl's alpha test: there is a surface here.
bool solidAt(const MaterialInputs& material, const Corners& corners);
/// Share of light that meets a blended surface at all; 1 of others.
float coverageAt(const MaterialInputs& material, const Corners& corners);
/// What it emits toward whoever sees its front, unlit colour included (gbuffer/emissive.frag).
glm::vec3 emissionAt(const MaterialInputs& material, const Corners& corners);

}  // namespace burnish::pathtrace
