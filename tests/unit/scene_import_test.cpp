// glTF materials and scenes as the importer makes them, from assets built by hand.
#include <catch2/catch.hpp>
#include <cmath>

#include "image/convert.h"
#include "material/codec.h"
#include "scene/convert_material.h"
#include "scene/enlarge.h"
#include "scene/load.h"

using namespace burnish;

namespace {

Image solid(int size, std::initializer_list<int> value) {
  Image image = makeImage(size, size, int(value.size()), PixelType::U8);
  for (std::size_t i = 0; i < image.byteSize(); ++i) image.u8()[i] = std::uint8_t(value.begin()[i % value.size()]);
  return image;
}
/// Like solid, but one texel differs in every channel, so that no channel is constant.
Image varied(int size, std::initializer_list<int> value) {
  Image image = solid(size, value);
  for (int c = 0; c < image.channels; ++c) image.u8()[c] = std::uint8_t(image.u8()[c] ^ 0x40);
  return image;
}

struct World {
  asset::Asset asset;
  Scene scene;
  Report report;
  int picture(Image image) {
    asset.pictures.push_back({"picture" + std::to_string(asset.pictures.size()), std::move(image)});
    asset.textures.push_back({int(asset.pictures.size()) - 1, -1});
    return int(asset.textures.size()) - 1;
  }
  const Material& convert(const asset::Material& m, bool vertexAlpha = false) {
    asset.materials.push_back(m);
    converter = std::make_unique<scene::MaterialConverter>(asset, scene, report);
    return *scene.materials.get(converter->convert(int(asset.materials.size()) - 1, vertexAlpha).id);
  }
  [[nodiscard]] const Image& image(Id<Texture> id) const { return scene.textures.get(id)->image; }
  [[nodiscard]] bool warned(std::string_view text) const {
    for (const Warning& w : report.warnings())
      if (w.message().find(text) != std::string::npos) return true;
    return false;
  }
  std::unique_ptr<scene::MaterialConverter> converter;
};

asset::TextureRef ref(int texture) {
  asset::TextureRef r;
  r.texture = texture;
  return r;
}
const std::uint8_t* pixel(const Image& image, int x, int y) {
  return image.u8() + std::size_t(image.channels) * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
}

}  // namespace

TEST_CASE("Materials without textures become factors", "[import]") {
  World w;
  asset::Material m;
  m.name = "plain";
  m.baseColor = {0.8f, 0.2f, 0.1f, 0.5f};
  m.metallic = 0;
  m.roughness = 0.3f;
  const Material& out = w.convert(m);
  CHECK(!out.mapA);
  CHECK(!out.mapB);
  CHECK(!out.mapC);
  CHECK(out.substance * 255 == Approx(85));
  CHECK(out.roughness == 0.3f);
  CHECK(out.albedo == glm::vec3(0.8f, 0.2f, 0.1f));
  CHECK(out.opacity == 1);  // alphaMode OPAQUE ignores alpha
  CHECK(!out.alphaTest);
  CHECK(w.report.empty());
}

TEST_CASE("Metals, half metals and their error", "[import]") {
  World w;
  asset::Material m;
  m.name = "half";
  m.metallic = 0.5f;
  CHECK(w.convert(m).substance == Approx(0.7f));
  CHECK(w.warned("material \"half\": partly metallic: reflectance is off by up to 0.0102"));
  m.metallic = 1;
  m.name = "whole";
  CHECK(w.convert(m).substance == 1);
  CHECK(w.report.warnings().size() == 1);
}

TEST_CASE("Base colour, metal-roughness, normal and occlusion merge into three maps", "[import]") {
  World w;
  asset::Material m;
  m.name = "bronze";
  m.baseColorTexture = ref(w.picture(varied(4, {200, 100, 50})));
  m.metallicRoughnessTexture = ref(w.picture(varied(4, {128, 200, 255})));
  m.occlusionTexture = m.metallicRoughnessTexture;
  m.normalTexture = ref(w.picture(varied(4, {128, 128, 255})));
  m.baseColor = {0.5f, 0.5f, 0.5f, 1};
  m.roughness = 0.5f;
  const Material out = w.convert(m);
  REQUIRE(out.mapA);
  CHECK(w.scene.textures.get(out.mapA)->kind == MapKind::AlbedoSubstance);
  const std::uint8_t* a = pixel(w.image(out.mapA), 2, 2);
  CHECK(int(a[0]) == 200);
  CHECK(int(a[2]) == 50);
  CHECK(int(a[3]) == 255);
  CHECK(out.albedo == glm::vec3(0.5f));  // the factor stays apart
  const std::uint8_t* b = pixel(w.image(out.mapB), 2, 2);
  CHECK(int(b[2]) == 255);
  CHECK(int(b[3]) == 100);  // with a normal map the roughness factor is baked
  CHECK(out.roughness == 1);
  CHECK(w.image(out.mapC).channels == 1);
  CHECK(int(pixel(w.image(out.mapC), 2, 2)[0]) == 128);
  CHECK(!out.metalRoughMap);
}

