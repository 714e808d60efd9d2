// Hostile and empty input: a picture without a non-finite pixel, or one clear error; never a GL error.
#include <fmt/format.h>

#include <iostream>
#include <limits>

#include "render/scenes.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
const View kView = lookAt({0, 0.5, 4}, {0, 0, 0});

Material plain() {
  Material m;
  m.albedo = {0.5f, 0.4f, 0.3f};
  m.roughness = 0.5f;
  return m;
}

void addSun(Scene& scene) { addLight(scene, light(LightKind::Directional, vec3(1), 100), {0, 0, 0}, {-0.3, -1, -1}); }
void addLamp(Scene& scene) { addLight(scene, light(LightKind::Point, vec3(1), 50, 20), {2, 2, 2}); }

/// Sphere, wall, sun, lamp and surroundings.
Scene goodScene() {
  Scene scene;
  place(scene, sphere(1, 24, 48), plain());
  place(scene, quad({0, 0, -2}, {3, 0, 0}, {0, 3, 0}), plain());
  addSun(scene);
  addLamp(scene);
  scene.environment.color = vec3(2);
  return scene;
}

/// Renders as display and as linear picture; neither may hold a non-finite pixel, nor one far over what the scene can give. Returns the linear one.
Picture checked(Stage& stage, const Scene& scene, glm::ivec2 size = {96, 64}, const View& view = kView, double brightest = 1e4) {
  RenderRequest request;
  request.countNonfinite = true;
  const Picture display = stage.draw(scene, {&view, 1}, size, {}, request);
  CHECK(display.stats.nonfinitePixels == 0);
  request.output = Output::Linear;
  Picture linear = stage.draw(scene, {&view, 1}, size, {}, request);
  CHECK(linear.stats.nonfinitePixels == 0);
  double largest = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      for (int c = 0; c < 3; ++c) largest = std::max(largest, std::isfinite(linear.at(x, y)[c]) ? linear.at(x, y)[c] : 1e300);
  CHECK(largest < brightest);
  return linear;
}

}  // namespace

TEST_CASE("zero and negative sizes are one clear error, and the renderer goes on") {
  Stage stage;
  const Scene scene = goodScene();
  for (glm::ivec2 size : {glm::ivec2(0, 0), glm::ivec2(0, 5), glm::ivec2(5, 0), glm::ivec2(-3, 4), glm::ivec2(1 << 24, 4)}) {
    Target target;
    target.size = size;
    const auto done = stage.renderer->render(scene, {&kView, 1}, target, {});
    REQUIRE(!done);
    CHECK(done.error().place == "target");
    CHECK(done.error().what.find(std::to_string(size.x)) != std::string::npos);
    CHECK(!done.error().remedy.empty());
    CHECK(!stage.renderer->pick(scene, kView, size, {0, 0}));
  }
  CHECK(!OffscreenTarget::create(stage.context->procAddress(), {0, 0}, Output::Display));
  CHECK(!stage.tryDraw(scene, {}, {8, 8}, {}, {}));  // no view
  View outside = kView;
  outside.viewport = {4, 4, 8, 8};
  CHECK(!stage.tryDraw(scene, {&outside, 1}, {8, 8}, {}, {}));
  checked(stage, scene);
}

TEST_CASE("a sun and a sky at the end of what floats hold, exposed for a dim room: lit or dark, never no number (H16)") {
  Stage stage;
  for (const Path path : {Path::Deferred, Path::Forward})
    for (const bool sky : {false, true}) {
      Scene scene;
      place(scene, sphere(1, 24, 48), plain());
      addLight(scene, light(LightKind::Directional, vec3(1), 3e38f), {0, 0, 0}, {1, -0.3, -0.1});
      scene.environment.color = vec3(sky ? 0.5f : 0.0f);
      if (sky) scene.environment.scale = 3e38f;
      Quality quality;
      quality.path = path;
      quality.exposureEv = -4.0f;  // times 13
      RenderRequest request;
      request.countNonfinite = true;
      const Picture p = stage.draw(scene, {&kView, 1}, {64, 64}, quality, request);
      INFO("path " << int(path) << ", sky " << sky);
      CHECK(p.stats.nonfinitePixels == 0);
      CHECK(p.at(20, 32).x > 0.9);
      CHECK((p.at(44, 32).x > 0.9) == sky);
      CHECK(p.at(2, 32).x == (sky ? 1 : 0));
    }
}

