// Materials, their extensions and their pictures.
#include <atomic>
#include <chrono>
#include <thread>

#include "gltf_fixture.h"

using namespace gltf_test;
using burnish::asset::AlphaMode;

namespace {
const Sandbox& box() {
  static const Sandbox sandbox;
  return sandbox;
}
Reading readJson(Json json) {
  json["asset"] = {{"version", "2.0"}};
  return read(box().put("file.gltf", json.dump()));
}
}  // namespace

TEST_CASE("materials and their extensions", "[gltf]") {
  box().put("a.png", kPng);
  const Json transform = {
      {"KHR_texture_transform", {{"offset", {0.5, 1}}, {"scale", {2, 3}}, {"rotation", 0.25}, {"texCoord", 1}}}};
  Json file = {
      {"extensionsUsed",
       {"KHR_texture_transform", "KHR_materials_ior", "KHR_materials_specular", "KHR_materials_emissive_strength",
        "KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness", "KHR_materials_sheen", "EXT_something"}},
      {"images", {{{"uri", "a.png"}}, {{"uri", "a.png"}}}},
      {"samplers", {{{"magFilter", 9728}, {"minFilter", 9985}, {"wrapS", 33071}, {"wrapT", 33648}}}},
      {"textures", {{{"source", 0}, {"sampler", 0}}}}};
  file["materials"] = {
      {{"name", "first"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
         {"metallicFactor", 0.5},
         {"roughnessFactor", 0.25},
         {"baseColorTexture", {{"index", 0}, {"extensions", transform}}}}},
       {"normalTexture", {{"index", 0}, {"scale", 2}}},
       {"occlusionTexture", {{"index", 0}, {"strength", 0.5}}},
       {"emissiveFactor", {1, 0.5, 0}},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.75},
       {"doubleSided", true},
       {"extensions",
        {{"KHR_materials_ior", {{"ior", 1.25}}},
         {"KHR_materials_emissive_strength", {{"emissiveStrength", 10}}},
         {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {1, 2, 3}}}}}}},
      {{"extensions", {{"KHR_materials_unlit", Json::object()}}}},
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
       {"extensions",
        {{"KHR_materials_pbrSpecularGlossiness",
          {{"diffuseFactor", {0.5, 0.5, 0.5, 1}}, {"glossinessFactor", 0.3}, {"specularFactor", {0.1, 0.2, 0.3}}}}}}}};
  const Reading r = readJson(file);
  INFO(r.message());
  REQUIRE(r.asset);
  const auto& m = r.asset->materials[0];
  CHECK(m.baseColor == glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  CHECK((m.metallic == 0.5f && m.roughness == 0.25f && m.doubleSided && !m.unlit));
  CHECK((m.alphaMode == AlphaMode::Mask && m.alphaCutoff == 0.75f));
  CHECK(m.emissive == glm::vec3(10, 5, 0));
  CHECK((m.ior == 1.25f && m.specular == 0.5f && m.specularColor == glm::vec3(1, 2, 3)));
  CHECK((m.normalTexture.strength == 2 && m.occlusionTexture.strength == 0.5f));
  const auto& t = m.baseColorTexture;
  CHECK((t.offset == glm::vec2(0.5, 1) && t.scale == glm::vec2(2, 3) && t.rotation == 0.25f && t.uvSet == 1));
  CHECK(r.asset->materials[1].unlit);
  const auto& sg = r.asset->materials[2];
  CHECK((sg.specularGlossiness && sg.glossiness == 0.3f && sg.specularF0 == glm::vec3(0.1f, 0.2f, 0.3f) &&
         !sg.baseColorTexture));
  const auto& s = r.asset->samplers[0];
  CHECK((!s.magnifyLinear && s.minifyLinear && !s.mipLinear && s.mips));
  CHECK((s.wrapS == burnish::asset::Wrap::ClampToEdge && s.wrapT == burnish::asset::Wrap::MirroredRepeat));
  CHECK(r.decoded == 1);  // used three times, decoded once; the other picture is not used
  CHECK(r.warned("'KHR_materials_sheen'"));
  CHECK(r.warned("'EXT_something'"));
  CHECK(r.report.warnings().size() == 2);

  file["materials"][0]["extensions"]["KHR_materials_ior"]["ior"] = 0.5;
  CHECK(readJson(file).message().find("/materials/0/extensions/KHR_materials_ior/ior") != std::string::npos);
  file["extensionsRequired"] = {"EXT_something"};
  CHECK(readJson(file).message().find("/extensionsRequired/0: the file requires extension 'EXT_something'") !=
        std::string::npos);
}

