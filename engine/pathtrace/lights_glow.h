// Where lamps shine on things close to them: bright spots, small and many times brighter than all around, that paths would find once in ten thousand tries. A share of the bounces is sent toward
// them, as one more way to draw a direction (the density of the mixture divides, so nothing is biased).
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "pathtrace/world.h"

namespace burnish::pathtrace {

class Glows {
 public:
  static constexpr std::size_t kMost = 24;     ///< the brightest of them
  static constexpr float kShare = 0.15f;       ///< of the bounces, where there is one to see
  /// Looks around each point and spot light for what stands within half a metre.
  explicit Glows(const World& world);
  [[nodiscard]] bool empty() const { return glows_.empty(); }

  /// The glows as balls that a surface sees: cones of directions, by how much light they send.
  struct Cones {
    std::size_t count = 0;
    std::array<glm::vec3, kMost> axis;
    std::array<float, kMost> halfAngle, sine2, density;  ///< radians; squared sine of it; 1/sr, the cone's chance included
  };
  /// Those that reach above the plane of `normal`. One that `at` is in or close to is left out.
  [[nodiscard]] Cones from(const glm::dvec3& at, const glm::vec3& normal) const;
  /// Draws from the cones; count > 0. pick in [0, 1), place in [0, 1)².
  [[nodiscard]] static glm::vec3 sample(const Cones& cones, float pick, const glm::vec2& place);
  /// Its density per solid angle; integrates to 1.
  [[nodiscard]] static float density(const Cones& cones, const glm::vec3& direction);

 private:
  struct Glow {
    glm::dvec3 middle;
    float radius, power;  ///< metres; reflected, up to a constant
  };
  std::vector<Glow> glows_;
};

}  // namespace burnish::pathtrace
