// Large meshes are drawn in parts: runs of triangles whose boxes meet the view. What is outside costs no vertices.
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gl/objects.h"
#include "scene/visibility.h"

namespace burnish::gpu_scene {

/// Box around kPartIndices indices in a row, in the mesh's space: middle and half extents.
struct MeshPart {
  glm::vec3 center{0}, extent{0};
};
/// Indices of a part; the mesh's last one may have fewer. 128 triangles: with parts of a quarter of that the bench's atrium (docs/benchmarks.md) still draws 137,128 of 137,416.
inline constexpr int kPartIndices = 384;
/// Parts of a validated mesh; none where there would be fewer than two.
std::vector<MeshPart> partsOf(const Mesh& mesh);

/// Runs of parts in view, as glMultiDrawElements takes them. Keep it: it holds memory.
class PartRuns {
 public:
  /// indexBytes: of one index. No part outside the frustum is listed, and none that meets it is left out.
  void find(const scene::Frustum& frustum, const scene::VisibleInstance& instance, std::span<const MeshPart> parts, int indexCount, int indexBytes);
  [[nodiscard]] GLsizei size() const { return GLsizei(counts_.size()); }
  [[nodiscard]] const GLsizei* counts() const { return counts_.data(); }
  [[nodiscard]] const void* const* offsets() const { return offsets_.data(); }
  [[nodiscard]] std::uint64_t indices() const { return indices_; }  ///< of all runs

 private:
  std::vector<GLsizei> counts_;
  std::vector<const void*> offsets_;
  std::uint64_t indices_ = 0;
};

}  // namespace burnish::gpu_scene