TEST_CASE("transmission and volume are read with their textures", "[gltf]") {
  box().put("a.png", kPng);
  Json file = {{"extensionsUsed", {"KHR_materials_transmission", "KHR_materials_volume"}},
               {"extensionsRequired", {"KHR_materials_transmission"}},
               {"images", {{{"uri", "a.png"}}}},
               {"textures", {{{"source", 0}}}}};
  Json transmission = {{"transmissionFactor", 0.75}, {"transmissionTexture", {{"index", 0}}}};
  Json volume = {{"thicknessFactor", 0.25}, {"thicknessTexture", {{"index", 0}, {"texCoord", 1}}}, {"attenuationDistance", 2.5}, {"attenuationColor", {0.5, 1, 0.25}}};
  const auto with = [&](const Json& t, const Json& v) {
    file["materials"] = {{{"extensions", {{"KHR_materials_transmission", t}, {"KHR_materials_volume", v}}}}, {{"name", "plain"}}};
    return readJson(file);
  };
  const Reading r = with(transmission, volume);
  INFO(r.message());
  REQUIRE(r.asset);
  CHECK(r.report.empty());
  const auto& m = r.asset->materials[0];
  CHECK((m.transmission == 0.75f && m.thickness == 0.25f && m.attenuationDistance == 2.5f && m.attenuationColor == glm::vec3(0.5f, 1, 0.25f)));
  CHECK((m.transmissionTexture.texture == 0 && m.thicknessTexture.texture == 0 && m.thicknessTexture.uvSet == 1));
  CHECK((r.asset->materials[1].transmission == 0 && r.asset->materials[1].attenuationDistance == 0));
  const auto fault = [&](Json& extension, const char* key, const Json& value) {
    const Json kept = extension;
    extension[key] = value;
    const std::string message = with(transmission, volume).message();
    INFO(message);
    CHECK(message.find(key) != std::string::npos);
    extension = kept;
  };
  fault(transmission, "transmissionFactor", 1.5);
  fault(volume, "thicknessFactor", -1);
  fault(volume, "attenuationDistance", "far");
  fault(volume, "attenuationColor", {1, 2, 3});
}

