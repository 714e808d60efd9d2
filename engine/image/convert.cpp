#include "image/convert.h"

#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace burnish::image {
namespace {

#if defined(__x86_64__)
bool hasF16c() { return __builtin_cpu_supports("f16c") != 0; }

__attribute__((target("avx,f16c"))) std::size_t halfToFloatF16c(const std::uint16_t* in, float* out, std::size_t n) {
  std::size_t i = 0;
  for (; i + 8 <= n; i += 8)
    _mm256_storeu_ps(out + i, _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(in + i))));
  return i;
}

__attribute__((target("avx,f16c"))) std::size_t floatToHalfF16c(const float* in, std::uint16_t* out, std::size_t n) {
  std::size_t i = 0;
  for (; i + 8 <= n; i += 8)
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out + i),
                     _mm256_cvtps_ph(_mm256_loadu_ps(in + i), _MM_FROUND_TO_NEAREST_INT));
  return i;
}
#else
bool hasF16c() { return false; }
std::size_t halfToFloatF16c(const std::uint16_t*, float*, std::size_t) { return 0; }
std::size_t floatToHalfF16c(const float*, std::uint16_t*, std::size_t) { return 0; }
#endif

double decodeSrgb(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }

/// Where one code ends and the next begins, and a code to start from for each of 4096 steps of the linear value: at
/// most two steps up from there (the curve rises by 12.92 * 255 / 4096 = 0.8 codes a step at most).
struct SrgbEncoder {
  std::array<float, 257> from{};
  std::array<std::uint8_t, 4097> start{};
  SrgbEncoder() {
    for (int code = 0; code <= 256; ++code)
      from[static_cast<std::size_t>(code)] = code == 0     ? -std::numeric_limits<float>::infinity()
                                             : code == 256 ? std::numeric_limits<float>::infinity()
                                                           : static_cast<float>(decodeSrgb((code - 0.5) / 255));
    std::size_t code = 0;
    for (std::size_t step = 0; step < start.size(); ++step) {
      while (from[code + 1] <= static_cast<float>(step) / 4096) ++code;
      start[step] = static_cast<std::uint8_t>(code);
    }
  }
};

bool isAlpha(int channel, int channels) { return (channels == 2 || channels == 4) && channel == channels - 1; }

float clampFinite(float v, float limit) { return std::isnan(v) ? 0.0f : std::clamp(v, -limit, limit); }

}  // namespace

void halfToFloat(std::span<const std::uint16_t> in, std::span<float> out) {
  const std::size_t n = std::min(in.size(), out.size());
  std::size_t i = hasF16c() ? halfToFloatF16c(in.data(), out.data(), n) : 0;
  for (; i < n; ++i) out[i] = imath_half_to_float(in[i]);
}

void floatToHalf(std::span<const float> in, std::span<std::uint16_t> out) {
  const std::size_t n = std::min(in.size(), out.size());
  std::size_t i = hasF16c() ? floatToHalfF16c(in.data(), out.data(), n) : 0;
  for (; i < n; ++i) out[i] = imath_float_to_half(in[i]);
}

const std::array<float, 256>& srgbToLinearTable() {
  static const std::array<float, 256> kTable = [] {
    std::array<float, 256> table{};
    for (std::size_t code = 0; code < 256; ++code)
      table[code] = static_cast<float>(decodeSrgb(static_cast<double>(code) / 255));
    return table;
  }();
  return kTable;
}

std::uint8_t linearToSrgb8(float linear) {
  static const SrgbEncoder kEncoder;
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  std::size_t code = kEncoder.start[static_cast<std::size_t>(linear * 4096)];
  while (kEncoder.from[code + 1] <= linear) ++code;
  return static_cast<std::uint8_t>(code);
}

Image toF32(const Image& image, bool srgb) {
  Image out = makeImage(image.width, image.height, image.channels, PixelType::F32);
  const std::size_t n = image.pixelCount() * std::size_t(image.channels);
  float* to = out.f32();
  const auto* halves = reinterpret_cast<const std::uint16_t*>(image.data.data());
  switch (image.type) {
    case PixelType::F32:
      out.data = image.data;
      break;
    case PixelType::F16:
      halfToFloat({halves, n}, {to, n});
      break;
    case PixelType::U16:
      for (std::size_t i = 0; i < n; ++i) to[i] = static_cast<float>(halves[i]) / 65535.0f;
      break;
    case PixelType::U8: {
      const auto& table = srgbToLinearTable();
      const auto channels = static_cast<std::size_t>(image.channels);
      for (std::size_t i = 0; i < n; ++i) {
        const bool curve = srgb && !isAlpha(static_cast<int>(i % channels), image.channels);
        to[i] = curve ? table[image.u8()[i]] : static_cast<float>(image.u8()[i]) / 255.0f;
      }
    }
  }
  return out;
}

Image toLinear(const Image& image) {
  Image out = toF32(image, true);
  if (image.type == PixelType::U16)
    for (std::size_t i = 0; i < out.pixelCount() * std::size_t(out.channels); ++i)
      if (!isAlpha(static_cast<int>(i % std::size_t(out.channels)), out.channels)) out.f32()[i] = static_cast<float>(decodeSrgb(out.f32()[i]));
  return out;
}

Image toF16(const Image& image) {
  if (image.type == PixelType::F16) {
    Image out = image;
    makeFinite(out);
    return out;
  }
  Image wide = toF32(image);
  makeFinite(wide);
  Image out = makeImage(image.width, image.height, image.channels, PixelType::F16);
  const std::size_t n = image.pixelCount() * std::size_t(image.channels);
  floatToHalf({wide.f32(), n}, {reinterpret_cast<std::uint16_t*>(out.data.data()), n});
  return out;
}

Image extractChannels(const Image& image, std::initializer_list<int> channels) {
  Image out = makeImage(image.width, image.height, static_cast<int>(channels.size()), image.type);
  const auto size = static_cast<std::size_t>(bytesPerChannel(image.type));
  const std::size_t from = size * std::size_t(image.channels), to = size * std::size_t(out.channels);
  std::size_t at = 0;
  for (int channel : channels) {
    const std::byte* in =
        image.data.data() + size * static_cast<std::size_t>(std::clamp(channel, 0, image.channels - 1));
    for (std::size_t i = 0; i < image.pixelCount(); ++i)
      std::memcpy(out.data.data() + i * to + at, in + i * from, size);
    at += size;
  }
  return out;
}

Mended makeFinite(Image& image, float limit) {
  Mended mended;
  const std::size_t n = image.pixelCount() * std::size_t(image.channels);
  if (image.type != PixelType::F16 && image.type != PixelType::F32) return mended;
  auto* halves = reinterpret_cast<std::uint16_t*>(image.data.data());
  for (std::size_t i = 0; i < n; ++i) {
    const float v = image.type == PixelType::F32 ? image.f32()[i] : imath_half_to_float(halves[i]);
    if (std::abs(v) <= limit) continue;  // false for NaN
    if (!mended.any()) mended.first = i / static_cast<std::size_t>(image.channels);
    std::isfinite(v) ? ++mended.clamped : ++mended.nonFinite;
    const float fixed = clampFinite(v, limit);
    if (image.type == PixelType::F32)
      image.f32()[i] = fixed;
    else
      halves[i] = imath_float_to_half(fixed);
  }
  return mended;
}

}  // namespace burnish::image
