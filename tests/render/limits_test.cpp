// Past each limit of docs/limits.md: a warning or an error that names it, and a picture where there can be one. Limits of reading are in tests/unit and tests/tools.
#include <algorithm>
#include <limits>

#include "render/scenes.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{48, 32};
const View kView = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.9f);

bool warned(const Report& report, std::string_view text) {
  const auto& all = report.warnings();
  return std::any_of(all.begin(), all.end(), [&](const Warning& w) { return w.message().find(text) != std::string::npos; });
}

Scene litSphere() {
  Scene scene;
  Material m;
  m.roughness = 0.5f;
  place(scene, sphere(1, 24, 48), m);
  addLight(scene, light(LightKind::Directional, vec3(1), 10), {0, 0, 0}, {-1, -1, -1});
  return scene;
}

}  // namespace

TEST_CASE("limits: lights past 65534 are off, on both paths alike, and a warning counts them") {
  for (const Path path : {Path::Deferred, Path::Forward}) {
    Stage stage;
    Quality quality;
    quality.path = path;
    Scene scene = litSphere();
    const Picture without = stage.linear(scene, kView, kSize, quality);
    // The first lights the sphere, and so would the last, which is past the limit; between them 65600 that reach nothing. The forward path, which asks each pixel of each light, gets a tiny picture.
    const glm::ivec2 size = path == Path::Forward ? glm::ivec2(4, 3) : kSize;
    addLight(scene, light(LightKind::Point, vec3(1), 20, 5), {0, 0, 2});
    for (int i = 0; i < 65600; ++i) addLight(scene, light(LightKind::Point, vec3(1), 1e-3f, 0.01f), {0.001 * (i % 1000) - 0.5, 1.3, 0});
    const Picture before = stage.linear(scene, kView, size, quality);
    CHECK(warned(stage.renderer->report(), "65601 point and spot lights reach into view: 65534 is the limit, those past it are off (give them shorter ranges)"));
    const int middle = size.x / 2;
    CHECK(before.at(middle, size.y / 2).x > 1.2 * without.at(kSize.x / 2, kSize.y / 2).x);
    addLight(scene, light(LightKind::Point, vec3(1), 1000, 50), {0, 0, 3});
    CHECK(same(stage.linear(scene, kView, size, quality), before));
  }
}

TEST_CASE("limits: directional lights past 8 are off, each with a warning") {
  Stage stage;
  Scene scene;
  place(scene, sphere(1, 24, 48), {});
  for (int i = 0; i < 8; ++i) addLight(scene, light(LightKind::Directional, vec3(1), 1), {0, 0, 0}, {-1, -1, -1});
  const Picture eight = stage.linear(scene, kView, kSize);
  CHECK(!warned(stage.renderer->report(), "limit"));
  Light ninth = light(LightKind::Directional, vec3(1), 50);
  ninth.name = "ninth";
  addLight(scene, ninth, {0, 0, 0}, {1, -1, -1});
  CHECK(same(stage.linear(scene, kView, kSize), eight));
  CHECK(warned(stage.renderer->report(), "ninth"));
  CHECK(warned(stage.renderer->report(), "is past the limit of 8 directional lights: it is off"));
}

TEST_CASE("limits: a texture wider than the device takes leaves the material without it") {
  Stage stage;
  const int most = stage.renderer->capabilities().maxTextureSize;
  Scene scene = litSphere();
  const Picture without = stage.linear(scene, kView, kSize);
  Texture wide;
  wide.name = "panorama";
  wide.kind = MapKind::AlbedoSubstance;
  wide.image = makeImage(most + 1, 1, 4, PixelType::U8);
  scene.materials.edit(scene.materials.at(0))->mapA = scene.textures.add(std::move(wide));
  const Picture with = stage.linear(scene, kView, kSize);
  CHECK(warned(stage.renderer->report(), "panorama"));
  CHECK(warned(stage.renderer->report(), "the material goes on without it"));
  CHECK(difference(with, without, 0).largest < 0.02);  // the default map's plastic is the factor's, to half a code
}

TEST_CASE("limits: a target past the device's size, and settings out of range") {
  Stage stage;
  const Scene scene = litSphere();
  auto target = OffscreenTarget::create(stage.context->procAddress(), kSize, Output::Display);
  REQUIRE(target);
  Target large = (*target)->target();
  large.size = {stage.renderer->capabilities().maxTextureSize + 1, 16};
  const auto done = stage.renderer->render(scene, {&kView, 1}, large, {});
  REQUIRE(!done);
  CHECK(done.error().message().find("is the device's limit") != std::string::npos);
  Quality q;
  q.transparentLayers = 100;
  q.bloom = Bloom::Scatter;
  q.bloomShare = 3;
  q.occlusion = Occlusion::Screen4;
  q.occlusionRadius = std::numeric_limits<float>::quiet_NaN();
  stage.display(scene, kView, kSize, q);
  CHECK(warned(stage.renderer->report(), "Quality::transparentLayers is 100, out of 1 to 64: 64 is used"));
  CHECK(warned(stage.renderer->report(), "Quality::bloomShare is 3, out of 0 to 1: 1 is used"));
  CHECK(warned(stage.renderer->report(), "Quality::occlusionRadius is nan"));
  // What is not asked for is not complained about.
  Stage plain;
  q.bloom = Bloom::None;
  q.occlusion = Occlusion::Baked;
  q.transparentLayers = 8;
  plain.display(scene, kView, kSize, q);
  CHECK(!warned(plain.renderer->report(), "Quality::"));
}