TEST_CASE("anisotropy is read, its texture is left out", "[gltf]") {
  box().put("a.png", kPng);
  Json file = {{"extensionsUsed", {"KHR_materials_anisotropy"}},
               {"extensionsRequired", {"KHR_materials_anisotropy"}},
               {"images", {{{"uri", "a.png"}}}},
               {"textures", {{{"source", 0}}}},
               {"materials", Json::array()}};
  Json brushed = {{"anisotropyStrength", 0.5}, {"anisotropyRotation", -1.25}, {"anisotropyTexture", {{"index", 0}}}};
  const auto with = [&](const Json& extension) {
    file["materials"] = {{{"extensions", {{"KHR_materials_anisotropy", extension}}}}, {{"name", "plain"}}};
    return readJson(file);
  };
  const Reading r = with(brushed);
  INFO(r.message());
  REQUIRE(r.asset);
  CHECK((r.asset->materials[0].anisotropy == 0.5f && r.asset->materials[0].anisotropyRotation == -1.25f));
  CHECK((r.asset->materials[1].anisotropy == 0 && r.asset->materials[1].anisotropyRotation == 0));
  CHECK(r.warned("/materials/0/extensions/KHR_materials_anisotropy/anisotropyTexture: textures of anisotropy"));
  CHECK(r.report.warnings().size() == 1);
  CHECK(r.decoded == 0);
  const Reading bare = with(Json::object());
  REQUIRE(bare.asset);
  CHECK((bare.asset->materials[0].anisotropy == 0 && bare.report.empty()));

  const auto fault = [&](const char* key, const Json& value, const char* says) {
    Json changed = brushed;
    changed[key] = value;
    const std::string message = with(changed).message();
    INFO(message);
    CHECK(message.find("/materials/0/extensions/KHR_materials_anisotropy/" + std::string(key)) != std::string::npos);
    CHECK(message.find(says) != std::string::npos);
  };
  fault("anisotropyStrength", 1.5, "at most 1");
  fault("anisotropyStrength", -0.5, "at least 0");
  fault("anisotropyStrength", "much", "a number is expected");
  fault("anisotropyRotation", true, "a number is expected");
  fault("anisotropyTexture", 3, "an object is expected");
  fault("anisotropyTexture", {{"index", 7}}, "does not exist");
}

TEST_CASE("a material says its diffuse roughness in its extras", "[gltf]") {
  const auto with = [](const Json& sigma) {
    return readJson({{"materials", {{{"extras", {{"burnish", {{"diffuseRoughness", sigma}}}}}}}}});
  };
  for (const double sigma : {0.0, 0.25, 1.0}) {
    const Reading r = with(sigma);
    INFO(r.message());
    REQUIRE(r.asset);
    CHECK((r.asset->materials[0].diffuseRoughness == float(sigma) && r.report.empty()));
  }
  for (const Json& bad : {Json(-0.1), Json(1.5), Json("rough"), Json(nullptr)}) {
    const Reading r = with(bad);
    INFO(r.message());
    REQUIRE(r.asset);
    CHECK(r.asset->materials[0].diffuseRoughness == 0);
    CHECK(r.warned("/materials/0/extras/burnish/diffuseRoughness: a number from 0 to 1 (radians) is expected: it is left out"));
  }
}

TEST_CASE("a material names its substance in its extras", "[gltf]") {
  Json file = {{"extensionsUsed", {"KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness"}}};
  const auto with = [&](const Json& extras, const Json& extensions = Json::object()) {
    file["materials"] = {{{"extras", extras}, {"extensions", extensions}}};
    return readJson(file);
  };
  const auto named = [&](const Json& name) { return with({{"burnish", {{"substance", name}}}}); };
  for (const char* name : {"gold", "Cubic-Zirconia", "stainless steel"}) {
    const Reading r = named(name);
    INFO(name << ": " << r.message());
    REQUIRE(r.asset);
    CHECK(r.asset->materials[0].substance == burnish::findSubstance(name));
    CHECK(r.report.empty());
  }
  const auto refused = [](const Reading& r, const std::string& says) {
    INFO(r.message());
    REQUIRE(r.asset);
    CHECK(r.asset->materials[0].substance == nullptr);
    CHECK(r.warned("file.gltf: /materials/0/extras/burnish/substance: " + says));
    CHECK(r.report.warnings().size() == 1);
  };
  refused(named("golt"), "unknown substance 'golt' is left out (did you mean 'gold'?)");
  refused(named("unobtainium"), "unknown substance 'unobtainium' is left out");
  refused(named(""), "unknown substance '' is left out");
  refused(named(std::string(100000, 'x')), "unknown substance '" + std::string(40, 'x') + "' is left out");
  refused(named(3), "number where the name of a substance is expected: it is left out");
  refused(named(nullptr), "null where the name of a substance is expected: it is left out");
  refused(named({"gold"}), "array where the name of a substance is expected: it is left out");
  const Json gold = {{"burnish", {{"substance", "gold"}}}};
  refused(with(gold, {{"KHR_materials_unlit", Json::object()}}), "the substance is left out: KHR_materials_unlit");
  refused(with(gold, {{"KHR_materials_pbrSpecularGlossiness", Json::object()}}),
          "the substance is left out: KHR_materials_pbrSpecularGlossiness");

  for (const Json& foreign : {Json("gold"), Json::array(), Json{{"burnish", "gold"}}, Json{{"burnish", Json::object()}},
                              Json{{"substance", "gold"}}}) {
    const Reading r = with(foreign);
    INFO(foreign.dump() << ": " << r.message());
    REQUIRE(r.asset);
    CHECK((r.asset->materials[0].substance == nullptr && r.report.empty()));
  }
}

