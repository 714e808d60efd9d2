// Two maps describe a material: A = albedo + substance, B = normal + roughness. A third, C, exists where a material calls for it (occlusion, opacity).
#pragma once
#include <burnish/result.h>

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

namespace burnish {

/// How the texels are to be read and their mip levels made (docs/shading.md, sections 1 and 3).
enum class MapKind : std::uint8_t {
  AlbedoSubstance,  ///< map A: RGB sRGB albedo, A substance code. Mips average F0 and diffuse and encode again.
  NormalRoughness,  ///< map B: RGB tangent normal, (byte - 128) / 127 so that flat is exact, A perceptual roughness. Mips widen roughness by the normals' spread.
  Occlusion,        ///< map C: R baked ambient occlusion (linear), G opacity (linear)
  Emissive,         ///< RGB sRGB
  MetalRough,       ///< glTF metal-roughness kept apart: G roughness, B metalness (linear); only for materials whose maps cannot be merged: map A's code is then unused and map B's alpha holds
                    ///< the normals' spread alone (0 in level 0): alpha² = (G · Material::roughness)⁴ + B's r⁴
};

/// A substance as the table lists it. `f0` is linear Rec.709 reflectance at normal incidence in air.
struct Substance {
  std::string_view name;
  bool conductor = false;
  float ior = 0;          ///< dielectrics: index of refraction at 589 nm; 0 for conductors
  glm::vec3 f0{0};        ///< conductors: albedo of map A; dielectrics: grey ((ior-1)/(ior+1))^2
  glm::vec3 eta{0};       ///< conductors: effective index of refraction of red, green and blue for the exact conductor Fresnel equation; 0 for dielectrics
  glm::vec3 k{0};         ///< conductors: extinction, from ((eta-1)^2 + k^2)/((eta+1)^2 + k^2) = f0 (held at 0.999); 0 for dielectrics
  std::string_view source;  ///< where the number comes from
};

/// The library of named substances, sorted by name.
BURNISH_API std::span<const Substance> substances();
/// Case-insensitive, '-', '_' and ' ' alike. nullptr when unknown.
BURNISH_API const Substance* findSubstance(std::string_view name);

/// The substance code of map A's alpha, s in [0,1] (docs/shading.md, section 1):
/// s <= 0.4 dielectric, F0 = (0.5 - 0.9 s)^2; s > 0.4 conductor of metalness m = (s - 0.4)/0.6, F0 = mix(0.0196, albedo, m), diffuse = albedo (1-m).
struct DecodedSubstance {
  glm::vec3 f0{0.04f};
  glm::vec3 diffuse{0};
};
BURNISH_API DecodedSubstance decodeSubstance(float code, glm::vec3 albedo);
/// Dielectric F0 (clamped into 0.0196..0.25) to code.
BURNISH_API float encodeDielectric(float f0);
/// Metalness m in [0.01, 1] to code 0.4 + 0.6 m; under 0.01 plain plastic (F0 0.04), code 1/3, so that glTF's F0 errs by at most 0.0202.
BURNISH_API float encodeMetalness(float m);
/// ((eta-1)/(eta+1))^2
[[nodiscard]] constexpr float f0FromIor(float eta) { return ((eta - 1) / (eta + 1)) * ((eta - 1) / (eta + 1)); }

}  // namespace burnish
