// What surfaces reflect at most while baking: the factor, the map's texels, vertex colours, of dielectrics and metals, each by the rungs in force.
#include "image/convert.h"
#include "material/codec.h"
#include "probe/probes.h"
#include "reference/oracle.h"

using namespace burnish;
using namespace burnish::test;

namespace {

Id<Instance> wall(Scene& scene, const Material& material, bool colors = false) {
  Mesh m = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  if (colors) m.colors = {{1, 1, 1, 1}, {0.5f, 0.5f, 0.5f, 1}, {1, 0.2f, 0.2f, 0.5f}, {0.1f, 0.1f, 0.1f, 1}};
  return place(scene, std::move(m), material);
}
const Material& materialOf(const Scene& scene, Id<Instance> id) { return *scene.materials.get(scene.instances.get(id)->material); }

/// What a surface of that albedo and code reflects of light from everywhere, by quadrature over the viewing directions of the oracle's sums: another way than the limit's own.
double reflectedInAll(double albedo, double code, double roughness) {
  shading::Rungs rungs{};
  rungs.distribution = DISTRIBUTION_BLINN_PHONG, rungs.geometry = GEOMETRY_KELEMEN, rungs.fresnel = FRESNEL_SCHLICK, rungs.diffuse = DIFFUSE_COUPLED_FIT, rungs.lobe = LOBE_STABLE;
  return reference::hemisphereMean<double>(
      [&](double c) {
        reference::OracleSurface s;
        s.v = reference::directionAt(std::max(c, 1e-3));
        s.albedo = dvec3(albedo);
        s.substance = code;
        s.alpha = roughness * roughness;
        const reference::DirectionalAlbedo a = reference::directionalAlbedo(s, rungs, {32, 32});
        return a.diffuse.x + a.specular.x;
      },
      16);
}

}  // namespace

TEST_CASE("limit: a scene that reflects less is as it was") {
  Scene scene;
  Material grey;
  grey.albedo = vec3(0.9f, 0.5f, 0.1f);
  const Id<Instance> id = wall(scene, grey, true);
  Report report;
  const Scene same = probe::limited(scene, 0.98, {}, report);
  CHECK(report.empty());
  CHECK(materialOf(same, id).albedo == grey.albedo);
  CHECK(same.textures.size() == 0);
  CHECK(same.meshes.revision() == scene.meshes.revision());
  CHECK(same.materials.revision() == scene.materials.revision());
  CHECK(same.instances.revision() == scene.instances.revision());
}

TEST_CASE("limit: the factor, of dielectrics and metals") {
  for (const float code : {0.0f, 1.0f / 3, 0.4f, 0.6f, 0.8f, 1.0f})
    for (const double limit : {0.98, 0.6}) {
      Scene scene;
      Material white;
      white.name = "white";
      white.substance = code;
      const Id<Instance> id = wall(scene, white);
      Report report;
      const Scene darker = probe::limited(scene, limit, {}, report);
      CAPTURE(code, limit);
      REQUIRE(report.warnings().size() == 1);
      CHECK(report.warnings()[0].message().find("material 'white'") == 0);
      CHECK(report.warnings()[0].what.find("everywhere") != std::string::npos);
      const float albedo = materialOf(darker, id).albedo.x;
      CHECK(albedo < 1);
      for (const double roughness : {0.2, 0.6, 1.0}) CHECK(reflectedInAll(double(albedo), double(code), roughness) < limit + 2e-3);
      // No more than is needed: of a smooth surface that is all.
      CHECK(reflectedInAll(double(albedo), double(code), 0.1) > limit - 0.03);
      CHECK(materialOf(scene, id).albedo == vec3(1));
    }
}

TEST_CASE("limit: rungs decide what counts") {
  Scene scene;
  Material white;
  const Id<Instance> id = wall(scene, white);
  const auto albedo = [&](const Quality& q) {
    Report report;
    return double(materialOf(probe::limited(scene, 0.98, q, report), id).albedo.x);
  };
  Quality matte, lambert;
  matte.environmentSpecular = EnvironmentSpecular::None;
  CHECK(albedo(matte) == Approx(0.98).epsilon(1e-6));
  // Lambert's diffuse does not know of the lobe: 0.04 + 0.96/21 reflect beside it.
  lambert.diffuse = Diffuse::Lambert;
  CHECK(albedo(lambert) == Approx(0.98 - 0.04 - 0.96 / 21).epsilon(1e-6));
  CHECK(albedo({}) == Approx((0.98 - 0.04 - 0.96 / 21) / (1 - 0.04 - 0.96 / 21)).epsilon(1e-6));
  scene.materials.edit(scene.instances.get(id)->material)->substance = 1;
  CHECK(albedo({}) == Approx((0.98 - 1 / 21.0) / (1 - 1 / 21.0)).epsilon(1e-6));
  std::cout << fmt::format("  albedo limit 0.98: white plastic {:.4f}, white metal {:.4f}\n", (0.98 - 0.04 - 0.96 / 21) / (1 - 0.04 - 0.96 / 21), albedo({}));
}