TEST_CASE("damaged pictures are warnings that name them", "[gltf]") {
  box().put("good.png", kPng);
  box().put("damaged.png", "not a picture at all");
  Json file = {
      {"images", {{{"uri", "good.png"}}, {{"uri", "damaged.png"}}, {{"uri", "data:image/png;base64,iVBORw0KGgo="}}}},
      {"textures", {{{"source", 0}}, {{"source", 1}}, {{"source", 2}}, Json::object()}}};
  for (int i = 0; i < 4; ++i) file["materials"].push_back({{"emissiveTexture", {{"index", i}}}});
  const Reading r = readJson(file);
  INFO(r.message());
  REQUIRE(r.asset);
  for (int i = 0; i < 4; ++i) CHECK(bool(r.asset->materials[std::size_t(i)].emissiveTexture) == (i == 0 || i == 2));
  CHECK(r.warned("damaged.png"));
  CHECK(r.report.warnings().size() == 2);
  file["images"][2]["uri"] = "data:image/png;base64,iVBOR*0KGgo=";
  CHECK(readJson(file).message().find("/images/2/uri") != std::string::npos);
}

TEST_CASE("pictures are decoded on two threads where the decoder allows it, and reported in order", "[gltf]") {
  class Slow final : public burnish::ImageDecoder {
   public:
    Result<burnish::Image> decode(std::span<const std::byte> file, std::string_view name,
                                  const burnish::DecodeLimits&) override {
      most = std::max(most.load(), ++now);
      std::this_thread::sleep_for(std::chrono::milliseconds(file.size() == 1 ? 20 : 5));
      --now;
      if (file.size() < 3) return burnish::fail(std::string(name), "too short");
      return burnish::Image{int(file.size()), 1, 1, burnish::PixelType::U8, std::vector<std::byte>(file.size())};
    }
    [[nodiscard]] int concurrency() const override { return allowed; }
    std::atomic<int> now = 0, most = 0;
    int allowed = 1;
  };
  Json file = {{"asset", {{"version", "2.0"}}}};
  for (int i = 0; i < 8; ++i) {
    const std::string name = std::to_string(i) + ".png";
    box().put(name, std::string(std::size_t(i + 1), 'x'));
    file["images"].push_back({{"uri", i == 7 ? "./4.png" : name}});
    file["textures"].push_back({{"source", i}});
    file["materials"].push_back({{"emissiveTexture", {{"index", i}}}});
  }
  const fs::path path = box().put("threads.gltf", file.dump());
  for (const int allowed : {1, 2, 16}) {
    Slow decoder;
    decoder.allowed = allowed;
    Report report;
    const auto asset = burnish::asset::readGltf(path, {.decoder = &decoder}, report);
    REQUIRE(asset);
    CHECK(decoder.most == std::min(allowed, 2));
    REQUIRE(report.warnings().size() == 2);
    CHECK(report.warnings()[0].place == "threads.gltf: /images/0");
    CHECK(report.warnings()[1].place == "threads.gltf: /images/1");
    for (int i = 2; i < 7; ++i) CHECK(asset->pictures[std::size_t(i)].pixels.width == i + 1);
    CHECK(asset->textures[7].picture == 4);  // the same file under another name
    CHECK(asset->pictures[7].pixels.empty());
  }
}
