// Images, samplers, textures and materials of a glTF file, with the material extensions.
#include <fmt/format.h>

#include <cmath>

#include "asset/document.h"
#include "material/library.h"

namespace burnish::asset {
namespace {

void parseImage(const At& at, Check& check, Document& doc) {
  PictureSource& p = doc.pictures.emplace_back();
  check.known(at, {"uri", "mimeType", "bufferView"});
  p.uri = check.string(at, "uri");
  p.view = check.reference(at, "bufferView", Table::BufferViews);
  const std::string* mime = check.string(at, "mimeType");
  if (!check.ok()) return;
  if (bool(p.uri) == (p.view >= 0)) check.fail(at, "exactly one of uri and bufferView must be given");
  if (p.view >= 0 && !mime) check.fail(at.path() + "/bufferView", "a picture in a buffer view needs a mimeType");
  p.name = at.path();
  if (p.uri && !p.uri->starts_with("data:")) p.name += fmt::format(" ({})", p.uri->substr(0, 200));
}

Wrap parseWrap(const At& at, const char* key, Check& check) {
  const std::uint64_t v = check.integer(at, key, 10497);
  if (v == 33071) return Wrap::ClampToEdge;
  if (v == 33648) return Wrap::MirroredRepeat;
  if (v != 10497) check.warn(at.path() + "/" + key, fmt::format("unknown wrap mode {} is read as REPEAT", v));
  return Wrap::Repeat;
}

void parseSampler(const At& at, Check& check, Document& doc) {
  Sampler& s = doc.samplers.emplace_back();
  check.known(at, {"magFilter", "minFilter", "wrapS", "wrapT"});
  s.wrapS = parseWrap(at, "wrapS", check);
  s.wrapT = parseWrap(at, "wrapT", check);
  const std::uint64_t mag = check.integer(at, "magFilter", 9729), min = check.integer(at, "minFilter", 9987);
  if (mag != 9728 && mag != 9729)
    check.warn(at.path() + "/magFilter", fmt::format("unknown filter {} is read as LINEAR", mag));
  s.magnifyLinear = mag != 9728;
  s.minifyLinear = min != 9728 && min != 9984 && min != 9986;
  s.mips = min != 9728 && min != 9729;
  s.mipLinear = min != 9984 && min != 9985;
  if (min != 9728 && min != 9729 && (min < 9984 || min > 9987))
    check.warn(at.path() + "/minFilter", fmt::format("unknown filter {} is read as LINEAR_MIPMAP_LINEAR", min));
}

void parseTexture(const At& at, Check& check, Document& doc) {
  Texture& t = doc.textures.emplace_back();
  check.known(at, {"sampler", "source"});
  t.sampler = check.reference(at, "sampler", Table::Samplers);
  t.picture = check.reference(at, "source", Table::Images);
}

TextureRef parseTextureRef(const At& parent, const char* key, Check& check, const char* strengthKey = nullptr) {
  TextureRef ref;
  check.withObject(parent, key, [&](const At& at) {
    check.known(at, {"index", "texCoord", strengthKey ? strengthKey : "index"});
    ref.texture = check.reference(at, "index", Table::Textures, Need::Required);
    std::uint64_t set = check.integer(at, "texCoord", 0);
    if (strengthKey)
      ref.strength =
          float(check.number(at, strengthKey, 1, std::string_view(strengthKey) == "strength" ? kUnit : Range{}));
    check.withExtension(at, "KHR_texture_transform", [&](const At& t) {
      check.known(t, {"offset", "rotation", "scale", "texCoord"});
      std::array<double, 2> offset{0, 0}, scale{1, 1};
      check.numbers(t, "offset", offset);
      check.numbers(t, "scale", scale);
      ref.offset = {float(offset[0]), float(offset[1])};
      ref.scale = {float(scale[0]), float(scale[1])};
      ref.rotation = float(check.number(t, "rotation", 0));
      set = check.integer(t, "texCoord", set);
    });
    if (check.ok() && set > 1) {
      check.warn(at.path(),
                 fmt::format("texture coordinates TEXCOORD_{} are not supported: the texture is left out", set));
      ref.texture = -1;
    }
    ref.uvSet = set == 1;
  });
  return ref;
}

glm::vec3 vec3Of(const At& at, const char* key, Check& check, glm::vec3 fallback, const Range& range = kUnit) {
  std::array<double, 3> v{};
  return check.numbers(at, key, v, range) ? glm::vec3(v[0], v[1], v[2]) : fallback;
}
glm::vec4 vec4Of(const At& at, const char* key, Check& check) {
  std::array<double, 4> v{};
  return check.numbers(at, key, v, kUnit) ? glm::vec4(v[0], v[1], v[2], v[3]) : glm::vec4(1);
}

void parseMetallicRoughness(const At& at, Check& check, Material& m) {
  check.known(at,
              {"baseColorFactor", "baseColorTexture", "metallicFactor", "roughnessFactor", "metallicRoughnessTexture"});
  m.baseColor = vec4Of(at, "baseColorFactor", check);
  m.metallic = float(check.number(at, "metallicFactor", 1, kUnit));
  m.roughness = float(check.number(at, "roughnessFactor", 1, kUnit));
  m.baseColorTexture = parseTextureRef(at, "baseColorTexture", check);
  m.metallicRoughnessTexture = parseTextureRef(at, "metallicRoughnessTexture", check);
}

void parseSpecularGlossiness(const At& at, Check& check, Material& m) {
  check.known(at,
              {"diffuseFactor", "diffuseTexture", "specularFactor", "glossinessFactor", "specularGlossinessTexture"});
  m.specularGlossiness = true;
  m.diffuse = vec4Of(at, "diffuseFactor", check);
  m.specularF0 = vec3Of(at, "specularFactor", check, glm::vec3(1));
  m.glossiness = float(check.number(at, "glossinessFactor", 1, kUnit));
  m.diffuseTexture = parseTextureRef(at, "diffuseTexture", check);
  m.specularGlossinessTexture = parseTextureRef(at, "specularGlossinessTexture", check);
}

void parseMaterialExtensions(const At& at, Check& check, Material& m) {
  check.withExtension(at, "KHR_materials_emissive_strength", [&](const At& e) {
    check.known(e, {"emissiveStrength"});
    m.emissive *= float(check.number(e, "emissiveStrength", 1, kNotNegative));
    for (int i = 0; i < 3; ++i)
      if (!std::isfinite(m.emissive[i])) check.fail(e, "the emission is not finite");
  });
  check.withExtension(at, "KHR_materials_unlit", [&](const At&) { m.unlit = true; });
  check.withExtension(at, "KHR_materials_ior", [&](const At& e) {
    check.known(e, {"ior"});
    m.ior = float(check.number(e, "ior", 1.5, kNotNegative));
    if (m.ior != 0 && m.ior < 1)
      check.fail(e.path() + "/ior", fmt::format("{} is out of range (0, or at least 1)", m.ior));
  });
  check.withExtension(at, "KHR_materials_specular", [&](const At& e) {
    check.known(e, {"specularFactor", "specularTexture", "specularColorFactor", "specularColorTexture"});
    m.specular = float(check.number(e, "specularFactor", 1, kUnit));
    m.specularColor = vec3Of(e, "specularColorFactor", check, glm::vec3(1), kNotNegative);
    m.specularTexture = parseTextureRef(e, "specularTexture", check);
    m.specularColorTexture = parseTextureRef(e, "specularColorTexture", check);
  });
  check.withExtension(at, "KHR_materials_pbrSpecularGlossiness", [&](const At& e) {
    parseSpecularGlossiness(e, check, m);
    m.baseColorTexture =
        m.metallicRoughnessTexture = {};  // the fallback for readers without the extension: not worth decoding
  });
  check.withExtension(at, "KHR_materials_transmission", [&](const At& e) {
    check.known(e, {"transmissionFactor", "transmissionTexture"});
    m.transmission = float(check.number(e, "transmissionFactor", 0, kUnit));
    m.transmissionTexture = parseTextureRef(e, "transmissionTexture", check);
  });
  check.withExtension(at, "KHR_materials_volume", [&](const At& e) {
    check.known(e, {"thicknessFactor", "thicknessTexture", "attenuationDistance", "attenuationColor"});
    m.thickness = float(check.number(e, "thicknessFactor", 0, kNotNegative));
    m.thicknessTexture = parseTextureRef(e, "thicknessTexture", check);
    m.attenuationColor = vec3Of(e, "attenuationColor", check, glm::vec3(1));
    m.attenuationDistance = float(check.number(e, "attenuationDistance", 0, kNotNegative));
  });
  check.withExtension(at, "KHR_materials_anisotropy", [&](const At& e) {
    check.known(e, {"anisotropyStrength", "anisotropyRotation", "anisotropyTexture"});
    m.anisotropy = float(check.number(e, "anisotropyStrength", 0, kUnit));
    m.anisotropyRotation = float(check.number(e, "anisotropyRotation", 0));
    if (parseTextureRef(e, "anisotropyTexture", check))
      check.warn(e.path() + "/anisotropyTexture",
                 "textures of anisotropy are not supported: strength and rotation are those of the whole material");
  });
}

/// `extras.burnish.substance`, a name of the library. A fault in it is a warning, for extras are free-form.
void parseSubstance(const At& at, Check& check, Material& m) {
  check.withOwnExtras(at, [&](const At& ours) {
    const auto name = ours->find("substance");
    if (name == ours->end()) return;
    const std::string path = At(ours, "substance", *name).path();
    if (!name->is_string())
      return check.warn(path,
                        fmt::format("{} where the name of a substance is expected: it is left out", name->type_name()));
    const std::string& text = name->get_ref<const std::string&>();
    const Substance* found = findSubstance(text);
    const std::string_view near = found ? std::string_view() : material::nearestSubstance(text);
    if (!found)
      check.warn(path, fmt::format("unknown substance '{}' is left out{}", text.substr(0, 40),
                                   near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near)));
    else if (m.unlit || m.specularGlossiness)
      check.warn(path, fmt::format("the substance is left out: {} leaves nothing for it to say",
                                   m.unlit ? "KHR_materials_unlit" : "KHR_materials_pbrSpecularGlossiness"));
    else
      m.substance = found;
  });
}

/// `extras.burnish.diffuseRoughness`, Oren and Nayar's sigma. A fault in it is a warning too.
void parseDiffuseRoughness(const At& at, Check& check, Material& m) {
  check.withOwnExtras(at, [&](const At& ours) {
    const auto sigma = ours->find("diffuseRoughness");
    if (sigma == ours->end()) return;
    const std::string path = At(ours, "diffuseRoughness", *sigma).path();
    if (!sigma->is_number() || !(sigma->get<double>() >= 0) || !(sigma->get<double>() <= 1))
      return check.warn(path, "a number from 0 to 1 (radians) is expected: it is left out");
    m.diffuseRoughness = sigma->get<float>();
  });
}

void parseMaterial(const At& at, Check& check, Document& doc) {
  Material& m = doc.materials.emplace_back();
  check.known(at, {"pbrMetallicRoughness", "normalTexture", "occlusionTexture", "emissiveTexture", "emissiveFactor",
                   "alphaMode", "alphaCutoff", "doubleSided"});
  if (const std::string* name = check.string(at, "name")) m.name = *name;
  check.withObject(at, "pbrMetallicRoughness", [&](const At& p) { parseMetallicRoughness(p, check, m); });
  m.normalTexture = parseTextureRef(at, "normalTexture", check, "scale");
  m.occlusionTexture = parseTextureRef(at, "occlusionTexture", check, "strength");
  m.emissiveTexture = parseTextureRef(at, "emissiveTexture", check);
  m.emissive = vec3Of(at, "emissiveFactor", check, glm::vec3(0));
  m.alphaCutoff = float(check.number(at, "alphaCutoff", 0.5, kNotNegative));
  m.doubleSided = check.boolean(at, "doubleSided", false);
  if (const std::string* mode = check.string(at, "alphaMode")) {
    if (*mode == "MASK") m.alphaMode = AlphaMode::Mask;
    if (*mode == "BLEND") m.alphaMode = AlphaMode::Blend;
    if (*mode != "OPAQUE" && m.alphaMode == AlphaMode::Opaque)
      check.warn(at.path() + "/alphaMode",
                 fmt::format("unknown alpha mode '{}' is read as OPAQUE", mode->substr(0, 40)));
  }
  parseMaterialExtensions(at, check, m);
  parseSubstance(at, check, m);
  parseDiffuseRoughness(at, check, m);
}

}  // namespace

void parseMaterials(const At& root, Check& check, Document& doc) {
  check.eachObject(root, "images", [&](const At& at, std::size_t) { parseImage(at, check, doc); });
  check.eachObject(root, "samplers", [&](const At& at, std::size_t) { parseSampler(at, check, doc); });
  check.eachObject(root, "textures", [&](const At& at, std::size_t) { parseTexture(at, check, doc); });
  check.eachObject(root, "materials", [&](const At& at, std::size_t) { parseMaterial(at, check, doc); });
}

}  // namespace burnish::asset
