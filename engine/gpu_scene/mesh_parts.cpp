#include "gpu_scene/mesh_parts.h"

#include <algorithm>

namespace burnish::gpu_scene {

std::vector<MeshPart> partsOf(const Mesh& mesh) {
  std::vector<MeshPart> parts;
  if (mesh.indices.size() <= std::size_t(kPartIndices)) return parts;
  for (std::size_t first = 0; first < mesh.indices.size(); first += kPartIndices) {
    glm::vec3 low = mesh.positions[mesh.indices[first]], high = low;
    for (std::size_t i = first; i < std::min(first + kPartIndices, mesh.indices.size()); ++i) {
      low = glm::min(low, mesh.positions[mesh.indices[i]]);
      high = glm::max(high, mesh.positions[mesh.indices[i]]);
    }
    parts.push_back({low * 0.5f + high * 0.5f, high * 0.5f - low * 0.5f});
  }
  return parts;
}

void PartRuns::find(const scene::Frustum& frustum, const scene::VisibleInstance& instance, std::span<const MeshPart> parts, int indexCount, int indexBytes) {
  counts_.clear();
  offsets_.clear();
  indices_ = 0;
  bool open = false;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    glm::dvec3 center, extent;
    for (int r = 0; r < 3; ++r) {
      const glm::dvec4 row(instance.model[r]);
      center[r] = glm::dot(glm::dvec3(row), glm::dvec3(parts[i].center)) + row.w;
      extent[r] = glm::dot(glm::abs(glm::dvec3(row)), glm::dvec3(parts[i].extent));
    }
    // The slack is for vertices in float and for the rasterizer's grid: a tenth of a pixel and more.
    extent = extent * 1.001 + 2e-4 * glm::length(center);
    if (!frustum.meetsBox(center, extent)) {
      open = false;
      continue;
    }
    const int first = int(i) * kPartIndices, count = std::min(kPartIndices, indexCount - first);
    if (!open) {
      counts_.push_back(0);
      offsets_.push_back(reinterpret_cast<const void*>(std::uintptr_t(first) * std::uintptr_t(indexBytes)));
    }
    counts_.back() += count;
    indices_ += std::uint64_t(count);
    open = true;
  }
}

}  // namespace burnish::gpu_scene
