// Texels of the formats that DDS and KTX2 cubes come in, and what can be said of a cube before its texels are read.
#pragma once
#include <burnish/image.h>

#include <string_view>

namespace burnish::image {

enum class TexelFormat : std::uint8_t { Rgba8, Bgra8, Rgb8, Bgr8, Rgb16F, Rgba16F, Rgb32F, Rgba32F, Rg11B10F, Rgb9E5 };

struct TexelLayout {
  TexelFormat format = TexelFormat::Rgba32F;
  bool srgb = false;      ///< 8-bit colours carry the sRGB curve
  std::string_view name;  ///< as the file's specification calls it
};

[[nodiscard]] std::size_t bytesPerTexel(TexelFormat format);
/// Three linear floats a texel; alpha is left out. `bytes` holds rgb.size() / 3 texels.
void decodeTexels(const TexelLayout& layout, std::span<const std::byte> bytes, std::span<float> rgb);

/// Edge of level k of a full chain over `size`: halved each time, at least 1 (OpenGL 4.5 specification, 8.14.3).
[[nodiscard]] constexpr int levelSize(int size, int level) { return level < 31 && size >> level > 0 ? size >> level : 1; }
/// Levels of a full chain down to 1.
[[nodiscard]] constexpr int fullChain(int size) {
  int levels = 1;
  while (size >> levels > 0) ++levels;
  return levels;
}
/// Texels of one level's six faces.
[[nodiscard]] constexpr std::uint64_t cubeTexels(int size) { return 6 * std::uint64_t(size) * std::uint64_t(size); }

/// Whether a cube of these halving levels may be held in memory. Checked before anything is allocated.
Result<void> checkCubeLimits(int size, int levels, const DecodeLimits& limits, std::string_view name);
/// Allocates level k of `size`.
CubeLevel makeLevel(int size, int level);

}  // namespace burnish::image