TEST_CASE("Normal scale is baked and leaves flat normals flat", "[import]") {
  World w;
  asset::Material m;
  Image normals = solid(4, {128, 128, 255});
  const std::uint8_t tilted[3] = {204, 128, 230};  // slope 76/102
  std::copy_n(tilted, 3, normals.u8());
  m.normalTexture = ref(w.picture(std::move(normals)));
  m.normalTexture.strength = 2;
  const Material& out = w.convert(m);
  const std::uint8_t* n = pixel(w.image(out.mapB), 0, 0);
  CHECK(float(n[0] - 128) / float(n[2] - 128) == Approx(2 * 76.0 / 102).epsilon(0.02));
  CHECK(std::hypot(n[0] - 128, n[2] - 128) == Approx(127).margin(1));
  const std::uint8_t* flat = pixel(w.image(out.mapB), 2, 2);
  CHECK(int(flat[0]) == 128);
  CHECK(int(flat[2]) == 255);
}

TEST_CASE("Materials that ask for the same merge share it", "[import]") {
  World w;
  asset::Material m;
  m.baseColorTexture = ref(w.picture(varied(4, {200, 100, 50})));
  m.metallicRoughnessTexture = ref(w.picture(varied(4, {128, 200, 255})));
  asset::Asset& a = w.asset;
  for (int i = 0; i < 3; ++i) {
    m.name = "drape" + std::to_string(i);
    m.baseColor = {0.1f * float(i), 0.5f, 0.5f, 1};
    m.roughness = 0.5f + 0.1f * float(i);
    a.materials.push_back(m);
  }
  scene::MaterialConverter converter(a, w.scene, w.report);
  const Material first = *w.scene.materials.get(converter.convert(0, false).id),
                 last = *w.scene.materials.get(converter.convert(2, false).id);
  CHECK(first.mapA == last.mapA);
  CHECK(first.mapB == last.mapB);  // no normal map: the roughness factor stays a multiplier
  CHECK(last.roughness == 0.7f);
  CHECK(w.scene.textures.size() == 2);
}

TEST_CASE("A picture without information costs no map", "[import]") {
  World w;
  asset::Material m;
  m.metallicRoughnessTexture = ref(w.picture(solid(8, {255, 128, 0})));  // occlusion 1, roughness 0.5, no metal
  m.occlusionTexture = m.metallicRoughnessTexture;
  const Material& out = w.convert(m);
  CHECK(w.scene.textures.size() == 0);
  CHECK(out.substance * 255 == Approx(85));
  CHECK(out.roughness == Approx(128.0f / 255));
}

TEST_CASE("Sizes that differ are enlarged to the larger", "[import]") {
  World w;
  asset::Material m;
  m.baseColorTexture = ref(w.picture(solid(2, {188, 188, 188})));
  m.metallicRoughnessTexture = ref(w.picture(varied(8, {0, 200, 255})));
  const Material& out = w.convert(m);
  CHECK(w.image(out.mapA).width == 8);
  CHECK(int(pixel(w.image(out.mapA), 5, 3)[0]) == 188);
}

TEST_CASE("Enlargement is bilinear, in linear light for colours", "[import]") {
  Image two = makeImage(2, 1, 4, PixelType::U8);
  for (int c = 0; c < 4; ++c) two.u8()[4 + c] = 255;
  const Image srgb = scene::enlarged(two, 4, 1, true, Wrap::ClampToEdge, Wrap::ClampToEdge);
  CHECK(int(srgb.u8()[0]) == 0);
  CHECK(int(srgb.u8()[4]) == 137);  // sRGB of 0.25
  CHECK(int(srgb.u8()[7]) == 64);   // alpha is linear
  CHECK(int(srgb.u8()[12]) == 255);
  const Image wrapped = scene::enlarged(two, 4, 1, false, Wrap::Repeat, Wrap::Repeat);
  CHECK(int(wrapped.u8()[0]) == 64);  // a quarter of the way round to the other pixel
}

