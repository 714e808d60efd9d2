// The substance codec in the form that map builders need: plain floats, one 8-bit table, and the projection of an
// average back onto the codec. docs/shading.md, section 1; the same text runs on the GPU as
// shaders/shading/substance.h.
#pragma once
#include <burnish/material.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace burnish::material {

inline constexpr float kWaterF0 =
    0.0196f;  ///< the lowest F0 of a dielectric, and the dielectric part of a partly metallic texel
inline constexpr float kGemF0 = 0.25f;      ///< the highest F0 of a dielectric (code 0)
inline constexpr float kPlasticF0 = 0.04f;  ///< glTF's dielectric, code 1/3
inline constexpr float kMetalStart = 0.4f;  ///< codes above are conductors
/// Below this metalness a texel is taken for plain plastic: F0 then errs by at most 0.0096 (white), above it by at most
/// 0.0204 · 0.99 = 0.0202.
inline constexpr float kMetalnessStart = 0.01f;

/// An 8-bit code decoded: F0 = base + metalness · albedo, diffuse = albedo - metalness · albedo. Dielectrics have
/// metalness 0.
struct CodeEntry {
  float base = kPlasticF0;
  float metalness = 0;
};
/// All 256 codes; built once, constant afterwards.
const std::array<CodeEntry, 256>& codeTable();

/// F0 and diffuse of a texel, linear; what filtering averages.
struct Reflectance {
  glm::vec3 f0{kPlasticF0};
  glm::vec3 diffuse{0};
};

/// A texel of map A before 8-bit sRGB: linear albedo and an 8-bit code.
struct CodedTexel {
  glm::vec3 albedo{0};
  std::uint8_t code = 85;
};

/// The dielectric that comes nearest: grey F0 clamped into the codec's range, diffuse kept.
CodedTexel projectDielectric(const Reflectance& average);
/// The conductor that comes nearest in F0 among those that keep F0 + diffuse in every channel.
CodedTexel projectConductor(const Reflectance& average);
/// What a texel shows, for measuring how far a projection is off.
Reflectance decode(const CodedTexel& texel);

}  // namespace burnish::material
