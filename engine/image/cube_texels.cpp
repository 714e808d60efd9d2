// Texels of DDS and KTX2 cubes as linear floats. The packed formats are those of OpenGL 4.5's specification, 8.25 (shared exponent) and 2.3.4.3, 2.3.4.4 (unsigned 11- and 10-bit floats).
#include "image/cube_texels.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>

#include "image/convert.h"

namespace burnish::image {
namespace {

constexpr std::size_t kBlock = 4096;  // texels converted at a time

std::uint32_t word(const std::byte* p) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | std::to_integer<std::uint32_t>(p[i]);
  return value;
}

/// 8-bit channels at offsets r, g, b of a texel of `stride` bytes.
void decode8(bool srgb, std::span<const std::byte> bytes, std::size_t stride, std::array<std::size_t, 3> channel, std::span<float> rgb) {
  const auto& curve = srgbToLinearTable();
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const auto code = std::to_integer<std::size_t>(bytes[i / 3 * stride + channel[i % 3]]);
    rgb[i] = srgb ? curve[code] : static_cast<float>(code) / 255.0f;
  }
}

void decodeHalves(std::span<const std::byte> bytes, std::size_t channels, std::span<float> rgb) {
  std::array<std::uint16_t, kBlock * 4> halves{};
  std::array<float, kBlock * 4> floats{};
  const std::size_t texels = rgb.size() / 3;
  for (std::size_t first = 0; first < texels; first += kBlock) {
    const std::size_t n = std::min(kBlock, texels - first);
    std::memcpy(halves.data(), bytes.data() + first * channels * 2, n * channels * 2);
    halfToFloat({halves.data(), n * channels}, {floats.data(), n * channels});
    for (std::size_t i = 0; i < n * 3; ++i) rgb[first * 3 + i] = floats[i / 3 * channels + i % 3];
  }
}

void decodeFloats(std::span<const std::byte> bytes, std::size_t channels, std::span<float> rgb) {
  for (std::size_t i = 0; i < rgb.size(); i += 3) std::memcpy(&rgb[i], bytes.data() + i / 3 * channels * 4, 12);
}

/// An unsigned float of `bits` bits, 5 of them exponent, is a half float that lost its sign and its last bits.
void decodePackedFloats(std::span<const std::byte> bytes, std::span<float> rgb) {
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    const std::uint32_t packed = word(bytes.data() + i / 3 * 4);
    const std::uint16_t halves[3] = {static_cast<std::uint16_t>((packed & 0x7ff) << 4), static_cast<std::uint16_t>((packed >> 11 & 0x7ff) << 4), static_cast<std::uint16_t>((packed >> 22) << 5)};
    halfToFloat(halves, rgb.subspan(i, 3));
  }
}

void decodeSharedExponent(std::span<const std::byte> bytes, std::span<float> rgb) {
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    const std::uint32_t packed = word(bytes.data() + i / 3 * 4);
    const int exponent = static_cast<int>(packed >> 27) - 15 - 9;
    for (unsigned c = 0; c < 3; ++c) rgb[i + c] = std::ldexp(static_cast<float>(packed >> 9 * c & 0x1ff), exponent);
  }
}

}  // namespace

std::size_t bytesPerTexel(TexelFormat format) {
  constexpr std::size_t kBytes[] = {4, 4, 3, 3, 6, 8, 12, 16, 4, 4};
  return kBytes[static_cast<std::size_t>(format)];
}

void decodeTexels(const TexelLayout& layout, std::span<const std::byte> bytes, std::span<float> rgb) {
  switch (layout.format) {
    case TexelFormat::Rgba8: return decode8(layout.srgb, bytes, 4, {0, 1, 2}, rgb);
    case TexelFormat::Bgra8: return decode8(layout.srgb, bytes, 4, {2, 1, 0}, rgb);
    case TexelFormat::Rgb8: return decode8(layout.srgb, bytes, 3, {0, 1, 2}, rgb);
    case TexelFormat::Bgr8: return decode8(layout.srgb, bytes, 3, {2, 1, 0}, rgb);
    case TexelFormat::Rgb16F: return decodeHalves(bytes, 3, rgb);
    case TexelFormat::Rgba16F: return decodeHalves(bytes, 4, rgb);
    case TexelFormat::Rgb32F: return decodeFloats(bytes, 3, rgb);
    case TexelFormat::Rgba32F: return decodeFloats(bytes, 4, rgb);
    case TexelFormat::Rg11B10F: return decodePackedFloats(bytes, rgb);
    case TexelFormat::Rgb9E5: return decodeSharedExponent(bytes, rgb);
  }
}

Result<void> checkCubeLimits(int size, int levels, const DecodeLimits& limits, std::string_view name) {
  if (size > limits.maxSide)
    return fail(std::string(name), fmt::format("has faces of {} x {} texels, the limit is {} a side", size, size, limits.maxSide), "make the cube smaller");
  std::uint64_t bytes = 0;
  for (int k = 0; k < levels; ++k) bytes += cubeTexels(levelSize(size, k)) * 3 * sizeof(float);
  if (bytes > limits.maxBytes) return fail(std::string(name), fmt::format("takes {} bytes decoded, the limit is {}", bytes, limits.maxBytes), "make the cube smaller");
  return {};
}

CubeLevel makeLevel(int size, int level) {
  CubeLevel out;
  out.size = levelSize(size, level);
  out.texels.resize(cubeTexels(out.size) * 3);
  return out;
}

}  // namespace burnish::image
