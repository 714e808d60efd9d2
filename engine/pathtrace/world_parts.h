// What a World is made of.
#pragma once
#include "pathtrace/camera.h"
#include "pathtrace/emitters.h"
#include "pathtrace/geometry.h"
#include "pathtrace/world.h"

namespace burnish::pathtrace {

struct World::Parts {
  Geometry geometry;
  Camera camera;
  shading::Rungs rungs{};
  Surroundings surroundings;
  bool background = false;
  std::optional<Environment::Sun> sun;
  std::vector<PunctualLight> lights;
  Emitters emitters;
  FogBefore fog;
  double gap = 0;  ///< metres: how far rays start from the surface that they leave

  /// The surface of a hit; false: there is a hole.
  [[nodiscard]] bool surface(const PathRay& ray, const reference::Hit& hit, SurfacePoint& point) const;
  [[nodiscard]] glm::vec3 crossing(const SurfacePoint& point, const glm::vec3& toRay) const;
  /// From origin on, metres along a unit direction.
  [[nodiscard]] glm::vec3 transmittance(const glm::dvec3& origin, const glm::dvec3& direction, double length, Bodies bodies) const;
  [[nodiscard]] glm::dvec3 off(const SurfacePoint& point, const glm::dvec3& direction) const { return point.position + glm::dvec3(point.geometric) * (glm::dot(glm::dvec3(point.geometric), direction) < 0 ? -gap : gap); }

 private:
  void footprints(const PathRay& ray, const Part& part, const reference::Hit& hit, Corners& corners) const;
  [[nodiscard]] glm::vec3 through(std::vector<reference::Hit>& hits, const PathRay& ray, bool straight) const;
};

}  // namespace burnish::pathtrace