TEST_CASE("Another mapping keeps metal-roughness apart", "[import]") {
  World w;
  asset::Material m;
  m.name = "variant";
  m.baseColorTexture = ref(w.picture(varied(4, {200, 100, 50})));
  m.metallicRoughnessTexture = ref(w.picture(varied(4, {0, 200, 255})));
  m.metallicRoughnessTexture.uvSet = 1;
  m.normalTexture = ref(w.picture(varied(4, {128, 128, 255})));
  m.metallic = 0.75f;
  m.roughness = 0.5f;
  const Material& out = w.convert(m);
  REQUIRE(out.metalRoughMap);
  CHECK(w.scene.textures.get(out.metalRoughMap)->kind == MapKind::MetalRough);
  CHECK(out.uvMetalRough.set == 1);
  CHECK(out.metalness == 0.75f);
  CHECK(out.roughness == 0.5f);
  CHECK(int(pixel(w.image(out.mapA), 1, 1)[3]) == 85);
  CHECK(int(pixel(w.image(out.mapB), 1, 1)[3]) == 0);
  CHECK(w.warned("kept as a texture of its own"));
}

TEST_CASE("Alpha: mask, blend and vertex colours", "[import]") {
  World w;
  asset::Material m;
  m.name = "leaf";
  m.metallic = 0;
  m.alphaMode = asset::AlphaMode::Mask;
  m.alphaCutoff = 0.25f;
  m.baseColorTexture = ref(w.picture(varied(4, {20, 200, 20, 255})));
  Material out = w.convert(m);
  CHECK(out.alphaTest);
  CHECK(out.alphaCutoff == 0.25f);
  CHECK(w.image(out.mapC).channels == 2);
  CHECK(int(pixel(w.image(out.mapC), 0, 0)[1]) == 0xbf);
  CHECK(w.report.empty());

  m.name = "solid";
  m.baseColorTexture = ref(w.picture(varied(4, {20, 200, 20})));  // no alpha in the picture
  CHECK(!w.convert(m).alphaTest);
  CHECK(w.convert(m, true).alphaTest);

  m.name = "glass";
  m.alphaMode = asset::AlphaMode::Blend;
  CHECK(!w.convert(m).blend);  // opaque everywhere
  CHECK(w.convert(m, true).blend);
  m.baseColor.a = 0.3f;
  out = w.convert(m);
  CHECK(out.blend);
  CHECK(!out.alphaTest);
  CHECK(out.opacity == 0.3f);
  m.baseColorTexture = ref(w.picture(varied(4, {20, 200, 20, 255})));
  m.occlusionTexture = ref(w.picture(varied(4, {99, 99, 99})));
  out = w.convert(m);
  CHECK(out.blend);
  CHECK(int(pixel(w.image(out.mapC), 0, 0)[1]) == 0xbf);
  CHECK(!w.warned("glass"));
}

TEST_CASE("Glass: transmission, volume and index of refraction", "[import]") {
  World w;
  asset::Material m;
  m.name = "vase";
  m.metallic = 0;
  m.ior = 1.33f;
  CHECK(w.convert(m).transmission == 0);
  m.transmission = 0.8f;
  m.thickness = 0.02f;
  m.attenuationColor = {0.5f, 1, 0.25f};
  m.attenuationDistance = 0.1f;
  const Material out = w.convert(m);
  CHECK(out.transmission == 0.8f);
  CHECK(out.ior == 1.33f);
  CHECK(out.thickness == 0.02f);
  CHECK(out.attenuationColor == glm::vec3(0.5f, 1, 0.25f));
  CHECK(out.attenuationDistance == 0.1f);
  CHECK(w.report.empty());
  m.transmissionTexture = ref(w.picture(solid(4, {51, 0, 0})));
  CHECK(w.convert(m).transmission == Approx(0.16f));
  CHECK(w.report.empty());
  m.thicknessTexture = ref(w.picture(varied(4, {0, 40, 0})));
  CHECK(w.convert(m).thickness < 0.02f);
  CHECK(w.warned("thicknessTexture"));
  m.specular = 0.5f;
  w.convert(m);
  CHECK(w.warned("KHR_materials_specular has no say on glass"));
  m.unlit = true;
  CHECK(w.convert(m).transmission == 0);
  CHECK(w.warned("transmission is left out"));
}