TEST_CASE("limit: texel by texel, on a copy") {
  Scene scene;
  Texture map;
  map.name = "paint";
  map.image = makeImage(2, 2, 4, PixelType::U8);
  const std::uint8_t texels[16] = {255, 255, 255, 85, 200, 255, 10, 85, 255, 240, 230, 255, 180, 180, 180, 85};
  std::copy(std::begin(texels), std::end(texels), map.image.u8());
  Material painted, dark, again;
  painted.name = "painted";
  painted.mapA = dark.mapA = again.mapA = scene.textures.add(map);
  dark.albedo = vec3(0.5f);
  const Id<Instance> a = wall(scene, painted), b = wall(scene, dark), c = wall(scene, again);
  Report report;
  const Scene darker = probe::limited(scene, 0.98, {}, report);
  CHECK(materialOf(darker, b).mapA == dark.mapA);
  CHECK(materialOf(darker, a).mapA != painted.mapA);
  CHECK(materialOf(darker, c).mapA == materialOf(darker, a).mapA);
  CHECK(darker.textures.size() == 2);
  CHECK(darker.textures.get(painted.mapA)->image.data == map.image.data);
  const std::uint8_t* out = darker.textures.get(materialOf(darker, a).mapA)->image.u8();
  for (int i = 0; i < 16; ++i) {
    const bool bright = texels[i] == 255 && i % 4 != 3;
    CAPTURE(i);
    if (!bright) CHECK(out[i] == texels[i]);
    if (!bright) continue;
    CHECK(out[i] < 255);
    CHECK(out[i] > 249);
    const auto linear = double(image::srgbToLinearTable()[out[i]]);
    CHECK(reflectedInAll(linear, texels[i / 4 * 4 + 3] / 255.0, 0.1) < 0.982);
  }
  REQUIRE(report.warnings().size() == 2);
  CHECK(report.warnings()[0].message().find("material 'painted'") == 0);
  CHECK(report.warnings()[0].what.find("75 % of the texels of its map 'paint'") != std::string::npos);
  CHECK(report.warnings()[0].what.find("column 0, row 0") != std::string::npos);
}

TEST_CASE("limit: vertex colours, and instances without a material") {
  Scene scene;
  Material white;
  const Id<Instance> id = wall(scene, white, true);
  Instance bare = *scene.instances.get(id);
  Mesh plain = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  bare.mesh = scene.meshes.add(plain);
  bare.material = {};
  const Id<Instance> without = scene.instances.add(bare);
  Report report;
  const Scene darker = probe::limited(scene, 0.98, {}, report);
  const double cap = (0.98 - 0.04 - 0.96 / 21) / (1 - 0.04 - 0.96 / 21);
  const std::vector<glm::vec4>& colors = darker.meshes.get(darker.instances.get(id)->mesh)->colors;
  CHECK(materialOf(darker, id).albedo == vec3(1));
  CHECK(double(colors[0].x) == Approx(cap).epsilon(1e-6));
  CHECK(colors[0].w == 1);
  CHECK(colors[1] == glm::vec4(0.5f, 0.5f, 0.5f, 1));
  CHECK(double(colors[2].x) == Approx(cap).epsilon(1e-6));
  CHECK(colors[2].y == 0.2f);
  CHECK(double(materialOf(darker, without).albedo.x) == Approx(cap).epsilon(1e-6));
  REQUIRE(report.warnings().size() == 2);
  CHECK(report.warnings()[1].what.find("2 of 4 vertex colours") != std::string::npos);
}

TEST_CASE("limit: a material on meshes with colours and without is darkened once") {
  Scene scene;
  const Id<Instance> colored = wall(scene, Material{}, true);
  Instance plain = *scene.instances.get(colored);
  plain.mesh = scene.meshes.add(quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  const Id<Instance> bare = scene.instances.add(plain);
  Report report;
  const Scene darker = probe::limited(scene, 0.98, {}, report);
  const double cap = (0.98 - 0.04 - 0.96 / 21) / (1 - 0.04 - 0.96 / 21);
  CHECK(double(materialOf(darker, bare).albedo.x) == Approx(cap).epsilon(1e-6));
  CHECK(darker.meshes.get(darker.instances.get(colored)->mesh)->colors[0].x == 1);
  CHECK(report.warnings().size() == 1);
}

TEST_CASE("limit: metalness of a map of its own, and glass: by what bears least") {
  Scene scene;
  Texture map, metal;
  map.image = makeImage(1, 1, 4, PixelType::U8);
  std::fill_n(map.image.u8(), 3, std::uint8_t(255));  // alpha 0 would be a gem, but does not count
  metal.kind = MapKind::MetalRough;
  metal.image = makeImage(1, 1, 4, PixelType::U8);
  Material apart, glass;
  apart.mapA = scene.textures.add(map);
  apart.metalRoughMap = scene.textures.add(metal);
  apart.metalness = 1;
  glass.transmission = 1;
  glass.ior = 3;  // F0 0.25
  const Id<Instance> a = wall(scene, apart), b = wall(scene, glass);
  Report report;
  const Scene darker = probe::limited(scene, 0.98, {}, report);
  CHECK(report.warnings().size() == 2);
  const auto albedo = double(image::srgbToLinearTable()[*darker.textures.get(materialOf(darker, a).mapA)->image.u8()]);
  for (const double metalness : {0.0, 0.01, 0.3, 0.7, 1.0}) CHECK(reflectedInAll(albedo, metalness > 0 ? 0.4 + 0.6 * metalness : 1 / 3.0, 0.1) < 0.982);
  const double f0 = 0.25, s = f0 + (1 - f0) / 21;
  CHECK(s + double(materialOf(darker, b).albedo.x) * (1 - s) == Approx(0.98).epsilon(1e-6));
}

TEST_CASE("limit: a limit out of range is held") {
  Report report;
  probe::limited(Scene{}, std::nan(""), {}, report);
  probe::limited(Scene{}, 2, {}, report);
  CHECK(report.warnings().size() == 2);
}
