// The scene as paths meet it: surfaces with their materials, lights, emissive triangles, surroundings, camera and fog. Built once, then read by any number of threads.
// Places are metres in world space, in double; directions, colours and densities are float. Radiance is cd/m².
// Who is what (docs/reference.md has the reasons):
// - rays of the camera pass the backs of one-sided surfaces, as rasterization does; all others meet both sides, and a one-sided surface's back reflects as its front does;
// - alpha-tested surfaces have their holes for every ray; where a texture is read the camera's rays take the mip level of their footprint, all others level 0;
// - clear panes and blended surfaces let light through without turning it: shadow rays pass them (transmittance), and so does the path itself (crossing, past): the same straight way, to be
//   weighed as one technique. Bodies of glass (thickness above 0) turn it: see Bodies.
#pragma once
#include <burnish/measure.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "pathtrace/sampler.h"
#include "reference/shading.h"

namespace burnish::pathtrace {

/// From `from` metres on, without end.
struct PathRay {
  glm::dvec3 origin{0}, direction{0, 0, -1};  ///< direction: unit
  double from = 0;                            ///< metres
  bool camera = false;                        ///< it leads straight from the eye: backs of one-sided surfaces are passed, textures are filtered over the pixel
  glm::dvec3 acrossX{0}, acrossY{0};          ///< camera: from this pixel's ray to the next one's, right and up: of a direction whose depth is 1 (perspective), of the origin (orthographic)
};

enum class Passage : std::uint8_t {
  Opaque,
  Blend,  ///< the pigment lets a share through, straight
  Pane,   ///< clear glass without thickness: it tints, straight
  Frosted,  ///< a rough pane (alpha above 0.001): it tints and scatters; to shadow rays it is a body
  Body,   ///< glass with thickness: it refracts
};

/// A surface on a ray. Materials are as shaders/gbuffer/fetch.glsl has them, unquantised.
struct SurfacePoint {
  glm::dvec3 position{0};
  double distance = 0;            ///< from the ray's origin
  glm::vec3 geometric{0, 0, 1};   ///< the triangle's normal, unit, on the side that the ray comes from
  glm::vec3 normal{0, 0, 1};      ///< interpolated and mapped, unit; turned with the frame on backs. It may look away from the ray's origin: makeSurface bends it back
  bool back = false;              ///< the ray comes from behind the triangle
  bool twoSided = false;

  glm::vec3 albedo{0};            ///< [0, 1]
  float substance = 1.0f / 3;     ///< code, [0, 1]
  float alpha = 1;                ///< of the lobe; across the tangent where it is brushed
  glm::vec3 eta{0}, k{0};         ///< of a named conductor
  bool brushed = false;           ///< it has two widths
  glm::vec3 tangent{0};           ///< brushed: along which it is wide; any length, zero where it has none
  float alphaX = 1;               ///< brushed: alpha along it
  float sigma = 0;                ///< rough diffuse, radians
  bool unlit = false;             ///< it shows `emission` and reflects nothing

  glm::vec3 emission{0};          ///< toward the ray's origin; that of unlit surfaces included
  std::int32_t emitter = -1;      ///< of World::emitterDensity; -1: sampleEmitter never gives this point

  Passage passage = Passage::Opaque;
  float coverage = 1;             ///< share of the light on this ray that meets the surface at all; the rest goes on straight (blended surfaces, and glass that is blended)
  float pigment = 1;              ///< Blend: share of what enters that the pigment takes, Material::opacity
  float transmission = 0;         ///< Pane, Body: share of the diffuse albedo's light that crosses
  float thickness = 0;            ///< Body: metres along the normal, the instance's scale included
  float ior = 0;                  ///< Pane, Body: index inside, at least 1; it gives F0 too; 0: of the substance's F0
  glm::vec3 absorption{0};        ///< Body: 1/m
  bool open = false;              ///< Body: its mesh has edges with one triangle: it stands for a slab that thick, which light leaves as it came