TEST_CASE("Occlusion of another mapping yields to opacity, and says so", "[import]") {
  World w;
  asset::Material m;
  m.alphaMode = asset::AlphaMode::Mask;
  m.baseColorTexture = ref(w.picture(varied(4, {20, 200, 20, 255})));
  m.occlusionTexture = ref(w.picture(varied(4, {99, 99, 99})));
  m.occlusionTexture.uvSet = 1;
  const Material out = w.convert(m);
  CHECK(out.occlusionStrength == 0);
  CHECK(w.warned("occlusion (picture1)"));
  m.alphaMode = asset::AlphaMode::Opaque;
  const Material opaque = w.convert(m);
  CHECK(opaque.uvC.set == 1);
  CHECK(int(pixel(w.image(opaque.mapC), 2, 2)[0]) == 99);
}

TEST_CASE("Index of refraction and specular", "[import]") {
  World w;
  asset::Material m;
  m.metallic = 0;
  m.ior = 2.417f;
  CHECK(decodeSubstance(w.convert(m).substance, glm::vec3(0)).f0.x == Approx(f0FromIor(2.417f)).margin(1e-5));
  m.ior = 1.333f;
  CHECK(decodeSubstance(w.convert(m).substance, glm::vec3(0)).f0.x == Approx(f0FromIor(1.333f)).margin(1e-5));
  CHECK(w.report.empty());
  m.name = "dull";
  m.ior = 1.5f;
  m.specular = 0.2f;
  CHECK(w.convert(m).substance == Approx(0.4f));
  CHECK(
      w.warned("material \"dull\": its dielectric F0 is under water's 0.0196, the least that a surface in air has: "
               "reflectance is off by up to 0.0116"));
  m.name = "tinted";
  m.specular = 1;
  m.specularColor = {1, 0.5f, 0.75f};
  CHECK(decodeSubstance(w.convert(m).substance, glm::vec3(0)).f0.x == Approx(0.03f).margin(1e-5));
  CHECK(w.warned("is coloured, which a dielectric cannot be here: reflectance is off by up to 0.0100"));
  m.name = "black";  // without diffuse a conductor shows any F0
  m.baseColor = {0, 0, 0, 1};
  const Material black = w.convert(m);
  const DecodedSubstance shown = decodeSubstance(black.substance, black.albedo);
  CHECK(shown.f0.y == Approx(0.02f).margin(1e-3));
  CHECK(shown.diffuse.x < 1e-3f);
  CHECK(!w.warned("black"));
  m.name = "metal";
  m.metallic = 1;
  const std::size_t before = w.report.warnings().size();
  w.convert(m);  // the dielectric part of a whole metal does not matter
  CHECK(w.report.warnings().size() == before);
}

TEST_CASE("Specular textures become codes", "[import]") {
  World w;
  asset::Material m;
  m.metallic = 0;
  m.baseColorTexture = ref(w.picture(varied(4, {20, 200, 20})));
  m.specularTexture = ref(w.picture(varied(4, {0, 0, 0, 191})));
  m.ior = 1.8f;
  const Material out = w.convert(m);
  const int code = pixel(w.image(out.mapA), 2, 2)[3];
  CHECK(decodeSubstance(float(code) / 255, glm::vec3(0)).f0.x == Approx(f0FromIor(1.8f) * 191 / 255).margin(0.0013));
}

