// Unit vectors at right angles.
#pragma once
#include <cmath>
#include <glm/glm.hpp>

namespace burnish::scene {

/// Any unit vector at right angles to the unit vector n (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
inline glm::vec3 perpendicular(const glm::vec3& n) {
  const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z);
  return {1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

}  // namespace burnish::scene
