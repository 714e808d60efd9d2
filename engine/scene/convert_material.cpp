#include "scene/convert_material.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "material/pixels.h"

namespace burnish::scene {
namespace {

/// A constant of a slot's channel where it has one: 1 without a picture, else the value that all its pixels have.
std::optional<float> constantOf(PictureStore& pictures, const Slot& slot, int channel) {
  if (!slot) return 1.0f;
  const auto byte = material::constantChannel(pictures.rgba(slot), channel);
  return byte ? std::optional<float>(float(*byte) / 255) : std::nullopt;
}

}  // namespace

MaterialConverter::Converted MaterialConverter::convert(int index, bool vertexAlpha) {
  static const asset::Material kDefault{.name = "default"};
  const asset::Material& in =
      index >= 0 && std::size_t(index) < asset_.materials.size() ? asset_.materials[std::size_t(index)] : kDefault;
  place_ = in.name.empty() ? fmt::format("material {}", index) : fmt::format("material \"{}\"", in.name);
  Material out;
  out.name = in.name;
  out.twoSided = in.doubleSided;
  out.unlit = in.unlit;
  if (in.specularGlossiness && !in.unlit)
    specularGlossiness(in, out);
  else
    metalRough(in, out);
  mapC(in, out, pictures_.slot(in.specularGlossiness && !in.unlit ? in.diffuseTexture : in.baseColorTexture),
       vertexAlpha);
  emission(in, out);
  anisotropy(in, out);
  if (!out.unlit) out.diffuseRoughness = checked(in.diffuseRoughness, 0, 1, 0, "diffuseRoughness");
  glass(in, out);
  const Slot normal = normalSlot(in, out);
  std::optional<UvMapping> tangents;
  if (normal || out.anisotropy > 0) tangents = normal ? normal.mapping : UvMapping{};
  return {scene_.materials.add(std::move(out)), tangents, bool(normal)};
}

/// Unlit surfaces have no use for a normal map; neither has one whose scale is 0.
Slot MaterialConverter::normalSlot(const asset::Material& in, const Material& out) const {
  return out.unlit || in.normalTexture.strength == 0 ? Slot{} : pictures_.slot(in.normalTexture);
}

void MaterialConverter::metalRough(const asset::Material& in, Material& out) {
  const Substance* named = out.unlit ? nullptr : in.substance;
  out.albedo = checked(glm::vec3(in.baseColor), 1, "baseColorFactor");
  const float metallic = named ? float(named->conductor) : checked(in.metallic, 0, 1, 1, "metallicFactor"),
              roughness = checked(in.roughness, 0, 1, 1, "roughnessFactor");
  const Slot base = pictures_.slot(in.baseColorTexture), normal = normalSlot(in, out);
  const Slot both = out.unlit ? Slot{} : pictures_.slot(in.metallicRoughnessTexture);
  if (named && named->conductor) {
    if (!base) out.albedo = named->f0;
    out.conductorEta = named->eta;
    out.conductorK = named->k;
  }
  const std::optional<float> metalConstant = named || metallic == 0 ? metallic : constantOf(pictures_, both, 2);
  const std::optional<float> roughConstant = roughness == 0 ? 0.0f : constantOf(pictures_, both, 1);
  if ((!metalConstant && base && !base.compatible(both)) || (!roughConstant && normal && !normal.compatible(both))) {
    keepApart(in, out, base, normal, both);
    out.metalness = metallic;
    out.roughness = roughness;
    return;
  }
  mapA(in, out, base, metalConstant ? Slot{} : both,
       metalConstant ? std::optional<float>(out.unlit ? 0 : metallic * *metalConstant) : std::nullopt);
  mapB(out, normal, in.normalTexture.strength, roughConstant ? Slot{} : both, 1, false,
       roughConstant ? roughness * *roughConstant : roughness);
}

// The pictures cannot be read with one fetch: map A and B are made without metal-roughness, which becomes a texture of
// its own.
void MaterialConverter::keepApart(const asset::Material& in, Material& out, const Slot& base, const Slot& normal,
                                  const Slot& metalRough) {
  warn(
      fmt::format("metal-roughness ({}) is read with another uv set, transform or sampler than base colour or normal "
                  "map: it is kept as a texture of its own (slower)",
                  pictures_.name(metalRough)));
  mapA(in, out, base, Slot{}, 0.0f);
  mapB(out, normal, in.normalTexture.strength, Slot{}, 1, false,
       0);                          // alpha 0: its mips hold the normals' spread alone
  const bool named = in.substance;  // the substance decides the metalness, not the picture
  out.metalRoughMap = shared(fmt::format("MR {} {} {}", metalRough.picture, named, keyOf(metalRough.sampler)),
                             pictures_.name(metalRough), MapKind::MetalRough, metalRough.sampler,
                             [&](ConversionError&) {
                               Image image = pictures_.rgba(metalRough);
                               if (named)
                                 for (std::size_t i = 0; i < image.pixelCount(); ++i) image.u8()[4 * i + 2] = 255;
                               return image;
                             })
                          .texture;
  out.uvMetalRough = metalRough.mapping;
}

// Map A, or the substance code alone when nothing varies. `metalness`: the constant, empty when it comes from
// metalRough's B.
void MaterialConverter::mapA(const asset::Material& in, Material& out, const Slot& base, const Slot& metalRough,
                             std::optional<float> metalness) {
  Dielectric dielectric = metalness && *metalness == 1 ? Dielectric{} : dielectricOf(in);
  const Slot lead = base                  ? base
                    : metalRough          ? metalRough
                    : dielectric.strength ? dielectric.strength
                                          : dielectric.color;
  glm::vec4 strength(1), color(1);
  dielectric.strength = compatibleOrMean(dielectric.strength, lead, "specularTexture", strength, false);
  dielectric.color = compatibleOrMean(dielectric.color, lead, "specularColorTexture", color, true);
  dielectric.f0 *= glm::vec3(color) * strength.w;
  const float f0 = (dielectric.f0.x + dielectric.f0.y + dielectric.f0.z) / 3;
  if (!lead) return substance(out, *metalness, dielectric.f0);
  if (const char* why = dielectric.strength || dielectric.color ? nullptr : whyNoDielectric(dielectric.f0))
    reportError({dielectricError(dielectric.f0), 0}, why);
  const float factor = metalness ? *metalness : in.metallic;
  const std::string key = fmt::format("A {} {} {} {} {} {} {} {} {}", base.picture, metalRough.picture, factor,
                                      dielectric.f0.x, dielectric.f0.y, dielectric.f0.z, dielectric.strength.picture,
                                      dielectric.color.picture, keyOf(lead.sampler));
  const Shared& made = shared(
      key, pictures_.name(base) + " + " + pictures_.name(metalRough), MapKind::AlbedoSubstance, lead.sampler,
      [&](ConversionError& error) {
        const glm::ivec2 size = pictures_.commonSize({&base, &metalRough, &dielectric.strength, &dielectric.color});
        Image codes;
        if (dielectric.strength || dielectric.color)
          codes = material::dielectricCodes(dielectric.f0, pictures_.sized(dielectric.strength, size, false),
                                            pictures_.sized(dielectric.color, size, true), size.x, size.y, error);
        const Image* metal = pictures_.sized(metalRough, size, false);
        return material::mergeAlbedoSubstance(
            {pictures_.sized(base, size, true), metal, factor, f0, codes.empty() ? nullptr : &codes}, size.x, size.y,
            error);
      });
  out.mapA = made.texture;
  out.uvA = lead.mapping;
  reportError(made.error, "partly metallic texels or coloured specular");
}

// A material without pictures for map A. Dielectrics that the codec lacks may lie nearer to one of its conductors.
void MaterialConverter::substance(Material& out, float metalness, const glm::vec3& f0) {
  const float mean = (f0.x + f0.y + f0.z) / 3;
  if (metalness >= material::kMetalnessStart) {
    out.substance = encodeMetalness(metalness);
    return reportError(material::metalnessError(metalness, mean), "partly metallic");
  }
  out.substance = encodeDielectric(mean);
  const char* why = whyNoDielectric(f0);
  if (!why) return reportError(material::metalnessError(metalness, mean), "partly metallic");
  ConversionError error;
  const material::CodedTexel texel = material::nearestTexel({f0, out.albedo}, error);
  if (material::codeTable()[texel.code].metalness == 0) return reportError({dielectricError(f0), 0}, why);
  out.substance = float(texel.code) / 255;
  out.albedo = texel.albedo;
  reportError(error, why);
}

// Map B, or the roughness alone when nothing varies. With a normal map the factor is baked: its mips widen the lobe,
// and a factor on top would scale that too. Without one it stays a multiplier, which is exact (alpha² of every texel
// scales alike), and materials that differ in it share the map.
void MaterialConverter::mapB(Material& out, const Slot& normal, float normalScale, const Slot& rough, int channel,
                             bool gloss, float factor) {
  out.roughness = normal ? 1 : factor;
  if (!normal && !rough) return;
  const Slot& lead = normal ? normal : rough;
  const float baked = normal || gloss ? factor : 1;
  if (gloss) out.roughness = 1;
  const float scale = checked(normalScale, -64, 64, 1, "normalTexture.scale");
  const std::string key = fmt::format("B {} {} {} {} {} {} {}", normal.picture, normal ? scale : 1, rough.picture,
                                      channel, gloss, baked, keyOf(lead.sampler));
  out.mapB = shared(key, pictures_.name(normal) + " + " + pictures_.name(rough), MapKind::NormalRoughness, lead.sampler,
                    [&](ConversionError&) {
                      std::array<std::uint8_t, 256> table;  // glossiness: roughness = 1 - factor · value
                      for (int i = 0; i < 256; ++i) {
                        const float r = gloss ? 1 - baked * float(i) / 255 : baked * float(i) / 255;
                        table[std::size_t(i)] = std::uint8_t(std::lround(r * 255));
                      }
                      const glm::ivec2 size = pictures_.commonSize({&normal, &rough});
                      return material::mergeNormalRoughness(pictures_.sized(normal, size, false), scale,
                                                            pictures_.sized(rough, size, false), channel, table, size.x,
                                                            size.y);
                    })
                 .texture;
  out.uvB = lead.mapping;
}

// Occlusion and opacity: map C, which has one mapping. Opacity wins where they differ, for a hole in a leaf is seen
// sooner than its ambient shadow.
void MaterialConverter::mapC(const asset::Material& in, Material& out, const Slot& base, bool vertexAlpha) {
  const float factor =
      checked(in.specularGlossiness && !in.unlit ? in.diffuse.a : in.baseColor.a, 0, 1, 1, "base colour alpha");
  const bool asksOpacity = in.alphaMode != asset::AlphaMode::Opaque;
  const int channels = pictures_.channels(base);
  const bool inTexture = asksOpacity && (channels == 2 || channels == 4) && constantOf(pictures_, base, 3) != 1.0f;
  out.alphaCutoff =
      in.alphaMode == asset::AlphaMode::Mask ? checked(in.alphaCutoff, 0, 1e6f, 0.5f, "alphaCutoff") : 0.5f;
  out.opacity = asksOpacity ? factor : 1;
  out.blend = in.alphaMode == asset::AlphaMode::Blend && (inTexture || vertexAlpha || factor < 1);
  out.alphaTest = in.alphaMode == asset::AlphaMode::Mask && (inTexture || vertexAlpha || factor < out.alphaCutoff);

  Slot occlusion = out.unlit || in.occlusionTexture.strength == 0 ? Slot{} : pictures_.slot(in.occlusionTexture);
  if (occlusion && constantOf(pictures_, occlusion, 0) == 1.0f) occlusion = {};
  const Slot alpha = inTexture ? base : Slot{};
  if (occlusion && alpha && !occlusion.compatible(alpha)) {
    warn(fmt::format("occlusion ({}) is read with another uv set, transform or sampler than opacity: it is left out",
                     pictures_.name(occlusion)));
    occlusion = {};
  }
  if (!occlusion && !alpha) return;
  const Slot& lead = alpha ? alpha : occlusion;
  out.occlusionStrength = occlusion ? checked(in.occlusionTexture.strength, 0, 1, 1, "occlusionTexture.strength") : 0;
  out.mapC = shared(fmt::format("C {} {} {}", occlusion.picture, alpha.picture, keyOf(lead.sampler)),
                    pictures_.name(occlusion) + " + " + pictures_.name(alpha), MapKind::Occlusion, lead.sampler,
                    [&](ConversionError&) {
                      const glm::ivec2 size = pictures_.commonSize({&occlusion, &alpha});
                      return material::mergeOcclusion(pictures_.sized(occlusion, size, false),
                                                      pictures_.sized(alpha, size, true), size.x, size.y);
                    })
                 .texture;
  out.uvC = lead.mapping;
}

void MaterialConverter::emission(const asset::Material& in, Material& out) {
  out.emission = checked(in.emissive, 1e9f, "emissive");
  const Slot slot = pictures_.slot(in.emissiveTexture);
  if (!slot || out.emission == glm::vec3(0)) return;
  out.emissiveMap = shared(fmt::format("E {} {}", slot.picture, keyOf(slot.sampler)), pictures_.name(slot),
                           MapKind::Emissive, slot.sampler, [&](ConversionError&) { return pictures_.rgba(slot); })
                        .texture;
  out.uvEmissive = slot.mapping;
}

void MaterialConverter::anisotropy(const asset::Material& in, Material& out) {
  constexpr float kMost = std::numeric_limits<float>::max();
  out.anisotropy = out.unlit ? 0 : checked(in.anisotropy, 0, 1, 0, "anisotropyStrength");
  if (out.anisotropy == 0) return;
  out.anisotropyRotation = checked(in.anisotropyRotation, -kMost, kMost, 0, "anisotropyRotation");
}

const MaterialConverter::Shared& MaterialConverter::shared(std::string key, std::string name, MapKind kind,
                                                           const Sampler& sampler,
                                                           const std::function<Image(ConversionError&)>& make) {
  const auto [at, isNew] = shared_.try_emplace(std::move(key));
  if (!isNew) return at->second;
  Texture texture{std::move(name), kind, sampler, {}};
  texture.image = make(at->second.error);
  at->second.texture = scene_.textures.add(std::move(texture));
  return at->second;
}

float MaterialConverter::checked(float value, float low, float high, float fallback, const char* what) {
  if (!std::isfinite(value)) {
    warn(fmt::format("{} is not finite: {} is used", what, fallback));
    return fallback;
  }
  if (value >= low && value <= high) return value;
  warn(fmt::format("{} is {}: it was brought into {}..{}", what, value, low, high));
  return std::clamp(value, low, high);
}

glm::vec3 MaterialConverter::checked(const glm::vec3& value, float high, const char* what) {
  return {checked(value.x, 0, high, 0, what), checked(value.y, 0, high, 0, what), checked(value.z, 0, high, 0, what)};
}

void MaterialConverter::reportError(const ConversionError& error, const char* why) {
  if (error.f0 < 0.002f && error.diffuse < 0.004f) return;  // within what 8 bits round
  std::string text = fmt::format("{}: reflectance is off by up to {:.4f}", why, error.f0);
  if (error.diffuse >= 0.00005f) text += fmt::format(", diffuse by up to {:.4f}", error.diffuse);
  warn(std::move(text));
}

}  // namespace burnish::scene
