// Which probes' boxes meet what a tile shows.
#include <algorithm>
#include <cmath>

#include "lighting/light_tiles.h"

namespace burnish::lighting {

void TileCuller::findProbes(const scene::ViewFrame& view, const std::vector<ProbeBox>& probes) {
  probes_.assign(slices_.size(), TileProbes(-1));
  probeCounts_.assign(slices_.size(), 0);
  for (std::size_t i = 0; i < probes.size(); ++i) markProbe(view, probes[i], std::int16_t(i));
  for (const std::uint16_t count : probeCounts_) {
    lists_.mostProbes = std::max(lists_.mostProbes, int(count));
    lists_.crowded += count > MAX_TILE_PROBES;
  }
}

// Slice and box are apart where they are along one of the view's axes or of the box's own (no false negatives: the edges' products are not looked at).
void TileCuller::markProbe(const scene::ViewFrame& view, const ProbeBox& probe, std::int16_t index) {
  // In eye space, larger by what floats of the shader's own position may be off.
  const auto inEye = [&](const glm::dvec3& v) { return glm::dvec3(glm::dot(view.axes[0], v), glm::dot(view.axes[1], v), -glm::dot(view.axes[2], v)); };
  const glm::dvec3 center = inEye(probe.center), half = probe.halfSize + probe.margin + 1e-4 * (glm::length(center) + glm::length(probe.halfSize));
  const glm::dvec3 axes[3] = {inEye(probe.axes[0]), inEye(probe.axes[1]), inEye(probe.axes[2])};
  std::array<glm::dvec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) corners[i] = center + axes[0] * (i & 1 ? half.x : -half.x) + axes[1] * (i & 2 ? half.y : -half.y) + axes[2] * (i & 4 ? half.z : -half.z);
  const Spanned s = spanOf(view, corners);
  const auto meets = [&](const Box& b) {
    const glm::dvec3 low(b.minX, b.minY, b.minZ), high(b.maxX, b.maxY, b.maxZ), middle = (low + high) * 0.5 - center, extent = (high - low) * 0.5;
    for (int k = 0; k < 3; ++k)
      if (high[k] < s.low[k] || low[k] > s.high[k] || std::abs(glm::dot(axes[k], middle)) > half[k] + glm::dot(glm::abs(axes[k]), extent)) return false;
    return true;
  };
  for (int ty = s.ty0; ty <= s.ty1; ++ty)
    for (int tx = s.tx0; tx <= s.tx1; ++tx) {
      const std::size_t i = std::size_t(ty * columns_ + tx);
      if (slices_[i] == 0 || !(meets(boxes_[i][0]) || (slices_[i] == 2 && meets(boxes_[i][1])))) continue;
      if (probeCounts_[i] < MAX_TILE_PROBES) probes_[i][probeCounts_[i]] = index;
      ++probeCounts_[i];
    }
}

}  // namespace burnish::lighting
