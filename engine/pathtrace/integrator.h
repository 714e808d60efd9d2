// Paths from the eye: what light arrives along a camera's ray. Surroundings and emissive surfaces are met by chance and sampled, weighed against each other (multiple importance sampling,
// power heuristic: Veach 1997, section 9.2); punctual lights are sampled alone. Light crosses clear panes and blended surfaces straight; rough panes and bodies of glass turn it, and what lies
// behind those is met by chance alone, but for punctual lights, which shine straight through (World::transmittance).
#pragma once
#include <glm/glm.hpp>

#include "pathtrace/bsdf.h"
#include "pathtrace/lights.h"
#include "pathtrace/lights_glow.h"
#include "pathtrace/world.h"

namespace burnish::pathtrace {

/// Which halves of the sampling count; Both is the usual. The others take one technique for all, at more noise: tests hold them against each other.
enum class Technique : std::uint8_t { Both, Lights, Surfaces };

class Integrator {
 public:
  /// bounces: as ReferenceOptions (crossing glass or a blended surface is none); below 0: no limit. The world outlives the integrator.
  Integrator(const World& world, int bounces, Technique technique = Technique::Both);

  /// Radiance along a camera's ray (or any other), cd/m², fog and background included; finite. direct: what of it arrives without a bounce, the light of what is seen included. Threads may ask
  /// at once, each with its own sampler.
  [[nodiscard]] glm::dvec3 radiance(const PathRay& ray, Sampler& sampler, glm::dvec3& direct, Features& features) const;

 private:
  struct Path;
  [[nodiscard]] bool meet(Path& path) const;
  void meetSky(Path& path) const;
  void receiveEmission(Path& path, const SurfacePoint& point) const;
  void travel(Path& path, const SurfacePoint& point) const;
  [[nodiscard]] bool goStraight(Path& path, const SurfacePoint& point, const glm::vec3& toRay, float reflects) const;
  [[nodiscard]] bool cross(Path& path, const SurfacePoint& point, const Bsdf& bsdf) const;
  [[nodiscard]] bool bounce(Path& path, const SurfacePoint& point, const Bsdf& bsdf) const;
  [[nodiscard]] bool looksForGlows(const Path& path, const Bsdf& bsdf) const;
  [[nodiscard]] bool survives(Path& path) const;

  [[nodiscard]] glm::vec3 lit(const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler, bool first) const;
  [[nodiscard]] glm::vec3 litByLight(const SurfacePoint& point, const Bsdf& bsdf, const PunctualLight& light, const Received& received, Sampler& sampler) const;
  [[nodiscard]] glm::vec3 litByEmitter(const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler, int looks) const;
  [[nodiscard]] glm::vec3 fromEmitter(const SurfacePoint& point, const Bsdf& bsdf, const EmitterSample& light) const;
  [[nodiscard]] glm::vec3 litBySky(const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler) const;
  [[nodiscard]] float weight(float own, float other, bool surface) const;

  const World* world_;
  LobeTable table_;
  LightPicker lights_;
  Glows glows_;
  int bounces_;
  Technique technique_;
  float held_;  ///< alpha of lobes after a wide bounce, at least
};

}  // namespace burnish::pathtrace
