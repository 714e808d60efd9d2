#include "scene/enlarge.h"

#include <algorithm>
#include <cmath>

#include "image/convert.h"
#include "material/srgb.h"

namespace burnish::scene {
namespace {

int wrapped(int i, int n, Wrap wrap) {
  switch (wrap) {
    case Wrap::Repeat:
      return (i % n + n) % n;
    case Wrap::ClampToEdge:
      return std::clamp(i, 0, n - 1);
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

Image enlarged(const Image& rgba, int width, int height, bool srgb, Wrap wrapU, Wrap wrapV) {
  Image out = makeImage(width, height, 4, PixelType::U8);
  const auto tapsX = linearTaps(rgba.width, width, wrapU), tapsY = linearTaps(rgba.height, height, wrapV);
  const auto& linear = image::srgbToLinearTable();
  const material::SrgbEncoder& encode = material::linearToSrgb();
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

}  // namespace burnish::scene