TEST_CASE("Specular-glossiness", "[import]") {
  World w;
  asset::Material m;
  m.name = "gold";
  m.specularGlossiness = true;
  m.diffuse = glm::vec4(0, 0, 0, 1);
  m.specularF0 = {1, 0.766f, 0.336f};
  m.glossiness = 0.9f;
  const Material gold = w.convert(m);
  CHECK(gold.substance == 1);
  CHECK(gold.albedo.y == Approx(0.766f).margin(1e-4));
  CHECK(gold.roughness == Approx(0.1f));
  CHECK(w.report.empty());

  m.name = "paint";
  m.diffuse = glm::vec4(0.5f, 0.2f, 0.1f, 1);
  m.specularF0 = glm::vec3(0.04f);
  const Material paint = w.convert(m);
  CHECK(std::lround(paint.substance * 255) == 85);
  CHECK(paint.albedo.x == Approx(0.5f * 0.96f).margin(1e-4));

  m.name = "textured";
  m.diffuse = m.diffuse * 0.0f + 1.0f;
  m.specularF0 = glm::vec3(1);
  m.glossiness = 1;
  m.diffuseTexture = ref(w.picture(varied(4, {10, 10, 10})));
  m.specularGlossinessTexture = ref(w.picture(varied(4, {255, 220, 160, 200})));
  m.normalTexture = ref(w.picture(varied(4, {128, 128, 255})));
  const Material textured = w.convert(m);
  const std::uint8_t* a = pixel(w.image(textured.mapA), 2, 2);
  CHECK(int(a[3]) >= 254);
  CHECK(std::abs(int(a[1]) - 220) <= 1);
  CHECK(int(pixel(w.image(textured.mapB), 2, 2)[3]) == 55);  // 1 - glossiness
}

TEST_CASE("Texture transforms as the extension's examples say", "[import]") {
  asset::TextureRef r;
  r.texture = 0;
  r.offset = {0, 1};
  r.rotation = float(M_PI) / 2;
  r.scale = {0.5f, 0.5f};
  const UvMapping m = scene::mappingOf(r);
  const auto at = [&m](float u, float v) { return m.transform * glm::vec3(u, v, 1); };
  // The lower left quadrant, turned clockwise by 90 degrees: v runs down, so lower left is u under 0.5, v over 0.5.
  CHECK(glm::length(at(0, 0) - glm::vec2(0, 1)) < 1e-6f);
  CHECK(glm::length(at(1, 0) - glm::vec2(0, 0.5f)) < 1e-6f);
  CHECK(glm::length(at(0, 1) - glm::vec2(0.5f, 1)) < 1e-6f);
  r.rotation = 0;
  r.scale = {1, -1};
  CHECK(scene::mappingOf(r).transform * glm::vec3(0.25f, 0.25f, 1) == glm::vec2(0.25f, 0.75f));
}

TEST_CASE("Factors out of range are brought in with a warning", "[import]") {
  World w;
  asset::Material m;
  m.name = "odd";
  m.baseColor = {std::numeric_limits<float>::quiet_NaN(), 2, -1, 1};
  m.metallic = -3;
  m.roughness = std::numeric_limits<float>::infinity();
  m.emissive = {std::numeric_limits<float>::infinity(), 5, -1};
  const Material& out = w.convert(m);
  CHECK(out.albedo == glm::vec3(0, 1, 0));
  CHECK(out.substance * 255 == Approx(85));
  CHECK(out.roughness == 1);
  CHECK(out.emission == glm::vec3(0, 5, 0));
  CHECK(w.report.warnings().size() >= 6);
}

TEST_CASE("Unlit materials bring their colour and nothing else", "[import]") {
  World w;
  asset::Material m;
  m.unlit = true;
  m.baseColorTexture = ref(w.picture(varied(4, {20, 200, 20})));
  m.metallicRoughnessTexture = ref(w.picture(varied(4, {128, 200, 255})));
  m.normalTexture = m.occlusionTexture = m.metallicRoughnessTexture;
  const Material& out = w.convert(m);
  CHECK(out.unlit);
  CHECK(out.mapA);
  CHECK(!out.mapB);
  CHECK(!out.mapC);
}

