// The specular workflows of glTF: KHR_materials_ior, KHR_materials_specular and KHR_materials_pbrSpecularGlossiness.
#include <fmt/format.h>

#include <cmath>

#include "material/pixels.h"
#include "scene/convert_material.h"

namespace burnish::scene {

// KHR_materials_specular: dielectric F0 = min(((ior - 1) / (ior + 1))² · specularColor, 1) · specular. An ior of 0
// means F0 = 1 before the colour.
MaterialConverter::Dielectric MaterialConverter::dielectricOf(const asset::Material& in) {
  const float ior = in.substance && !in.substance->conductor ? in.substance->ior
                    : in.ior == 0                            ? 0
                                                             : checked(in.ior, 1, 100, 1.5f, "ior");
  const glm::vec3 color = checked(in.specularColor, 1e6f, "specularColorFactor");
  const float strength = checked(in.specular, 0, 1, 1, "specularFactor");
  return {glm::min(f0FromIor(ior) * color, glm::vec3(1)) * strength, pictures_.slot(in.specularTexture),
          pictures_.slot(in.specularColorTexture)};
}

float dielectricError(const glm::vec3& f0) {
  const float shown = std::clamp((f0.x + f0.y + f0.z) / 3, material::kWaterF0, material::kGemF0);
  return std::max({std::abs(f0.x - shown), std::abs(f0.y - shown), std::abs(f0.z - shown)});
}

const char* whyNoDielectric(const glm::vec3& f0) {
  if (dielectricError(f0) < 0.002f) return nullptr;
  const float mean = (f0.x + f0.y + f0.z) / 3;
  if (mean < material::kWaterF0)
    return "its dielectric F0 is under water's 0.0196, the least that a surface in air has";
  if (mean > material::kGemF0) return "its dielectric F0 is above 0.25, the most that a dielectric can have here";
  return "its dielectric F0 is coloured, which a dielectric cannot be here";
}

/// `slot` itself when it can be read together with `partner`; else its mean goes into `factor` (a, rgb) and the result
/// is empty.
Slot MaterialConverter::compatibleOrMean(const Slot& slot, const Slot& partner, const char* what, glm::vec4& factor,
                                         bool srgb) {
  if (!slot || slot.compatible(partner)) return slot;
  const Image& image = pictures_.rgba(slot);
  factor = {material::meanChannel(image, 0, srgb), material::meanChannel(image, 1, srgb),
            material::meanChannel(image, 2, srgb), material::meanChannel(image, 3, false)};
  warn(
      fmt::format("{} ({}) is read with another uv set, transform or sampler than its partner: its mean ({:.3f}, "
                  "{:.3f}, {:.3f}, {:.3f}) is used",
                  what, pictures_.name(slot), factor.x, factor.y, factor.z, factor.w));
  return {};
}

void MaterialConverter::specularGlossiness(const asset::Material& in, Material& out) {
  const glm::vec3 diffuse = checked(glm::vec3(in.diffuse), 1, "diffuseFactor");
  glm::vec3 specular = checked(in.specularF0, 1, "specularFactor");
  float glossiness = checked(in.glossiness, 0, 1, 1, "glossinessFactor");
  const Slot base = pictures_.slot(in.diffuseTexture), normal = normalSlot(in, out);
  Slot both = pictures_.slot(in.specularGlossinessTexture);
  if (both && ((base && !both.compatible(base)) || (normal && !both.compatible(normal)))) {
    glm::vec4 mean(1);
    both =
        compatibleOrMean(both, base && !both.compatible(base) ? base : normal, "specularGlossinessTexture", mean, true);
    specular *= glm::vec3(mean);
    glossiness *= mean.w;
  }
  if (!base && !both) {
    ConversionError error;
    const material::CodedTexel texel = material::nearestTexel(material::fromSpecular(diffuse, specular), error);
    out.albedo = texel.albedo;
    out.substance = float(texel.code) / 255;
    reportError(error, "specular-glossiness");
  } else {
    const Slot& lead = base ? base : both;
    const std::string key = fmt::format("S {} {} {} {} {} {} {} {} {}", base.picture, both.picture, diffuse.x,
                                        diffuse.y, diffuse.z, specular.x, specular.y, specular.z, keyOf(lead.sampler));
    const Shared& made = shared(key, pictures_.name(base) + " + " + pictures_.name(both), MapKind::AlbedoSubstance,
                                lead.sampler, [&](ConversionError& error) {
                                  const glm::ivec2 size = pictures_.commonSize({&base, &both});
                                  return material::mergeSpecular({pictures_.sized(base, size, true),
                                                                  pictures_.sized(both, size, true), diffuse, specular},
                                                                 size.x, size.y, error);
                                });
    out.mapA = made.texture;
    out.uvA = lead.mapping;
    reportError(made.error, "specular-glossiness");
  }
  const auto gloss = both ? material::constantChannel(pictures_.rgba(both), 3) : std::optional<std::uint8_t>(255);
  if (gloss)
    mapB(out, normal, in.normalTexture.strength, Slot{}, 3, false, 1 - glossiness * float(*gloss) / 255);
  else
    mapB(out, normal, in.normalTexture.strength, both, 3, true, glossiness);
}

}  // namespace burnish::scene
