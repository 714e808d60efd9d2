// The surfaces of a tile pixel by pixel, where depth and normals are in memory (software renderers): which lights reach one of them from its front.
// A box around a tile's surfaces lists lights that are near it and reach none of them, or all of them from behind: on the bench's atrium three of ten (docs/benchmarks.md).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "scene/visibility.h"

namespace burnish::lighting {

class TileSurfaces {
 public:
  /// depth, normals: the viewport's rows from bottom to top; normals are the G-buffer's second target as it stores them: its four bytes, or with Oct16 the two channels of
  /// the normal. Both must live until the last call of reached().
  void begin(const scene::ViewFrame& view, std::span<const float> depth, std::span<const std::uint32_t> normals, NormalStorage storage);
  /// Takes the tile of 16 x 16 pixels in column tx, row ty; then asks whether light reaches a surface in it from its front. No false negatives.
  void load(int tx, int ty);
  [[nodiscard]] bool reached(const scene::LocalLight& light) const;

 private:
  static constexpr int kPixels = 256;
  scene::ViewFrame view_;
  std::span<const float> depth_;
  std::span<const std::uint32_t> normals_;
  NormalStorage storage_ = NormalStorage::Oct12;
  int rows_ = 0;  // of the tile
  // Pixels without a surface are far away. Normals are not of unit length: the sign of a product is what counts.
  alignas(64) float x_[kPixels], y_[kPixels], z_[kPixels], nx_[kPixels], ny_[kPixels], nz_[kPixels];
};

}  // namespace burnish::lighting
