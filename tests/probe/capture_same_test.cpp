// What a capture depends on: the scene and the point, and nothing else that was ever drawn (H6 of docs/hard_cases.md).
#include "probe/probes.h"

using namespace burnish;
using namespace burnish::test;

namespace {

/// A sun, spots and point lights with shadows, and a blended surface: what keeps something between frames.
Scene busy() {
  Scene scene;
  Material floor, metal, glass, lamp;
  floor.albedo = vec3(0.6f, 0.5f, 0.4f);
  metal.substance = 1;
  metal.albedo = vec3(0.9f, 0.7f, 0.4f);
  metal.roughness = 0.3f;
  glass.blend = true;
  glass.opacity = 0.4f;
  lamp.emission = vec3(30, 20, 10);
  place(scene, box({-4, -1, -4}, {4, -0.9f, 4}), floor);
  place(scene, sphere(0.7f, 16, 24), metal, translation({1.5, 0, -1}));
  place(scene, box({-0.4f, -0.4f, -0.4f}, {0.4f, 0.4f, 0.4f}), glass, translation({-1.2, 0, -0.5}));
  place(scene, box({-0.1f, -0.1f, -0.1f}, {0.1f, 0.1f, 0.1f}), lamp, translation({0, 1.5, 1.5}));
  Light sun = light(LightKind::Directional, {1, 0.9f, 0.8f}, 20), spot = light(LightKind::Spot, {0.5f, 0.7f, 1}, 60, 12), point = light(LightKind::Point, {1, 0.4f, 0.2f}, 25, 8);
  sun.castsShadow = spot.castsShadow = point.castsShadow = true;
  addLight(scene, sun, {0, 0, 0}, {-0.4, -1, -0.3});
  addLight(scene, spot, {2, 2.5, 2}, {-1, -1, -1});
  addLight(scene, point, {-2, 1, 1});
  addLight(scene, light(LightKind::Point, {0.3f, 1, 0.5f}, 10, 6), {0.5, 0.4, -2.5});
  scene.environment.color = vec3(0.2f, 0.3f, 0.5f);
  return scene;
}

Quality demanding() {
  Quality q;
  q.shadowResolution = 256;
  q.antialiasing = Antialiasing::Temporal;
  q.occlusion = Occlusion::Screen8;
  q.bloom = Bloom::Scatter;
  return q;
}

}  // namespace

TEST_CASE("capture: the same bytes as six views of a fresh renderer, whatever is drawn in between", "[h6]") {
  const Scene scene = busy();
  const dvec3 eye(0.2, 0.3, 0.4);
  constexpr int kSize = 32;
  Observatory o(scene, demanding());
  // Somewhere else before: what that leaves behind must not show.
  o.radiance({-3, 2, 3}, kSize);
  const CubeLevel small = o.radiance(eye, 16);
  const CubeLevel before = o.radiance(eye, kSize);
  {
    // Six views through the public interface.
    Stage stage;
    RenderRequest request;
    request.output = Output::Linear;
    const Picture picture = stage.draw(scene, probe::faceViews(eye, probe::captureNear(scene), kSize), {3 * kSize, 2 * kSize}, probe::captureQuality(demanding()), request);
    int differ = 0;
    double brightest = 0, darkest = 1e9;
    eachTexel(before, [&](int face, int x, int y, const dvec3&, const dvec3& l) {
      differ += l != picture.at(face % 3 * kSize + x, 2 * kSize - 1 - (face / 3 * kSize + y));
      brightest = std::max(brightest, l.x);
      darkest = std::min(darkest, l.x);
    });
    CHECK(differ == 0);
    CHECK(brightest > 20 * darkest);  // there was something to see
  }
  {
    REQUIRE(o.context->makeCurrent());
    // Another renderer on the same context, with histories and shadow maps of views of its own.
    auto other = Renderer::create(o.context->procAddress(), {});
    REQUIRE(other);
    auto target = OffscreenTarget::create(o.context->procAddress(), {96, 64}, Output::Display);
    REQUIRE(target);
    Scene moving = scene;
    for (int frame = 0; frame < 3; ++frame) {
      const View view = lookAt({3.0 - frame, 1, 3}, {0, 0, 0});
      moving.nodes.edit(moving.instances.get(moving.instances.at(1))->node)->local = translation({1.5 - frame, 0, -1});
      Quality q;
      q.antialiasing = Antialiasing::Temporal;
      REQUIRE((*other)->render(moving, {&view, 1}, (*target)->target(), q, {}));
    }
    CHECK(o.radiance(eye, 32).texels == before.texels);
  }
  for (const dvec3 elsewhere : {dvec3(-3, 2, 3), dvec3(0.2, 0.3, 0.5)}) {
    const CubeLevel there = o.radiance(elsewhere, 32);
    CHECK(there.texels != before.texels);
    CHECK(o.radiance(eye, 32).texels == before.texels);
  }
  CHECK(o.radiance(eye, 16).texels == small.texels);
  // A camera in the scene changes nothing.
  Scene filmed = scene;
  filmed.cameras.add(Camera{.node = addNode(filmed, translation({1, 1, 1}))});
  Observatory again(std::move(filmed), demanding());
  CHECK(again.radiance(eye, 32).texels == before.texels);
}

TEST_CASE("capture: lit by the probes that it has, and by no others") {
  Scene scene;
  Material wall;
  wall.albedo = vec3(0.5f);
  addRoom(scene, vec3(-1), vec3(1), wall);
  scene.environment.color = vec3(9);
  ProbeSet places;
  places.reflections.push_back(probeIn(vec3(-1), vec3(1), {0.2, 0.1, 0}));
  BakeOptions options;
  options.size = 16;
  const auto lit = [&](double light) {
    probe::PointLight one{probe::blackLight(places, options).reflections[0].radiance, {}};
    for (CubeLevel& level : one.radiance.levels) std::fill(level.texels.begin(), level.texels.end(), float(light));
    for (double& c : one.irradiance[0]) c = light;
    return probe::withLight(places, std::vector{one});
  };
  Observatory o(scene);
  const dvec3 eye(-0.3, 0.2, 0.4);
  // Without probes the sky gets in; black ones keep it out.
  const CubeLevel sky = o.radiance(eye, 16);
  CHECK(texel(sky, 0, 8, 8).x > 3);
  o.capture->setProbes(probe::blackLight(places, options));
  for (const float v : o.radiance(eye, 16).texels) REQUIRE(v == 0);
  std::vector<CubeLevel> seen;
  for (const double light : {1.0, 2.0, 1.0}) {
    o.capture->setProbes(lit(light));
    seen.push_back(o.radiance(eye, 16));
  }
  CHECK(seen[0].texels == seen[2].texels);
  for (std::size_t i = 0; i < seen[0].texels.size(); ++i) REQUIRE(double(seen[1].texels[i]) == Approx(2 * double(seen[0].texels[i])).epsilon(1e-5));
  // As the scene with those probes, through the public interface.
  Stage stage;
  Scene with = scene;
  with.probes = lit(2);
  with.environment.background = true;
  RenderRequest request;
  request.output = Output::Linear;
  const Picture p = stage.draw(with, probe::faceViews(eye, probe::captureNear(scene), 16), {48, 32}, probe::captureQuality({}), request);
  std::size_t mended = 0;
  CHECK(probe::facesOf(p.image, 16, mended).texels == seen[1].texels);
}
