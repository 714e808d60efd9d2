#include <algorithm>

#include "scene/visibility.h"

namespace burnish::scene {

// Every triangle's plane against every vertex: a mesh that is not convex fails early, one that is costs triangles × vertices products. Past kMost it is left open.
MeshShape shapeOf(const Mesh& mesh) {
  constexpr std::size_t kMost = 100'000'000;
  const std::size_t triangles = mesh.indices.size() / 3;
  if (triangles == 0 || triangles * mesh.positions.size() > kMost) return MeshShape::General;
  const Bounds b = boundsOf(mesh);
  const float tolerance = 2e-4f * glm::length(b.max - b.min);
  bool below = true, above = true;
  for (std::size_t t = 0; t < triangles && (below || above); ++t) {
    const glm::vec3 p = mesh.positions[mesh.indices[3 * t]], q = mesh.positions[mesh.indices[3 * t + 1]], r = mesh.positions[mesh.indices[3 * t + 2]];
    const glm::dvec3 cross = glm::cross(glm::dvec3(q - p), glm::dvec3(r - p));
    const double length = glm::length(cross);
    if (!(length > 0)) continue;
    const glm::vec3 n(cross / length);
    float low = 0, high = 0;
    for (const glm::vec3& v : mesh.positions) {
      const float d = glm::dot(n, v - p);
      low = std::min(low, d);
      high = std::max(high, d);
      if (high > tolerance && low < -tolerance) return MeshShape::General;
    }
    below = below && high <= tolerance;
    above = above && low >= -tolerance;
  }
  if (below && above) return MeshShape::Flat;
  return below ? MeshShape::Convex : above ? MeshShape::Hollow : MeshShape::General;
}

}  // namespace burnish::scene
