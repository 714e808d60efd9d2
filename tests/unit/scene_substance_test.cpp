// Named substances and anisotropy of glTF materials, as the importer makes them.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "image/convert.h"
#include "scene/convert_material.h"
#include "scene/load.h"

using namespace burnish;

namespace {

/// 2 x 2 texels, of which one differs in every channel.
Image varied(std::initializer_list<int> value) {
  Image image = makeImage(2, 2, int(value.size()), PixelType::U8);
  for (std::size_t i = 0; i < image.byteSize(); ++i) image.u8()[i] = std::uint8_t(value.begin()[i % value.size()]);
  for (int c = 0; c < image.channels; ++c) image.u8()[c] = std::uint8_t(image.u8()[c] ^ 0x40);
  return image;
}

struct World {
  asset::Asset asset;
  Scene scene;
  Report report;

  asset::TextureRef picture(std::initializer_list<int> value) {
    asset.pictures.push_back({"picture" + std::to_string(asset.pictures.size()), varied(value)});
    asset.textures.push_back({int(asset.pictures.size()) - 1, -1});
    asset::TextureRef ref;
    ref.texture = int(asset.textures.size()) - 1;
    return ref;
  }
  Material convert(const asset::Material& m) {
    asset.materials.push_back(m);
    scene::MaterialConverter converter(asset, scene, report);
    return *scene.materials.get(converter.convert(int(asset.materials.size()) - 1, false).id);
  }
  [[nodiscard]] bool warned(std::string_view text) const {
    for (const Warning& w : report.warnings())
      if (w.message().find(text) != std::string::npos) return true;
    return false;
  }
};

asset::Material of(const char* substance) {
  REQUIRE(findSubstance(substance));
  asset::Material m;
  m.substance = findSubstance(substance);
  return m;
}

}  // namespace

TEST_CASE("A named conductor gives metalness, albedo, eta and k", "[import]") {
  World w;
  const Substance& gold = *findSubstance("gold");
  asset::Material m = of("gold");
  m.baseColor = {0.2f, 0.3f, 0.4f, 1};  // for readers that do not know the name
  m.metallic = 0;
  m.ior = 1.2f;
  m.roughness = 0.25f;
  Material out = w.convert(m);
  CHECK((out.substance == 1 && !out.mapA && out.roughness == 0.25f));
  CHECK(out.albedo == gold.f0);
  CHECK((out.conductorEta == gold.eta && out.conductorK == gold.k));

  m.baseColorTexture = w.picture({200, 100, 50});
  m.metallicRoughnessTexture = w.picture({0, 100, 30});
  out = w.convert(m);
  REQUIRE(out.mapA);
  CHECK(out.albedo == glm::vec3(m.baseColor));
  const std::uint8_t* texel = w.scene.textures.get(out.mapA)->image.u8() + 12;
  CHECK((int(texel[0]) == 200 && int(texel[3]) == 255));  // its code is metal, whatever the picture's metalness
  REQUIRE(out.mapB);                                      // the picture's roughness counts
  CHECK(int(w.scene.textures.get(out.mapB)->image.u8()[15]) == 100);
  CHECK(out.conductorEta == gold.eta);
  CHECK(w.report.empty());
}

TEST_CASE("A named conductor stays metal where metal-roughness is kept apart", "[import]") {
  World w;
  asset::Material m = of("copper");
  m.metallicRoughnessTexture = w.picture({0, 100, 30});
  m.normalTexture = w.picture({128, 128, 255});
  m.normalTexture.uvSet = 1;
  const Material out = w.convert(m);
  REQUIRE(out.metalRoughMap);
  CHECK((out.metalness == 1 && out.albedo == findSubstance("copper")->f0));
  const Image& map = w.scene.textures.get(out.metalRoughMap)->image;
  for (std::size_t i = 0; i < map.pixelCount(); ++i) CHECK(int(map.u8()[4 * i + 2]) == 255);
  CHECK(int(map.u8()[13]) == 100);
}

TEST_CASE("A named dielectric gives F0 and leaves the base colour", "[import]") {
  World w;
  for (const char* name : {"water", "diamond", "plastic"}) {
    INFO(name);
    asset::Material m = of(name);
    m.baseColor = {0.2f, 0.3f, 0.4f, 1};
    m.ior = 1.9f;  // and metallic stays 1, glTF's default
    const Material out = w.convert(m);
    CHECK(decodeSubstance(out.substance, out.albedo).f0.x == Approx(f0FromIor(m.substance->ior)).margin(1e-5));
    CHECK(out.albedo == glm::vec3(m.baseColor));
    CHECK((out.conductorEta == glm::vec3(0) && out.conductorK == glm::vec3(0)));
  }
  CHECK(w.report.empty());
}

TEST_CASE("Anisotropy is brought into range and reported, and diffuse roughness comes along", "[import]") {
  World w;
  asset::Material m;
  m.name = "brushed";
  m.anisotropyRotation = 1.5f;
  Material out = w.convert(m);
  CHECK((out.anisotropy == 0 && out.anisotropyRotation == 0 && w.report.empty()));
  m.anisotropy = 0.75f;
  out = w.convert(m);
  CHECK((out.anisotropy == 0.75f && out.anisotropyRotation == 1.5f));
  CHECK(w.report.empty());
  m.anisotropy = 2;
  m.anisotropyRotation = std::numeric_limits<float>::infinity();
  out = w.convert(m);
  CHECK((out.anisotropy == 1 && out.anisotropyRotation == 0));
  CHECK(w.warned("anisotropyStrength is 2: it was brought into 0..1"));
  CHECK(w.warned("anisotropyRotation is not finite: 0 is used"));
  m.diffuseRoughness = 0.4f;
  CHECK(w.convert(m).diffuseRoughness == 0.4f);
  m.unlit = true;
  CHECK((w.convert(m).anisotropy == 0 && w.convert(m).diffuseRoughness == 0));
}

TEST_CASE("Anisotropic materials have tangents", "[import]") {
  for (const bool anisotropic : {false, true})
    for (const bool mapped : {false, true}) {
      asset::Asset a;
      asset::Primitive p;
      p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
      if (mapped) p.uv0 = {{0, 0}, {1, 0}, {0, 1}};
      p.indices = {0, 1, 2};
      p.material = 0;
      a.meshes.push_back({"shape", {p}});
      a.nodes.emplace_back().mesh = 0;
      a.materials.emplace_back().anisotropy = anisotropic ? 0.5f : 0;
      Report report;
      const auto s = scene::importAsset(std::move(a), scene::Deadline(0), report);
      REQUIRE(s);
      const auto& tangents = s->meshes.get(s->meshes.at(0))->tangents;
      CHECK(tangents.empty() == !(anisotropic && mapped));
      if (!tangents.empty()) CHECK(tangents[0].x == Approx(1));
      CHECK(report.warnings().size() == (anisotropic && !mapped ? 1u : 0u));
    }
}
