// Map B follows Toksvig, "Mipmapping Normal Maps" (2005): the average of unit normals is shorter the more they differ,
// and that widens the lobe. His 1/p' = 1/p + (1 - r)/r, with r the mean length and 1/p = alpha²/2 the lobe's variance
// of slope, is alpha'² = alpha² + 2 σ², σ² = (1 - r)/r: variances add (Kaplanyan et al., "Filtering Distributions of
// Normals for Shading Antialiasing", 2016, section 4; Tokuyoshi and Kaplanyan 2019).
#include "material/mips.h"

#include "image/convert.h"
#include "material/codec.h"
#include "material/resample.h"
#include "material/srgb.h"

namespace burnish::material {
namespace {

using ByteRow = const std::uint8_t*;
using Bytes = std::uint8_t*;

// Each kind of map: how texels become floats that may be averaged, and how averages become texels.
// Map A: F0 and diffuse are linear in (base, m, albedo, m · albedo), so these eight floats are what is averaged.
struct AlbedoSubstanceFilter {
  static constexpr int kFloats = 8;
  const std::array<float, 256>& linear = image::srgbToLinearTable();
  const std::array<CodeEntry, 256>& code = codeTable();
  const SrgbEncoder& encode = linearToSrgb();

  void unpack(ByteRow in, float* out, int n, int) const {
    for (int i = 0; i < n; ++i, in += 4, out += kFloats) {
      const CodeEntry e = code[in[3]];
      for (int c = 0; c < 3; ++c) {
        const float a = linear[in[c]];
        out[c] = a;
        out[3 + c] = a * e.metalness;
      }
      out[6] = e.base;
      out[7] = e.metalness;
    }
  }
  void pack(const float* in, Bytes out, int n, int) const {
    for (int i = 0; i < n; ++i, in += kFloats, out += 4) {
      const Reflectance r{glm::vec3(in[6] + in[3], in[6] + in[4], in[6] + in[5]),
                          glm::vec3(in[0] - in[3], in[1] - in[4], in[2] - in[5])};
      // Any metal makes it a conductor: the code then runs one way along a filtered edge from paint to metal, and the
      // shader's bilinear filter between neighbours never passes through a code that neither of them means.
      const CodedTexel t = in[7] < kMetalnessStart ? projectDielectric(r) : projectConductor(r);
      for (int c = 0; c < 3; ++c) out[c] = encode(t.albedo[c]);
      out[3] = t.code;
    }
  }
};

std::uint8_t unorm(float x) { return std::uint8_t(std::clamp(x, 0.0f, 1.0f) * 255 + 0.5f); }
/// alpha² = r⁴ from an 8-bit perceptual roughness, and back.
const std::array<float, 256>& alpha2Table() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t;
    for (int i = 0; i < 256; ++i) t[i] = float(std::pow(i / 255.0, 4));
    return t;
  }();
  return table;
}
std::uint8_t roughnessByte(float alpha2) { return unorm(std::sqrt(std::sqrt(std::min(alpha2, 1.0f)))); }

struct NormalRoughnessFilter {
  static constexpr int kFloats = 4;
  const std::array<float, 256>& alpha2 = alpha2Table();

  void unpack(ByteRow in, float* out, int n, int) const {
    for (int i = 0; i < n; ++i, in += 4, out += kFloats) {
      const float x = float(in[0] - 128), y = float(in[1] - 128), z = float(in[2] - 128);
      const float length2 = x * x + y * y + z * z, k = length2 > 0 ? 1 / std::sqrt(length2) : 0.0f;
      out[0] = x * k;
      out[1] = y * k;
      out[2] = length2 > 0 ? z * k : 1.0f;
      out[3] = alpha2[in[3]];
    }
  }
  void pack(const float* in, Bytes out, int n, int) const {
    for (int i = 0; i < n; ++i, in += kFloats, out += 4) {
      const float length = std::sqrt(in[0] * in[0] + in[1] * in[1] + in[2] * in[2]);
      const float k = length > 1e-6f ? 127 / length : 0.0f;
      for (int c = 0; c < 3; ++c) out[c] = std::uint8_t(128.5f + k * in[c]);
      if (k == 0) out[2] = 255;
      out[3] = roughnessByte(in[3] + spreadFromMeanLength(length));
    }
  }
};

struct EmissiveFilter {
  static constexpr int kFloats = 4;
  const std::array<float, 256>& linear = image::srgbToLinearTable();
  const SrgbEncoder& encode = linearToSrgb();
  void unpack(ByteRow in, float* out, int n, int channels) const {
    for (int i = 0; i < n; ++i, in += channels, out += kFloats) {
      for (int c = 0; c < 3; ++c) out[c] = linear[in[c]];
      out[3] = channels == 4 ? float(in[3]) / 255 : 0.0f;
    }
  }
  void pack(const float* in, Bytes out, int n, int channels) const {
    for (int i = 0; i < n; ++i, in += kFloats, out += channels) {
      for (int c = 0; c < 3; ++c) out[c] = encode(in[c]);
      if (channels == 4) out[3] = unorm(in[3]);
    }
  }
};

