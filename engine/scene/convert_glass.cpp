// Glass: KHR_materials_transmission, KHR_materials_volume and the index of KHR_materials_ior.
#include <fmt/format.h>

#include "material/pixels.h"
#include "scene/convert_material.h"

namespace burnish::scene {

/// The mean of a channel: glass has one transmission and one thickness a material. 1 without a picture; what varies is reported.
float MaterialConverter::meanOf(const asset::TextureRef& texture, int channel, const char* what) {
  const Slot slot = pictures_.slot(texture);
  if (!slot) return 1;
  const Image& image = pictures_.rgba(slot);
  const float mean = material::meanChannel(image, channel, false);
  if (!material::constantChannel(image, channel))
    warn(fmt::format("{} ({}) varies: its mean, {:.3f}, is used for the whole material", what, pictures_.name(slot), mean));
  return mean;
}

void MaterialConverter::glass(const asset::Material& in, Material& out) {
  float transmission = checked(in.transmission, 0, 1, 0, "transmissionFactor");
  if (transmission == 0) return;
  if (out.unlit) return warn("transmission is left out: KHR_materials_unlit leaves nothing for it to say");
  transmission *= meanOf(in.transmissionTexture, 0, "transmissionTexture");
  if (transmission == 0) return;
  out.transmission = transmission;
  out.ior = in.substance && !in.substance->conductor ? in.substance->ior : in.ior == 0 ? 0 : checked(in.ior, 1, 100, 1.5f, "ior");
  if (in.specular != 1 || in.specularColor != glm::vec3(1) || in.specularTexture || in.specularColorTexture)
    warn("KHR_materials_specular has no say on glass: its index of refraction gives what it reflects");
  out.thickness = checked(in.thickness, 0, 1e9f, 0, "thicknessFactor");
  if (out.thickness > 0) out.thickness *= meanOf(in.thicknessTexture, 1, "thicknessTexture");
  out.attenuationColor = checked(in.attenuationColor, 1, "attenuationColor");
  out.attenuationDistance = checked(in.attenuationDistance, 0, 1e30f, 0, "attenuationDistance");
}

}  // namespace burnish::scene
