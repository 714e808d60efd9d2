// The camera, what it sees where nothing is, and the fog before it.
#pragma once
#include "pathtrace/environment.h"
#include "pathtrace/world.h"
#include "scene/visibility.h"

namespace burnish::pathtrace {

class Camera {
 public:
  Camera(const View& view, glm::ivec2 size);
  [[nodiscard]] PathRay ray(const glm::dvec2& pixel) const;
  /// What lies farther along a camera's ray is not seen.
  [[nodiscard]] double end(const PathRay& ray) const;
  [[nodiscard]] glm::dvec3 forward() const { return -frame_.axes[2]; }
  [[nodiscard]] const scene::ViewFrame& frame() const { return frame_; }
  /// shaders/lighting/sky.frag: the sun's disc with an edge of one pixel.
  [[nodiscard]] glm::vec3 sunDisc(const Environment::Sun& sun, const glm::dvec3& direction) const;

 private:
  scene::ViewFrame frame_;
  glm::ivec2 size_;
};

/// shaders/interface/fog.glsl.
class FogBefore {
 public:
  FogBefore() = default;
  /// suns: of them the directional ones light the fog.
  FogBefore(const Scene& scene, const Surroundings& surroundings, std::span<const PunctualLight> suns, Report& report);
  [[nodiscard]] bool there() const { return fog_.density > 0; }
  [[nodiscard]] FogShare share(const PathRay& ray, double distance) const;

 private:
  Fog fog_;
  glm::vec3 ambient_[4]{};  ///< constant, along y, z, x
  std::vector<std::pair<glm::vec3, glm::vec3>> suns_;  ///< direction, what the fog scatters of its light
};

}  // namespace burnish::pathtrace
