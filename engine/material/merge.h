// Building the maps of docs/shading.md, section 1, from the pictures that glTF materials bring. All pictures are RGBA8
// of one size (material/pixels.h).
#pragma once
#include <burnish/image.h>
#include <burnish/material.h>

#include <array>

#include "material/codec.h"

namespace burnish::material {

/// How far a conversion is off, the largest difference in any channel of any texel.
struct ConversionError {
  float f0 = 0, diffuse = 0;
  void widen(const ConversionError& other) {
    f0 = std::max(f0, other.f0);
    diffuse = std::max(diffuse, other.diffuse);
  }
};

/// The error of showing glTF's F0 = mix(dielectricF0, base, m), diffuse = base (1 - m) with the codec, worst over all
/// base colours, 8-bit rounding aside.
ConversionError metalnessError(float m, float dielectricF0 = kPlasticF0);

/// Map A of metallic-roughness. A null picture stands for white (base) or 1 (metal).
struct AlbedoInput {
  const Image* base = nullptr;             ///< RGB sRGB
  const Image* metal = nullptr;            ///< B metalness, linear
  float metallic = 1;                      ///< factor on it
  float dielectricF0 = kPlasticF0;         ///< of texels that are no metal
  const Image* dielectricCodes = nullptr;  ///< R: code of texels that are no metal, in place of dielectricF0
};
/// `error` is widened by what the picture's metalness values do not fit.
Image mergeAlbedoSubstance(const AlbedoInput& in, int width, int height, ConversionError& error);

/// Map A of specular-glossiness: KHR_materials_pbrSpecularGlossiness, factors included. A null picture stands for
/// white.
struct SpecularInput {
  const Image* diffuse = nullptr;   ///< RGB sRGB
  const Image* specular = nullptr;  ///< RGB sRGB
  glm::vec3 diffuseFactor{1}, specularFactor{1};
};
Image mergeSpecular(const SpecularInput& in, int width, int height, ConversionError& error);

/// The texel that comes nearest to a reflectance, dielectric or conductor, and how far off it is.
CodedTexel nearestTexel(const Reflectance& wanted, ConversionError& error);
/// Diffuse and F0 of specular-glossiness: c_diff = diffuse (1 - max(specular)).
Reflectance fromSpecular(const glm::vec3& diffuse, const glm::vec3& specular);

/// Codes of dielectrics whose F0 is f0 (rgb) × the strength's alpha × the colour's RGB (sRGB): KHR_materials_specular's
/// textures. In R of an RGBA8 image. `error` holds what grey F0 of 0.0196 to 0.25 cannot show.
Image dielectricCodes(const glm::vec3& f0, const Image* strength, const Image* color, int width, int height,
                      ConversionError& error);

/// Map B. `normal` null: flat. `normalScale` as glTF's. `roughness` is looked up as table[channel value], table[255]
/// without a picture.
Image mergeNormalRoughness(const Image* normal, float normalScale, const Image* roughness, int channel,
                           const std::array<std::uint8_t, 256>& table, int width, int height);

/// Map C: R from occlusion's R (255 without), and, with `alpha`, G from its alpha. One channel without alpha, else two.
Image mergeOcclusion(const Image* occlusion, const Image* alpha, int width, int height);

}  // namespace burnish::material
