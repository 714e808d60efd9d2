// Pixel values from one form to another: half and float, sRGB and linear, channels, finite ranges.
#pragma once
#include <burnish/image.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>

namespace burnish::image {

/// Largest finite half float.
inline constexpr float kHalfMax = 65504.0f;

/// IEEE 754 binary16 <-> binary32; rounding to nearest even, overflow to infinity. `out` has the size of `in`.
void halfToFloat(std::span<const std::uint16_t> in, std::span<float> out);
void floatToHalf(std::span<const float> in, std::span<std::uint16_t> out);

/// Linear values, 0 to 1, of the 256 codes (IEC 61966-2-1).
const std::array<float, 256>& srgbToLinearTable();
/// The nearest code of a linear value; below 0 and NaN give 0, above 1 gives 255. Exactly the inverse of the table.
std::uint8_t linearToSrgb8(float linear);

/// The image as F32: U8 and U16 become 0 to 1. With `srgb`, colour channels of U8 images are decoded (the last of 2 and
/// 4 channels is alpha and stays linear).
Image toF32(const Image& image, bool srgb = false);
/// The image as F32 in linear light: 8 and 16 bits are taken for sRGB (alpha stays), floats for linear.
Image toLinear(const Image& image);
/// The image as F16: values beyond ±65504 become that, NaN becomes 0. U8 and U16 become 0 to 1.
Image toF16(const Image& image);

/// A new image of the named channels, in their order. Each is 0 to image.channels - 1; 1 to 4 of them. Any type.
Image extractChannels(const Image& image, std::initializer_list<int> channels);

/// What makeFinite mended, in channel values.
struct Mended {
  std::size_t nonFinite = 0;  ///< NaN: became 0; infinity: became the limit
  std::size_t clamped = 0;    ///< finite, beyond the limit
  std::size_t first = 0;      ///< pixel index of the first mended value
  [[nodiscard]] bool any() const { return nonFinite + clamped > 0; }
};
/// Makes an F16 or F32 image finite and within ±limit (other types are so already).
Mended makeFinite(Image& image, float limit = kHalfMax);

}  // namespace burnish::image