// Occlusion (1 or 2 channels) and the metal-roughness of glTF (3 or 4; G is averaged as alpha²).
template <bool kRoughness>
struct LinearFilter {
  static constexpr int kFloats = 4;
  const std::array<float, 256>& alpha2 = alpha2Table();
  void unpack(ByteRow in, float* out, int n, int channels) const {
    for (int i = 0; i < n; ++i, in += channels, out += kFloats)
      for (int c = 0; c < 4; ++c)
        out[c] = c >= channels ? 0.0f : kRoughness && c == 1 ? alpha2[in[c]] : float(in[c]) / 255;
  }
  void pack(const float* in, Bytes out, int n, int channels) const {
    for (int i = 0; i < n; ++i, in += kFloats, out += channels)
      for (int c = 0; c < channels; ++c) out[c] = kRoughness && c == 1 ? roughnessByte(in[c]) : unorm(in[c]);
  }
};

// out += weight · in over n floats.
void accumulate(float* out, const float* in, float weight, int n) {
  for (int i = 0; i < n; ++i) out[i] += weight * in[i];
}

// One row halved in x.
template <int kFloats>
void halveRow(const float* in, float* out, const std::vector<HalvingTap>& taps) {
  for (const HalvingTap& t : taps) {
    const float* p = in + std::size_t(t.first) * kFloats;
    for (int c = 0; c < kFloats; ++c) {
      float sum = t.weight[0] * p[c];
      for (int k = 1; k < t.count; ++k) sum += t.weight[k] * p[k * kFloats + c];
      out[c] = sum;
    }
    out += kFloats;
  }
}

/// Halves an image whose rows `source(y)` hands out as floats.
template <int kFloats, class Source>
FloatImage halve(int width, int height, Source&& source) {
  const auto tapsX = halvingTaps(width), tapsY = halvingTaps(height);
  FloatImage out{int(tapsX.size()), int(tapsY.size()), kFloats, {}};
  out.data.resize(tapsX.size() * tapsY.size() * kFloats);
  const int rowFloats = width * kFloats;
  std::vector<float> sum(rowFloats);
  for (int y = 0; y < out.height; ++y) {
    std::fill(sum.begin(), sum.end(), 0.0f);
    for (int k = 0; k < tapsY[y].count; ++k)
      accumulate(sum.data(), source(tapsY[y].first + k), tapsY[y].weight[k], rowFloats);
    halveRow<kFloats>(sum.data(), out.row(y), tapsX);
  }
  return out;
}

template <class Filter>
std::vector<Image> chain(const Filter& filter, Image level0) {
  constexpr int kFloats = Filter::kFloats;
  std::vector<Image> levels;
  levels.push_back(std::move(level0));
  const int channels = levels[0].channels;
  FloatImage current;
  for (int w = levels[0].width, h = levels[0].height; w > 1 || h > 1; w = current.width, h = current.height) {
    if (levels.size() == 1) {
      const Image& top = levels[0];
      std::vector<float> row(std::size_t(w) * kFloats);
      current = halve<kFloats>(w, h, [&](int y) {
        filter.unpack(top.u8() + std::size_t(y) * w * channels, row.data(), w, channels);
        return row.data();
      });
    } else {
      const FloatImage above = std::move(current);
      current = halve<kFloats>(w, h, [&](int y) { return above.row(y); });
    }
    Image level = makeImage(current.width, current.height, channels, PixelType::U8);
    for (int y = 0; y < current.height; ++y)
      filter.pack(current.row(y), level.u8() + std::size_t(y) * current.width * channels, current.width, channels);
    levels.push_back(std::move(level));
  }
  return levels;
}

std::vector<Image> single(Image image) {
  std::vector<Image> levels;
  levels.push_back(std::move(image));
  return levels;
}

}  // namespace

float spreadFromMeanLength(float length) {
  const float r = std::clamp(length, 0.0f, 1.0f);
  if (r < 2.0f / 3) return 1;                    // alpha is capped at 1
  return 2 * std::max(1 - r - 5e-7f, 0.0f) / r;  // less the floats' rounding: equal normals must not widen anything
}

std::vector<Image> buildMips(MapKind kind, Image level0) {
  if (level0.type != PixelType::U8 || level0.width < 1 || level0.height < 1 || level0.data.size() < level0.byteSize())
    return single(std::move(level0));
  const int channels = level0.channels;
  switch (kind) {
    case MapKind::AlbedoSubstance:
      return channels == 4 ? chain(AlbedoSubstanceFilter{}, std::move(level0)) : single(std::move(level0));
    case MapKind::NormalRoughness:
      return channels == 4 ? chain(NormalRoughnessFilter{}, std::move(level0)) : single(std::move(level0));
    case MapKind::Emissive:
      return channels >= 3 ? chain(EmissiveFilter{}, std::move(level0)) : single(std::move(level0));
    case MapKind::MetalRough:
      return channels >= 3 ? chain(LinearFilter<true>{}, std::move(level0)) : single(std::move(level0));
    case MapKind::Occlusion:
      return chain(LinearFilter<false>{}, std::move(level0));
  }
  return single(std::move(level0));
}

}  // namespace burnish::material
