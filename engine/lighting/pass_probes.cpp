// Probes in the passes "tiles" and "lighting": their lists travel beside the tiles.
#include <fmt/format.h>

#include <algorithm>

#include "interface/limits.h"
#include "lighting/lighting_pass.h"
#include "plan/plan.h"

namespace burnish::lighting {

using gpu_scene::FrameContext;

std::optional<std::vector<ProbeBox>> LightingPass::probeBoxes(const FrameContext& c) {
  if (!plan::reads(c.plan, "probe records")) return std::nullopt;
  std::vector<ProbeBox> boxes;
  for (const scene::SeenProbe& p : c.probes) {
    const ReflectionProbe& probe = c.scene.probes.reflections[p.index];
    boxes.push_back({p.center, glm::max(probe.halfSize, glm::dvec3(0)), probe.axes, std::max(probe.margin, 0.0)});
  }
  return boxes;
}

// One list a tile of the lighting groups, beside the tile.
Result<void> LightingPass::uploadTileProbes(FrameContext& c) {
  if (lists_->probes.empty()) return {};
  if (lists_->crowded > 0)
    c.report.warn("reflection probes", fmt::format("{} of their boxes meet what one tile of 16 x 16 pixels shows and {} is the limit: the largest are left out there (docs/probes.md)", lists_->mostProbes, MAX_TILE_PROBES));
  const std::span<const std::byte> bytes = std::as_bytes(std::span(lists_->probes));
  if (!tileProbes_) {
    auto made = gl::Buffer::create(device_, gl::BufferUse::Stream, bytes.size(), nullptr, "tiles, probes");
    if (!made) return fail(made.error());
    tileProbes_ = std::move(*made);
    const gl::VertexAttribute attributes[] = {{0, 4, GL_INT, false, true, 0, 0}, {1, MAX_TILE_PROBES, GL_SHORT, false, true, 0, 1}};
    probeTileArray_ = gl::VertexArray::create(device_, attributes, {}, 0, "tiles with probes");
  }
  return tileProbes_.write(bytes);
}

void LightingPass::bindProbeTiles() {
  probeTileArray_.bind();
  device_.gl.VertexArrayVertexBuffer(probeTileArray_.id(), 0, tiles_.id(), 0, sizeof(TileVertex));
  device_.gl.VertexArrayVertexBuffer(probeTileArray_.id(), 1, tileProbes_.id(), 0, sizeof(TileProbes));
}

}  // namespace burnish::lighting
