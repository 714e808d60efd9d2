// Light culling and the lighting passes: "tiles", "occlusion", "occlusion_denoise", "lighting", "background".
#pragma once
#include <optional>

#include "gpu_scene/frame.h"
#include "lighting/light_tiles.h"
#include "prefilter/dfg.h"

namespace burnish::lighting {

class LightingPass {
 public:
  explicit LightingPass(gl::Device& device) : device_(device) {}
  /// Pass "tiles": depth bounds of each tile, light lists, uploads.
  Result<void> buildTiles(gpu_scene::FrameContext& context);
  /// Pass "lighting": shades the tiles that hold surfaces into the light buffer.
  Result<void> shadeTiles(gpu_scene::FrameContext& context);
  /// Pass "occlusion": visible over visible at most of each pixel's slices, and their weight, into "occlusion_raw".
  Result<void> findOcclusion(gpu_scene::FrameContext& context);
  /// Pass "occlusion_denoise": its mean over neighbours on the same surface, and baked occlusion where that is darker, into "occlusion".
  Result<void> denoiseOcclusion(gpu_scene::FrameContext& context);
  /// Binds what the forward reference shades with: every light, the environment, the lobe's table. The pass "forward" draws then.
  Result<void> bindForward(gpu_scene::FrameContext& context);
  /// Pass "background": where nothing was drawn.
  Result<void> drawBackground(gpu_scene::FrameContext& context);
  /// The same for a pass that comes after "tiles" or "forward", which have uploaded the lights (where neither is, there are none).
  Result<void> bindLights(gpu_scene::FrameContext& context);
  /// Draws every tile with the bound program (debug view of the lists).
  Result<void> drawAllTiles(gpu_scene::FrameContext& context);

 private:
  Result<void> readTileDepths(gpu_scene::FrameContext& context);
  void readTileSurfaces(gpu_scene::FrameContext& context);
  Result<void> uploadLights(gpu_scene::FrameContext& context);
  Result<void> uploadLists(bool entries);
  Result<void> uploadTileProbes(gpu_scene::FrameContext& context);
  /// Of the view's probes; none where the plan reads no records of them.
  static std::optional<std::vector<ProbeBox>> probeBoxes(const gpu_scene::FrameContext& context);
  /// The environment, captured places and the lobe's table, where the quality reads them. places: what is drawn may be lit by some.
  Result<void> bindSurroundings(gpu_scene::FrameContext& context, int environmentUnit, bool places);
  Result<GLuint> dfgTable(const Quality& quality);
  void bindTiles();
  void bindProbeTiles();
  static void widenViewport(const gpu_scene::FrameContext& context);

  gl::Device& device_;
  // GL objects are made when a plan first wants them.
  TileCuller culler_;
  const TileLists* lists_ = nullptr;
  std::vector<float> depth_;
  std::vector<TileDepth> tileDepths_;
  std::vector<std::uint32_t> normals_;
  TileSurfaces surfaces_;
  gl::Buffer tiles_, tileProbes_;
  gl::VertexArray tileArray_, probeTileArray_;  // the second with the tiles' probes
  gl::TextureBuffer lights_, entries_;
  std::array<gl::Texture, prefilter::kDfgTables> dfg_;  ///< made when first asked for
};

}  // namespace burnish::lighting
