// The surroundings as a source of light: what a lat-long picture or a colour gives, and directions drawn by it.
#pragma once
#include <burnish/scene.h>

#include "pathtrace/world.h"
#include "pathtrace/distribution.h"

namespace burnish::pathtrace {

class Surroundings {
 public:
  /// Values are mended as the renderer mends them (gpu_scene/gpu_environment.cpp). Errors: a map that is no float picture with 3 or 4 channels.
  static Result<Surroundings> create(const Environment& environment);
  /// Between texels' middles linear, as shaders/lighting/sky.frag shows it. direction: unit.
  [[nodiscard]] glm::vec3 radiance(const glm::vec3& direction) const;
  [[nodiscard]] bool lit() const { return lit_; }
  /// A texel by luminance times solid angle, then evenly over its solid angle; a texel counts as bright as the brightest around it, which filtering mixes into it.
  [[nodiscard]] EnvironmentSample sample(const glm::vec2& place) const;
  [[nodiscard]] float density(const glm::vec3& direction) const;
  /// The mended picture in cd/m²; of a colour, a small one.
  [[nodiscard]] const Image& picture() const { return picture_; }

 private:
  void makeDistributions();
  [[nodiscard]] glm::vec3 texel(int x, int y) const;
  Image picture_;
  bool lit_ = false;
  Distribution rows_;
  std::vector<Distribution> columns_;
  std::vector<float> cosines_;  ///< of the polar angles between rows: 1 first, -1 last
};

}  // namespace burnish::pathtrace
