// Which lights reach which tiles: lists for tiles of 16 x 16 pixels, bounded by the depth of what is in them. No GL; everything relative to the eye.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/visibility.h"

namespace burnish::lighting {

/// Depth of the nearest and farthest surface of a tile, as stored (reversed); far < 0: nothing is drawn there.
struct TileDepth {
  float near = 0, far = -1;
};
/// From a depth buffer: rows bottom to top, `stride` floats a row, the viewport's lower left texel first. Texels of value 0 hold nothing.
void reduceDepth(const float* depth, int stride, int width, int height, std::vector<TileDepth>& out);

/// One tile as the vertex shader reads it: x, y, first entry in the lists, number of entries (padding included).
using TileVertex = glm::ivec4;
/// Tiles that are shaded by one program: lists of `bucket` lights (plan::kTileBuckets), or plan::kLoop.
struct TileGroup {
  int bucket = 0;
  int first = 0, count = 0;  ///< in tiles
};
struct TileLists {
  std::vector<TileVertex> tiles;        ///< those with something to light, grouped
  std::vector<TileGroup> groups;        ///< none empty
  std::vector<std::uint16_t> entries;   ///< light index + 1; 0 is the black light that pads
  int lightsInView = 0;
};

class TileCuller {
 public:
  /// No false negatives: every light whose sphere (and cone) touches a surface between the tile's depths is listed. Lights past 65534 are left out by the caller.
  const TileLists& cull(const scene::ViewFrame& view, std::span<const TileDepth> depths, std::span<const scene::LocalLight> lights);

 private:
  struct Pair {
    std::uint32_t tile;
    std::uint16_t light;
  };
  void boundTiles(const scene::ViewFrame& view, std::span<const TileDepth> depths);
  void cullLight(const scene::ViewFrame& view, const scene::LocalLight& light, std::uint16_t index);
  void buildLists(std::span<const scene::LocalLight> lights);

  int columns_ = 0, rows_ = 0;
  double near_ = 0;
  // Bounds of each tile's slice in eye space (right, up, forward), one array a side.
  std::vector<float> minX_, maxX_, minY_, maxY_, minZ_, maxZ_;
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> counts_, offsets_;
  std::vector<std::uint8_t> spots_;
  std::vector<std::uint16_t> sorted_;
  TileLists lists_;
};

}  // namespace burnish::lighting
