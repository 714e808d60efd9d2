#include "material/merge.h"

#include "image/convert.h"
#include "material/srgb.h"

namespace burnish::material {
namespace {

constexpr std::size_t pixelsOf(int width, int height) { return std::size_t(width) * std::size_t(height); }

float largest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }

ConversionError difference(const Reflectance& a, const Reflectance& b) {
  return {largest(glm::abs(a.f0 - b.f0)), largest(glm::abs(a.diffuse - b.diffuse))};
}

glm::vec3 linearAt(const Image* rgba, std::size_t pixel) {
  if (!rgba) return glm::vec3(1);
  const std::uint8_t* p = rgba->u8() + 4 * pixel;
  const auto& linear = image::srgbToLinearTable();
  return {linear[p[0]], linear[p[1]], linear[p[2]]};
}

}  // namespace

ConversionError metalnessError(float m, float dielectricF0) {
  if (m < kMetalnessStart) return {m * std::max(1 - dielectricF0, dielectricF0), m};  // taken for a dielectric
  return {(1 - m) * std::abs(dielectricF0 - kWaterF0), 0};
}

Image mergeAlbedoSubstance(const AlbedoInput& in, int width, int height, ConversionError& error) {
  Image out = makeImage(width, height, 4, PixelType::U8);
  const std::uint8_t dielectric = std::uint8_t(std::lround(encodeDielectric(in.dielectricF0) * 255));
  std::array<std::uint8_t, 256> code;
  std::array<bool, 256> isMetal, used{};
  for (int i = 0; i < 256; ++i) {
    const float m = in.metallic * float(i) / 255;
    isMetal[i] = m >= kMetalnessStart;
    code[i] = isMetal[i] ? std::uint8_t(std::lround(encodeMetalness(m) * 255)) : dielectric;
  }
  std::uint8_t* to = out.u8();
  const std::size_t pixels = pixelsOf(width, height);
  const std::uint8_t* base = in.base ? in.base->u8() : nullptr;
  const std::uint8_t* metal = in.metal ? in.metal->u8() + 2 : nullptr;
  const std::uint8_t* codes = in.dielectricCodes ? in.dielectricCodes->u8() : nullptr;
  for (std::size_t i = 0; i < 4 * pixels; i += 4) {
    const std::uint8_t m = metal ? metal[i] : 255;
    used[m] = true;
    to[i] = base ? base[i] : 255;
    to[i + 1] = base ? base[i + 1] : 255;
    to[i + 2] = base ? base[i + 2] : 255;
    to[i + 3] = codes && !isMetal[m] ? codes[i] : code[m];
  }
  for (int i = 0; i < 256; ++i)
    if (used[i]) error.widen(metalnessError(in.metallic * float(i) / 255, in.dielectricF0));
  return out;
}

Reflectance fromSpecular(const glm::vec3& diffuse, const glm::vec3& specular) {
  return {specular, diffuse * (1 - largest(specular))};
}

CodedTexel nearestTexel(const Reflectance& wanted, ConversionError& error) {
  const CodedTexel dielectric = projectDielectric(wanted), conductor = projectConductor(wanted);
  const ConversionError d = difference(decode(dielectric), wanted), c = difference(decode(conductor), wanted);
  const bool metal = c.f0 + c.diffuse < d.f0 + d.diffuse;
  error.widen(metal ? c : d);
  return metal ? conductor : dielectric;
}

Image mergeSpecular(const SpecularInput& in, int width, int height, ConversionError& error) {
  // Painted F0 above this is metal or a filtered edge to it. Conductors show grey F0 of any height too, and with one
  // rule for both the codes run one way along such an edge (material/mips.cpp has the same reason).
  constexpr float kMetalF0 = 0.08f;
  Image out = makeImage(width, height, 4, PixelType::U8);
  const SrgbEncoder& encode = linearToSrgb();
  std::uint8_t* to = out.u8();
  const std::size_t pixels = pixelsOf(width, height);
  for (std::size_t i = 0; i < pixels; ++i, to += 4) {
    const Reflectance wanted =
        fromSpecular(in.diffuseFactor * linearAt(in.diffuse, i), in.specularFactor * linearAt(in.specular, i));
    const CodedTexel t = (wanted.f0.x + wanted.f0.y + wanted.f0.z) / 3 <= kMetalF0 ? projectDielectric(wanted)
                                                                                   : projectConductor(wanted);
    error.widen(difference(decode(t), wanted));
    for (int c = 0; c < 3; ++c) to[c] = encode(t.albedo[c]);
    to[3] = t.code;
  }
  return out;
}

Image dielectricCodes(const glm::vec3& f0, const Image* strength, const Image* color, int width, int height,
                      ConversionError& error) {
  Image out = makeImage(width, height, 4, PixelType::U8);
  std::uint8_t* to = out.u8();
  const std::size_t pixels = pixelsOf(width, height);
  for (std::size_t i = 0; i < pixels; ++i, to += 4) {
    const glm::vec3 wanted =
        glm::min(f0 * linearAt(color, i), 1.0f) * (strength ? float(strength->u8()[4 * i + 3]) / 255 : 1.0f);
    const CodedTexel t = projectDielectric({wanted, {}});
    error.f0 = std::max(error.f0, largest(glm::abs(decode(t).f0 - wanted)));
    to[0] = t.code;
  }
  return out;
}

Image mergeNormalRoughness(const Image* normal, float normalScale, const Image* roughness, int channel,
                           const std::array<std::uint8_t, 256>& table, int width, int height) {
  Image out = makeImage(width, height, 4, PixelType::U8);
  std::uint8_t* to = out.u8();
  const std::size_t pixels = pixelsOf(width, height);
  for (std::size_t i = 0; i < pixels; ++i, to += 4) {
    to[3] = table[roughness ? roughness->u8()[4 * i + std::size_t(channel)] : 255];
    if (!normal) {
      to[0] = to[1] = 128;
      to[2] = 255;
      continue;
    }
    const std::uint8_t* n = normal->u8() + 4 * i;
    if (normalScale == 1) {
      std::copy_n(n, 3, to);
      continue;
    }
    // glTF: normalize((sample * 2 - 1) * vec3(scale, scale, 1)), with 128 as zero so that flat stays flat.
    const glm::vec3 v(float(n[0] - 128) * normalScale, float(n[1] - 128) * normalScale, float(n[2] - 128));
    const float length = glm::length(v);
    for (int c = 0; c < 3; ++c) to[c] = length > 0 ? std::uint8_t(128.5f + 127 * v[c] / length) : n[c];
  }
  return out;
}

Image mergeOcclusion(const Image* occlusion, const Image* alpha, int width, int height) {
  const int channels = alpha ? 2 : 1;
  Image out = makeImage(width, height, channels, PixelType::U8);
  std::uint8_t* to = out.u8();
  const std::size_t pixels = pixelsOf(width, height);
  for (std::size_t i = 0; i < pixels; ++i, to += channels) {
    to[0] = occlusion ? occlusion->u8()[4 * i] : 255;
    if (alpha) to[1] = alpha->u8()[4 * i + 3];
  }
  return out;
}

}  // namespace burnish::material
