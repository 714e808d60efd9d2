#include "material/pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "material/srgb.h"

namespace burnish::material {
namespace {

std::uint8_t byteAt(const Image& image, std::size_t i) {
  const auto unorm = [](float f) { return f > 0 ? std::uint8_t(std::min(f, 1.0f) * 255 + 0.5f) : std::uint8_t(0); };
  switch (image.type) {
    case PixelType::U8: return image.u8()[i];
    case PixelType::U16: {
      std::uint16_t v;
      std::memcpy(&v, image.data.data() + 2 * i, 2);
      return std::uint8_t((v + 128u) / 257u);
    }
    case PixelType::F16: {
      std::uint16_t v;
      std::memcpy(&v, image.data.data() + 2 * i, 2);
      return unorm(glm::unpackHalf1x16(v));
    }
    case PixelType::F32: return unorm(image.f32()[i]);
  }
  return 0;
}

int wrapped(int i, int n, Wrap wrap) {
  switch (wrap) {
    case Wrap::Repeat: return (i % n + n) % n;
    case Wrap::ClampToEdge: return std::clamp(i, 0, n - 1);
    case Wrap::MirroredRepeat: {
      const int k = (i % (2 * n) + 2 * n) % (2 * n);
      return k < n ? k : 2 * n - 1 - k;
    }
  }
  return 0;
}

struct Tap {
  int a = 0, b = 0;
  float t = 0;  ///< weight of b
};
std::vector<Tap> linearTaps(int from, int to, Wrap wrap) {
  std::vector<Tap> taps(to);
  for (int i = 0; i < to; ++i) {
    const float x = (float(i) + 0.5f) * float(from) / float(to) - 0.5f;
    const int low = int(std::floor(x));
    taps[i] = {wrapped(low, from, wrap), wrapped(low + 1, from, wrap), x - float(low)};
  }
  return taps;
}

}  // namespace

Image toRgba8(const Image& image) {
  Image out = makeImage(image.width, image.height, 4, PixelType::U8);
  const int channels = image.channels;
  // Where R, G, B and A come from: grey, grey + alpha, RGB, RGBA.
  static constexpr int kSource[5][4] = {{-1, -1, -1, -1}, {0, 0, 0, -1}, {0, 0, 0, 1}, {0, 1, 2, -1}, {0, 1, 2, 3}};
  const int* source = kSource[channels];
  const std::size_t pixels = image.pixelCount();
  std::uint8_t* to = out.u8();
  if (image.type == PixelType::U8 && channels == 3) {  // the common case, without the detours
    const std::uint8_t* from = image.u8();
    for (std::size_t i = 0; i < pixels; ++i, from += 3, to += 4) {
      to[0] = from[0];
      to[1] = from[1];
      to[2] = from[2];
      to[3] = 255;
    }
    return out;
  }
  for (std::size_t i = 0; i < pixels; ++i, to += 4)
    for (int c = 0; c < 4; ++c) to[c] = source[c] < 0 ? 255 : byteAt(image, i * std::size_t(channels) + std::size_t(source[c]));
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
  for (std::size_t i = 0; i < pixels; ++i) sum += srgb ? double(srgbToLinear()[p[4 * i]]) : double(p[4 * i]) / 255;
  return pixels ? float(sum / double(pixels)) : 0.0f;
}

Image resized(const Image& rgba, int width, int height, bool srgb, Wrap wrapU, Wrap wrapV) {
  Image out = makeImage(width, height, 4, PixelType::U8);
  const auto tapsX = linearTaps(rgba.width, width, wrapU), tapsY = linearTaps(rgba.height, height, wrapV);
  const auto& linear = srgbToLinear();
  const SrgbEncoder& encode = linearToSrgb();
  const auto value = [&](std::uint8_t byte, int c) { return srgb && c < 3 ? linear[byte] : float(byte); };
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* r0 = rgba.u8() + std::size_t(tapsY[y].a) * rgba.width * 4;
    const std::uint8_t* r1 = rgba.u8() + std::size_t(tapsY[y].b) * rgba.width * 4;
    std::uint8_t* to = out.u8() + std::size_t(y) * width * 4;
    for (const Tap& x : tapsX)
      for (int c = 0; c < 4; ++c) {
        const float top = std::lerp(value(r0[4 * x.a + c], c), value(r0[4 * x.b + c], c), x.t);
        const float bottom = std::lerp(value(r1[4 * x.a + c], c), value(r1[4 * x.b + c], c), x.t);
        const float v = std::lerp(top, bottom, tapsY[y].t);
        *to++ = srgb && c < 3 ? encode(v) : std::uint8_t(v + 0.5f);
      }
  }
  return out;
}

}  // namespace burnish::material