TEST_CASE("the smallest and the oddest targets") {
  Stage stage;
  const Scene scene = goodScene();
  const Picture whole = checked(stage, scene, {1, 1});
  CHECK(whole.at(0, 0).x > 1);
  for (glm::ivec2 size : {glm::ivec2(1, 300), glm::ivec2(300, 1), glm::ivec2(17, 33), glm::ivec2(16, 16)}) checked(stage, scene, size);
}

TEST_CASE("empty scenes, and scenes with only one kind of thing") {
  Stage stage;
  CHECK(checked(stage, Scene{}).at(5, 5) == dvec3(0));
  Scene lights;
  addSun(lights);
  addLamp(lights);
  CHECK(checked(stage, lights).at(5, 5) == dvec3(0));
  Scene meshes;
  place(meshes, sphere(1, 8, 16), plain());
  CHECK(checked(stage, meshes).at(48, 32) == dvec3(0));
  Scene sky;
  sky.environment.color = {1, 2, 3};
  CHECK(checked(stage, sky).at(48, 32) == dvec3(1, 2, 3));
  Scene empty = goodScene();
  place(empty, Mesh{}, plain());
  Instance loose;  // nothing behind it
  empty.instances.add(loose);
  loose.mesh = {77, 3};
  loose.material = {99, 1};
  loose.node = {55, 2};
  empty.instances.add(loose);
  const Picture p = checked(stage, empty);
  CHECK(same(p, checked(stage, goodScene())));
}

TEST_CASE("degenerate triangles and broken index lists") {
  Stage stage;
  const Picture good = checked(stage, goodScene());
  Scene scene = goodScene();
  Mesh flat = quad({0, 1, 0}, {1, 0, 0}, {0, 1, 0});
  flat.positions.assign(4, vec3(0.5f));
  place(scene, flat, plain());
  Mesh line = quad({0, 1, 0}, {1, 0, 0}, {0, 1, 0});
  for (std::size_t i = 0; i < 4; ++i) line.positions[i] = vec3(float(i), 0, 0);
  place(scene, line, plain());
  Mesh out = quad({0, 1, 0}, {1, 0, 0}, {0, 1, 0});
  out.indices[3] = 1000;
  place(scene, out, plain());
  Mesh odd = quad({0, 1, 0}, {1, 0, 0}, {0, 1, 0});
  odd.indices.pop_back();
  place(scene, odd, plain());
  CHECK(same(checked(stage, scene), good));
  bool told = false;
  for (const Warning& w : stage.renderer->report().warnings()) told |= w.what.find("1000") != std::string::npos;
  CHECK(told);
}

TEST_CASE("singular, negative and non-finite transforms") {
  Stage stage;
  const auto scaled = [](dvec3 s) {
    glm::dmat4 m(1);
    for (int i = 0; i < 3; ++i) m[i][i] = s[i];
    return m;
  };
  SECTION("singular") {
    for (dvec3 s : {dvec3(0, 0, 0), dvec3(1, 0, 1), dvec3(0, 0, 1), dvec3(1e-30, 1e-30, 1e-30), dvec3(1e-9, 1, 1e9)}) {
      Scene scene = goodScene();
      place(scene, sphere(1, 12, 24), plain(), scaled(s));
      checked(stage, scene);
    }
  }
  SECTION("a mirrored sphere is the sphere, lit from the same side") {
    Scene scene, mirrored;
    place(scene, sphere(1, 48, 96), plain());
    place(mirrored, sphere(1, 48, 96), plain(), scaled({-1, 1, 1}));
    addSun(scene);
    addSun(mirrored);
    const Picture a = checked(stage, scene), b = checked(stage, mirrored);
    const Errors e = difference(a, b, 0.15);
    CHECK(e.share() > 0.99);  // the triangles' edges differ, the shading does not
    CHECK(b.at(48, 25).x > 5);
    Scene dark;
    place(dark, sphere(1, 48, 96), plain(), scaled({-1, -1, -1}));
    addLight(dark, light(LightKind::Directional, vec3(1), 100), {0, 0, 0}, {0, -0.4, 1});  // from behind
    CHECK(checked(stage, dark).at(48, 32) == dvec3(0));
  }
  SECTION("non-finite and huge") {
    for (double bad : {double(kNan), double(kInf), 1e300, -1e38}) {
      Scene scene = goodScene();
      place(scene, sphere(1, 12, 24), plain(), translation({bad, 0, 0}));
      place(scene, sphere(1, 12, 24), plain(), scaled({1, bad, 1}));
      checked(stage, scene);
    }
  }
}