  std::uint32_t instance = 0;     ///< index into the scene's table
};

/// A point, spot or directional light, stand-ins left out. Without a range it has no end (Quality::lightThreshold is the renderer's alone).
struct PunctualLight {
  bool directional = false;
  glm::dvec3 position{0};
  glm::vec3 toLight{0, 1, 0};    ///< directional: unit
  glm::vec3 power{0};            ///< lux, or candela
  float invRange4 = 0;           ///< of distanceAttenuation in shading/light.h, whose bias is 0
  bool spot = false;
  glm::vec3 axis{0, -1, 0};      ///< spot: unit, along which it shines
  float spotScale = 0, spotOffset = 1;  ///< spot: of spotAttenuation
  float radius = 0;              ///< metres: the ball from which shadow rays come; light arrives as from its middle
  float angularDiameter = 0;     ///< directional: radians, likewise
  bool castsShadow = false;      ///< false: nothing keeps its light off
};

/// A point on an emissive triangle.
struct EmitterSample {
  glm::dvec3 position{0};
  glm::vec3 normal{0, 0, 1};     ///< of the triangle, unit, on the side of the point that asked
  glm::vec3 radiance{0};         ///< toward that point
  float density = 0;             ///< 1/m² of its surface
};

struct EnvironmentSample {
  glm::vec3 direction{0, 1, 0};  ///< unit, away from the surface
  glm::vec3 radiance{0};
  float density = 0;             ///< 1/sr
};

/// What shadow rays make of bodies of glass. Straight: they pass them, tinted and absorbed but not turned (for punctual lights, which no path can meet by chance). Block: they are opaque
/// (for emitters and surroundings: paths that the glass turns meet those by themselves and count in full).
enum class Bodies : std::uint8_t { Straight, Block };

struct FogShare {
  float through = 1;             ///< of what is at that distance
  glm::vec3 source{0};           ///< radiance of endless fog; a stretch shows source times the `through` at its start less that at its end
};

/// Of the first surface that the camera's ray meets (through blended ones in part): what denoisers want. Zero where there is none.
struct Features {
  glm::vec3 albedo{0};           ///< diffuse albedo + F0, 0..1
  glm::vec3 normal{0};           ///< world
};

class World {
 public:
  /// Copies what it needs of the scene. `size`: pixels of the picture; view.viewport does not count. quality: its rungs say what the surfaces that light crosses reflect.
  /// Errors: too many triangles, memory runs out, an environment that is no float picture. Textures that cannot be used are left out with a warning, as the renderer does.
  static Result<World> create(const Scene& scene, const View& view, const Quality& quality, glm::ivec2 size, Report& report);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  /// The rungs of the lighting equation; anisotropic and roughDiffuse are 1 where quality asks for them.
  [[nodiscard]] const shading::Rungs& rungs() const;

  // ---- Camera
  /// Through a place on the picture, in pixels from its upper left corner: (0.5, 0.5) is the middle of the first pixel.
  [[nodiscard]] PathRay cameraRay(glm::dvec2 pixel) const;
  /// What the camera sees where its ray meets nothing: background and sun disc, or black. Fog not included.
  [[nodiscard]] glm::vec3 background(const PathRay& ray) const;
  [[nodiscard]] bool foggy() const;
  /// Between the eye and `distance` metres along a camera's ray; infinite: to the background.
  [[nodiscard]] FogShare fog(const PathRay& ray, double distance) const;

  // ---- Surfaces
  /// The nearest surface; false: there is none. Holes of alpha-tested surfaces are passed; blended surfaces and glass are met.
  [[nodiscard]] bool nearest(const PathRay& ray, SurfacePoint& point) const;
  /// A ray from a point into a unit direction, on whichever side of the triangle that leads: it does not meet the triangle again.
  [[nodiscard]] PathRay leave(const SurfacePoint& point, const glm::vec3& direction) const;
  /// The same ray, going on behind a point on it (through a blended surface or a pane).
  [[nodiscard]] PathRay past(const PathRay& ray, const SurfacePoint& point) const;
  /// What crosses a blended surface or a pane toward the ray's origin, of what comes straight from behind, its coverage included: (1 - coverage) + coverage · through. toRay: unit. Of a body:
  /// as a pane, without absorption. 0 of opaque surfaces.
  [[nodiscard]] glm::vec3 crossing(const SurfacePoint& point, const glm::vec3& toRay) const;
  /// Share of light that goes straight from `to` to a point: 0 where something opaque that casts shadows stands between; what blended surfaces and panes let through.
  [[nodiscard]] glm::vec3 transmittance(const SurfacePoint& from, const glm::dvec3& to, Bodies bodies) const;
  /// The same into a direction without end. direction: unit.
  [[nodiscard]] glm::vec3 transmittanceAlong(const SurfacePoint& from, const glm::vec3& direction, Bodies bodies) const;

  // ---- Light
  [[nodiscard]] std::span<const PunctualLight> lights() const;

  [[nodiscard]] bool hasEmitters() const;
  /// A point on an emissive triangle, by power; one-sided ones emit to their front. false: it gives no light toward `at`. pick in [0, 1), place in [0, 1)².
  [[nodiscard]] bool sampleEmitter(const glm::dvec3& at, float pick, const glm::vec2& place, EmitterSample& sample) const;
  /// Density (1/m²) with which sampleEmitter gives a point that a ray met; 0 with emitter -1.
  [[nodiscard]] float emitterDensity(std::int32_t emitter) const;

  [[nodiscard]] bool hasEnvironment() const;
  /// Radiance that arrives from a direction (unit, away from the surface): what lights the scene, the sun's disc left out.
  [[nodiscard]] glm::vec3 environment(const glm::vec3& direction) const;
  /// By luminance times solid angle. place in [0, 1)².
  [[nodiscard]] EnvironmentSample sampleEnvironment(const glm::vec2& place) const;
  [[nodiscard]] float environmentDensity(const glm::vec3& direction) const;

 private:
  struct Parts;
  explicit World(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

// The integrator (integrator.h): radiance along a camera's ray, fog and background included. direct: what of it arrives without a bounce. bounces: as ReferenceOptions.
//   glm::dvec3 radiance(const World&, const shading::Rungs&, const PathRay&, Sampler&, int bounces, glm::dvec3& direct, Features&);

}  // namespace burnish::pathtrace
