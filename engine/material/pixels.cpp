#include "material/pixels.h"

#include <algorithm>

#include "image/convert.h"

namespace burnish::material {

Image toRgba8(const Image& image) {
  Image out = makeImage(image.width, image.height, 4, PixelType::U8);
  const std::size_t channels = std::size_t(image.channels), pixels = image.pixelCount();
  // Where R, G, B and A come from (-1: 255): grey, grey + alpha, RGB, RGBA.
  static constexpr int kSource[5][4] = {{-1, -1, -1, -1}, {0, 0, 0, -1}, {0, 0, 0, 1}, {0, 1, 2, -1}, {0, 1, 2, 3}};
  const int* source = kSource[channels];
  std::uint8_t* to = out.u8();
  if (image.type == PixelType::U8) {
    const std::uint8_t* from = image.u8();
    for (std::size_t i = 0; i < pixels; ++i, from += channels, to += 4)
      for (int c = 0; c < 4; ++c) to[c] = source[c] < 0 ? std::uint8_t(255) : from[source[c]];
    return out;
  }
  const Image floats = image::toF32(image);
  const float* from = floats.f32();
  for (std::size_t i = 0; i < pixels; ++i, from += channels, to += 4)
    for (int c = 0; c < 4; ++c) {
      const float v = source[c] < 0 ? 1 : from[source[c]];
      to[c] = v > 0 ? std::uint8_t(std::min(v, 1.0f) * 255 + 0.5f) : std::uint8_t(0);  // NaN too
    }
  return out;
}

std::optional<std::uint8_t> constantChannel(const Image& rgba, int channel) {
  const std::uint8_t* p = rgba.u8() + channel;
  const std::size_t pixels = rgba.pixelCount();
  if (pixels == 0) return {};
  const std::uint8_t first = *p;
  for (std::size_t i = 1; i < pixels; ++i)
    if (p[4 * i] != first) return {};
  return first;
}

float meanChannel(const Image& rgba, int channel, bool srgb) {
  const std::uint8_t* p = rgba.u8() + channel;
  const std::size_t pixels = rgba.pixelCount();
  double sum = 0;
  for (std::size_t i = 0; i < pixels; ++i)
    sum += srgb ? double(image::srgbToLinearTable()[p[4 * i]]) : double(p[4 * i]) / 255;
  return pixels ? float(sum / double(pixels)) : 0.0f;
}

}  // namespace burnish::material