TEST_CASE("An asset becomes nodes, instances, lights and cameras", "[import]") {
  asset::Asset a;
  a.name = "scene.gltf";
  asset::Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.indices = {0, 1, 2};
  asset::Primitive flat = p;
  flat.indices = {0, 0, 0};
  a.meshes.push_back({"shape", {p, p, flat}});
  asset::Light spot;
  spot.kind = asset::Light::Kind::Spot;
  spot.intensity = 5;
  spot.innerCone = 2;
  spot.outerCone = 1;
  a.lights.push_back(spot);
  asset::Camera camera;
  camera.orthographic = true;
  camera.ymag = 3;
  camera.far = 10;
  a.cameras.push_back(camera);
  for (int i = 0; i < 3; ++i) {
    asset::Node n;
    n.name = "node" + std::to_string(i);
    n.parent = i - 1;
    n.mesh = 0;
    n.light = i == 1 ? 0 : -1;
    n.camera = i == 2 ? 0 : -1;
    a.nodes.push_back(n);
  }
  Report report;
  const auto s = scene::importAsset(std::move(a), scene::Deadline(0), report);
  REQUIRE(s);
  CHECK(s->meshes.size() == 2);  // the third has nothing to draw
  CHECK(s->instances.size() == 6);
  CHECK(s->nodes.size() == 3);
  CHECK(s->nodes.get(s->nodes.at(2))->parent == s->nodes.at(1));
  REQUIRE(s->lights.size() == 1);
  CHECK(s->lights.get(s->lights.at(0))->name == "node1");
  CHECK(s->lights.get(s->lights.at(0))->innerCone <= s->lights.get(s->lights.at(0))->outerCone);
  REQUIRE(s->cameras.size() == 1);
  CHECK(s->cameras.get(s->cameras.at(0))->height == 6);
  CHECK(s->meshes.get(s->meshes.at(0))->normals.size() == 3);
  // Without a material: glTF's default, a white rough metal.
  const Instance* i = s->instances.get(s->instances.at(0));
  REQUIRE(s->materials.has(i->material));
  CHECK(s->materials.get(i->material)->substance == 1);
}

TEST_CASE("Tangents are made only where a normal map asks for them", "[import]") {
  for (const bool normalMap : {false, true}) {
    asset::Asset a;
    asset::Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    p.uv1 = {{0, 0}, {1, 0}, {0, 1}};
    p.indices = {0, 1, 2};
    p.material = 0;
    a.meshes.push_back({"shape", {p}});
    a.nodes.emplace_back().mesh = 0;
    a.pictures.push_back({"normal", varied(4, {128, 128, 255})});
    a.textures.push_back({0, -1});
    asset::Material m;
    if (normalMap) m.normalTexture = ref(0);
    m.normalTexture.uvSet = 1;
    a.materials.push_back(m);
    Report report;
    const auto s = scene::importAsset(std::move(a), scene::Deadline(0), report);
    REQUIRE(s);
    CHECK(s->meshes.get(s->meshes.at(0))->tangents.empty() == !normalMap);
    if (normalMap) CHECK(s->meshes.get(s->meshes.at(0))->tangents[0].x == Approx(1));
  }
}

TEST_CASE("A load that takes too long ends", "[import]") {
  asset::Asset a;
  a.name = "slow.gltf";
  a.materials.resize(3);
  Report report;
  const auto s = scene::importAsset(std::move(a), scene::Deadline(1e-9), report);
  REQUIRE(!s);
  CHECK(s.error().message().find("slow.gltf: loading took longer than allowed") == 0);
}

TEST_CASE("Environments are finite and fit half floats, with one warning", "[import]") {
  Image in = makeImage(4, 2, 3, PixelType::F32);
  for (std::size_t i = 0; i < 24; ++i) in.f32()[i] = 1;
  in.f32()[0] = std::numeric_limits<float>::quiet_NaN();
  in.f32()[1] = std::numeric_limits<float>::infinity();
  in.f32()[2] = -4;
  in.f32()[3] = 120000;
  Report report;
  const Image out = scene::environmentMap(in, "sky.hdr", report);
  CHECK(out.channels == 3);
  CHECK(out.f32()[0] == 0);
  CHECK(out.f32()[1] == 65504);
  CHECK(out.f32()[2] == 0);
  CHECK(out.f32()[3] == 65504);
  CHECK(out.f32()[4] == 1);
  REQUIRE(report.warnings().size() == 1);
  CHECK(report.warnings()[0].message().find("sky.hdr: 4 values were mended") == 0);
  CHECK(report.warnings()[0].what.find("120000") != std::string::npos);

  Report none;
  const Image png = scene::environmentMap(solid(2, {188, 0, 255, 7}), "sky.png", none);
  CHECK(png.channels == 3);
  CHECK(png.f32()[0] == Approx(0.503f).margin(0.002));
  CHECK(png.f32()[2] == 1);
  const Image grey = scene::environmentMap(solid(2, {255}), "grey.png", none);
  CHECK(grey.f32()[1] == 1);
  CHECK(none.empty());
}
