// The renderer's exposure and tone maps on the CPU: shaders/post/exposure.frag, shaders/interface/develop.glsl.
#include <burnish/measure.h>

#include <algorithm>
#include <cmath>

#include "reference/shading.h"

namespace burnish {
namespace {

namespace f32 = shading::f32;

glm::vec3 colorOf(const Image& image, std::size_t i) {
  const float* p = image.f32() + i * std::size_t(image.channels);
  return {p[0], p[1], p[2]};
}

// The centre-weighted mean logarithm of luminance on a grid.
float meteredEv(const Image& image) {
  constexpr int kColumns = 48, kRows = 27;
  double sum = 0, total = 0;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const double u = (x + 0.5) / kColumns, v = (y + 0.5) / kRows, weight = std::exp2(-8.6 * ((u - 0.5) * (u - 0.5) + (v - 0.5) * (v - 0.5)));
      const int column = int(u * image.width), row = image.height - 1 - int(v * image.height);  // the shader counts rows from the bottom
      const glm::vec3 c = colorOf(image, std::size_t(row) * std::size_t(image.width) + std::size_t(column));
      if (!std::isfinite(c.r + c.g + c.b) || c == glm::vec3(0)) continue;
      total += weight;
      sum += weight * std::log2(std::max(0.2126 * double(c.r) + 0.7152 * double(c.g) + 0.0722 * double(c.b), 1e-6));
    }
  return float(std::clamp(sum / std::max(total, 1e-6) + 3, -16.0, 24.0));
}

glm::vec3 mapped(const glm::vec3& c, ToneMap toneMap) {
  switch (toneMap) {
    case ToneMap::Neutral: return f32::tonemapNeutral(c);
    case ToneMap::AgX: return f32::tonemapAgx(c);
    case ToneMap::Aces: return f32::tonemapAces(c);
    case ToneMap::None: break;
  }
  return f32::tonemapNone(c);
}

}  // namespace

Image develop(const Image& radiance, ToneMap toneMap, std::optional<float> exposureEv, float* metered) {
  if (radiance.type != PixelType::F32 || radiance.channels < 3 || radiance.width < 1 || radiance.height < 1 || radiance.data.size() != radiance.byteSize()) return {};
  const float ev = exposureEv ? *exposureEv : meteredEv(radiance), scale = 1 / (1.2f * std::exp2(ev));
  if (metered) *metered = ev;
  Image out = makeImage(radiance.width, radiance.height, 3, PixelType::U8);
  for (std::size_t i = 0; i < out.pixelCount(); ++i) {
    const glm::vec3 c = mapped(colorOf(radiance, i) * scale, toneMap);
    for (int k = 0; k < 3; ++k) {
      const float v = f32::srgbFromLinearFast(c[k]);
      out.u8()[i * 3 + std::size_t(k)] = std::isfinite(v) ? std::uint8_t(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)) : 0;
    }
  }
  return out;
}

}  // namespace burnish