TEST_CASE("NaN and infinity in vertices") {
  Stage stage;
  for (float bad : {kNan, kInf, -kInf, 3e38f}) {
    for (int stream = 0; stream < 6; ++stream) {
      INFO("value " << bad << ", stream " << stream);
      Scene scene = goodScene();
      Mesh m = sphere(1, 12, 24);
      m.tangents.assign(m.positions.size(), vec4(1, 0, 0, 1));
      m.uv1 = m.uv0;
      m.colors.assign(m.positions.size(), vec4(1));
      for (std::size_t i = 0; i < m.positions.size(); i += 7) {
        if (stream == 0) m.positions[i].y = bad;
        if (stream == 1) m.normals[i].x = bad;
        if (stream == 2) m.tangents[i].z = bad;
        if (stream == 3) m.uv0[i].x = bad;
        if (stream == 4) m.uv1[i].y = bad;
        if (stream == 5) m.colors[i] = vec4(bad);
      }
      place(scene, m, plain(), translation({0.5, 0, 1}));
      checked(stage, scene);
    }
  }
}

TEST_CASE("zero normals and tangents, with a normal map") {
  Stage stage;
  for (int which = 0; which < 3; ++which) {
    Scene scene = goodScene();
    Mesh m = sphere(1, 24, 48);
    m.tangents.assign(m.positions.size(), which == 1 ? vec4(0) : vec4(1, 0, 0, 1));
    if (which != 1)
      for (std::size_t i = 0; i < m.normals.size(); i += which == 0 ? 1 : 2) m.normals[i] = vec3(0);
    Texture normals;
    normals.kind = MapKind::NormalRoughness;
    normals.image = makeImage(4, 4, 4, PixelType::U8);
    for (std::size_t i = 0; i < 64; ++i) normals.image.data[i] = std::byte(i * 4 % 256);
    Material material = plain();
    material.mapB = scene.textures.add(normals);
    place(scene, m, material, translation({0.5, 0, 1}));
    checked(stage, scene);
  }
}

TEST_CASE("NaN and infinity in lights") {
  Stage stage;
  const Picture good = checked(stage, goodScene());
  for (float bad : {kNan, kInf, -kInf}) {
    for (LightKind kind : {LightKind::Directional, LightKind::Point, LightKind::Spot}) {
      INFO("value " << bad << ", kind " << int(kind));
      for (int field = 0; field < 3; ++field) {
        INFO("field " << field);
        Scene scene = goodScene();
        Light l = light(kind, vec3(1), 10, 5);
        if (field == 0) l.intensity = bad;
        if (field == 1) l.color.g = bad;
        addLight(scene, l, field == 2 && kind != LightKind::Directional ? dvec3(bad, 0, 0) : dvec3(0, 1, 2));
        if (field == 2 && kind == LightKind::Directional) continue;  // it has no position
        const Picture p = checked(stage, scene);
        if (field < 2) CHECK(same(p, good));  // the light is off; a node that is not finite counts as identity
      }
      Scene cones = goodScene();
      Light l = light(kind, vec3(1), 10, bad);
      l.innerCone = bad;
      l.outerCone = bad;
      addLight(cones, l, {0, 1, 2}, {0, -1, -1});
      checked(stage, cones);
      Scene directions = goodScene();
      Light turned = light(kind, vec3(1), 10, 5);
      glm::dmat4 m(1);
      m[2] = glm::dvec4(bad, 0, bad, 0);
      turned.node = addNode(directions, m);
      directions.lights.add(turned);
      checked(stage, directions);
    }
  }
}

TEST_CASE("lights on the surface, inside it, at the eye, and of absurd power") {
  Stage stage;
  Scene scene = goodScene();
  addLight(scene, light(LightKind::Point, vec3(1), 1, 5), {0, 0, 1});  // on the sphere
  addLight(scene, light(LightKind::Point, vec3(1), 1, 5), {0, 0, 0});
  addLight(scene, light(LightKind::Point, vec3(1), 1, 5), kView.eye);
  Light needle = light(LightKind::Spot, vec3(1), 1, 5);
  needle.outerCone = needle.innerCone = 0;
  addLight(scene, needle, {0, 0, 2});
  checked(stage, scene, {96, 64}, kView, 1e6);
  addLight(scene, light(LightKind::Point, vec3(1), 3e38f, 100), {0, 3, 3});
  addLight(scene, light(LightKind::Directional, vec3(1), 3e38f), {0, 0, 0}, {0, -1, -1});
  addLight(scene, light(LightKind::Point, vec3(1), 1e-38f), {0, 3, 3});
  checked(stage, scene, {96, 64}, kView, 1e300);
}

TEST_CASE("NaN and infinity in materials, textures and surroundings") {
  Stage stage;
  for (float bad : {kNan, kInf, -kInf, 1e38f, -1.0f}) {
    INFO("value " << bad);
    Scene scene = goodScene();
    Material m;
    m.albedo = vec3(bad);
    m.roughness = m.substance = m.opacity = m.alphaCutoff = m.occlusionStrength = m.metalness = bad;
    m.alphaTest = true;
    place(scene, sphere(0.5f, 12, 24), m, translation({-1, 0, 1}));
    m.alphaTest = false;
    m.uvA.transform = glm::mat3x2(bad, bad, bad, bad, bad, bad);
    place(scene, sphere(0.5f, 12, 24), m, translation({1, 0, 1}));
    checked(stage, scene);
    m.emission = vec3(bad);
    place(scene, sphere(0.5f, 12, 24), m, translation({1, 0, 1}));
    checked(stage, scene, {96, 64}, kView, 1e300);

    Scene one = goodScene();  // one channel is bad, the others go on
    one.environment.color = {bad, 2, 2};
    const dvec3 behind = checked(stage, one, {96, 64}, kView, 1e300).at(0, 0);
    if (bad != 1e38f) CHECK(behind == dvec3(0, 2, 2));

    Scene sky = goodScene();
    sky.environment.color = vec3(bad);
    checked(stage, sky, {96, 64}, kView, 1e300);
    sky.environment.map = makeImage(16, 8, 3, PixelType::F32);
    for (std::size_t i = 0; i < 16 * 8 * 3; ++i) sky.environment.map.f32()[i] = i % 5 == 0 ? bad : 1.0f;
    ++sky.environment.revision;
    checked(stage, sky, {96, 64}, kView, 1e6);
    sky.environment.scale = bad;
    checked(stage, sky, {96, 64}, kView, 1e300);
  }
  Scene floats = goodScene();
  Texture wrong;  // a float picture where bytes are asked for
  wrong.image = makeImage(2, 2, 4, PixelType::F32);
  for (int i = 0; i < 16; ++i) wrong.image.f32()[i] = kNan;
  Material m = plain();
  m.mapA = floats.textures.add(wrong);
  place(floats, sphere(1, 12, 24), m, translation({0.5, 0, 1}));
  checked(stage, floats);
  CHECK(!stage.renderer->report().empty());
}

TEST_CASE("views with values out of range") {
  Stage stage;
  const Scene scene = goodScene();
  std::vector<View> views(9, kView);
  views[0].fovY = kNan;
  views[1].fovY = 0;
  views[2].fovY = 7;
  views[3].near = 0;
  views[4].near = kInf;
  views[5].far = 0.01f;
  views[6].orthographic = true;
  views[6].height = 0;
  views[7].axes = glm::dmat3(0);
  views[8].eye = dvec3(double(kNan));
  for (const View& v : views) checked(stage, scene, {64, 48}, v);
  checked(stage, scene, {64, 48}, lookAt({1, 1, 1}, {1, 1, 1}));
  checked(stage, scene, {64, 48}, lookAt({0, 4, 0}, {0, 0, 0}, {0, 1, 0}));
}

TEST_CASE("a thousand kilometres from the origin the picture is the same") {
  Stage stage;
  const auto make = [](dvec3 at) {
    Scene scene;
    const glm::dmat4 m = translation(at);
    place(scene, sphere(1, 48, 96), plain(), m);
    place(scene, quad({0, -1, 0}, {4, 0, 0}, {0, 0, -4}), plain(), m);
    addSun(scene);
    addLight(scene, light(LightKind::Point, {1, 0.5f, 0.2f}, 20, 6), at + dvec3(1.5, 1.5, 1.5));
    Light spot = light(LightKind::Spot, {0.2f, 0.5f, 1}, 60, 8);
    spot.innerCone = 0.2f;
    addLight(scene, spot, at + dvec3(-2, 2, 1), {1, -1, -0.5});
    scene.environment.color = vec3(1);
    return scene;
  };
  const dvec3 far(1e6, 3e5, -1e6);
  Quality quality;
  quality.exposureEv = 4.0f;
  const View here = lookAt({1, 1.5, 4}, {0, 0, 0}), there = lookAt(far + dvec3(1, 1.5, 4), far);
  const Picture a = stage.display(make({0, 0, 0}), here, {320, 200}, quality), b = stage.display(make(far), there, {320, 200}, quality);
  const Errors e = difference(a, b, 1.0 / 255);
  std::cout << fmt::format("  1e6 m from the origin: {:.3f} % of pixels within 1/255, largest {:.0f}/255\n", 100 * e.share(), e.largest * 255);
  CHECK(e.share() >= 0.999);
  CHECK(a.at(160, 100).x > 0.1);
}
