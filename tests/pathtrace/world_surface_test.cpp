// Materials at a hit are what the maps, factors and frames say: against decoding by hand, and against geometry.
#include <burnish/material.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "world_scenes.h"

using namespace burnish;
using namespace burnish::test;
using pathtrace::SurfacePoint;
using pathtrace::World;

namespace {

double linearOf(int code) {
  const double x = code / 255.0;
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}
void near(const glm::vec3& a, const glm::vec3& b, double bound) {
  CAPTURE(a.x, a.y, a.z, b.x, b.y, b.z);
  CHECK(glm::length(glm::dvec3(a) - glm::dvec3(b)) <= bound);
}
SurfacePoint fromFront(const Scene& scene, const glm::dvec2& at = {0.25, 0.25}) { return met(worldOf(scene), toward({at, 2}, {at, 0})); }

}  // namespace

TEST_CASE("world: maps, factors and vertex colours make the surface", "[world]") {
  Scene scene;
  Material m;
  m.mapA = addTexture(scene, MapKind::AlbedoSubstance, plain(4, 4, {200, 100, 50, 180}));
  m.mapB = addTexture(scene, MapKind::NormalRoughness, plain(4, 4, {128, 128, 255, 150}));
  m.emissiveMap = addTexture(scene, MapKind::Emissive, plain(4, 4, {255, 128, 0, 255}));
  m.albedo = {0.5f, 1, 0.25f};
  m.roughness = 0.8f;
  m.emission = {2, 4, 8};
  Mesh mesh = panel();
  mesh.colors.assign(4, glm::vec4(0.5f, 0.25f, 1, 1));
  add(scene, mesh, m);
  const SurfacePoint p = fromFront(scene);
  near(p.albedo, {0.25 * linearOf(200), 0.25 * linearOf(100), 0.25 * linearOf(50)}, 1e-6);
  CHECK(p.substance == Approx(180 / 255.0));
  CHECK(p.alpha == Approx(std::pow(150 / 255.0 * 0.8, 2)).epsilon(1e-5));
  near(p.emission, {2, 4 * linearOf(128), 0}, 1e-5);
  near(p.normal, {0, 0, 1}, 1e-6);
  CHECK(p.distance == Approx(2));
  CHECK_FALSE(p.back);
  CHECK(p.emitter >= 0);
}

TEST_CASE("world: metal-rough maps kept apart take metalness and roughness from there", "[world]") {
  Scene scene;
  Material m;
  m.metalRoughMap = addTexture(scene, MapKind::MetalRough, plain(2, 2, {0, 102, 204, 255}));
  m.metalness = 0.5f;
  m.roughness = 1;
  add(scene, panel(), m);
  const SurfacePoint p = fromFront(scene);
  CHECK(p.substance == Approx(encodeMetalness(204 / 255.0f * 0.5f)));
  CHECK(p.alpha == Approx(std::pow(102 / 255.0, 2)).epsilon(1e-5));
  m.metalness = 0.005f;
  Scene plastic;
  m.metalRoughMap = addTexture(plastic, MapKind::MetalRough, plain(2, 2, {0, 102, 204, 255}));
  add(plastic, panel(), m);
  CHECK(fromFront(plastic).substance == Approx(1 / 3.0));
}

TEST_CASE("world: a normal map's red leans along u, its green against v, mirrored or not, from both sides", "[world]") {
  // (225, 178, 219): x 97/127, y 50/127.
  const glm::vec3 mapped = glm::normalize(glm::vec3(97, 50, 219 * 255.0f / 255 - 128) / 127.0f);
  struct Case {
    bool mirroredU, mirroredInstance;
  };
  for (const Case c : {Case{false, false}, Case{true, false}, Case{false, true}}) {
    CAPTURE(c.mirroredU, c.mirroredInstance);
    Scene scene;
    Material m;
    m.mapB = addTexture(scene, MapKind::NormalRoughness, plain(4, 4, {225, 178, 219, 255}));
    m.twoSided = true;
    Mesh mesh = panel();
    if (c.mirroredU)
      for (glm::vec2& uv : mesh.uv0) uv.x = 1 - uv.x;
    glm::dmat4 local(1);
    if (c.mirroredInstance) local[0][0] = -1;
    add(scene, mesh, m, local);
    const World world = worldOf(scene);
    const float along = c.mirroredU != c.mirroredInstance ? -1.0f : 1.0f;
    near(met(world, toward({0.25, 0.25, 2}, {0.25, 0.25, 0})).normal, {along * mapped.x, mapped.y, mapped.z}, 2e-6);
    const SurfacePoint back = met(world, toward({0.25, 0.25, -2}, {0.25, 0.25, 0}));
    CHECK(back.back);
    near(back.normal, {-along * mapped.x, -mapped.y, -mapped.z}, 2e-6);
    near(back.geometric, {0, 0, -1}, 1e-6);
  }
}

TEST_CASE("world: the camera's rays read the level of their footprint, other rays level 0", "[world]") {
  Scene scene;
  Material m;
  Image checker = plain(64, 64, {255, 255, 255, 85});
  for (std::size_t i = 0; i < checker.pixelCount(); ++i)
    if ((i % 64 + i / 64) % 2)
      for (std::size_t c = 0; c < 3; ++c) checker.u8()[i * 4 + c] = 0;
  m.mapA = addTexture(scene, MapKind::AlbedoSubstance, checker);
  add(scene, panel(), m);
  // 4 pixels over a panel of 64 texels: level 4, where all is the mean. 1000 pixels: level 0.
  for (const auto& [size, mean] : {std::pair{4, true}, std::pair{1000, false}}) {
    const View view = lookAt({0, 0, 1}, {0, 0, 0}, {0, 1, 0}, float(2 * std::atan(1.0)));
    const World world = worldOf(scene, {}, view, {size, size});
    pathtrace::PathRay ray = world.cameraRay({size * 0.5 + size / 128.0, size * 0.5 + size / 128.0});  // the middle of a texel
    const float seen = met(world, ray).albedo.r;
    if (mean) CHECK(seen == Approx(0.5).margin(0.005));
    else CHECK((seen < 0.02f || seen > 0.98f));
    ray.camera = false;
    const float bare = met(world, ray).albedo.r;
    CHECK((bare < 0.02f || bare > 0.98f));
  }
}

TEST_CASE("world: holes are passed by rays of every kind", "[world]") {
  Scene scene;
  Material m;
  m.alphaTest = true;
  m.alphaCutoff = 0.5f;
  Image opacity = makeImage(2, 1, 2, PixelType::U8);
  opacity.u8()[0] = opacity.u8()[2] = 255;
  opacity.u8()[1] = 255;  // the left half is there, the right one is not
  opacity.u8()[3] = 0;
  Sampler nearest;
  nearest.magnifyLinear = nearest.minifyLinear = nearest.mips = false;
  m.mapC = addTexture(scene, MapKind::Occlusion, opacity, nearest);
  add(scene, panel(), m);
  add(scene, panel(), Material{}, moved({0, 0, -1}));
  const World world = worldOf(scene);
  CHECK(met(world, toward({-0.5, 0, 2}, {-0.5, 0, 0})).distance == Approx(2));
  const SurfacePoint behind = met(world, toward({0.5, 0, 2}, {0.5, 0, 0}));
  CHECK(behind.distance == Approx(3));
  for (const pathtrace::Bodies bodies : {pathtrace::Bodies::Straight, pathtrace::Bodies::Block}) {
    // Non-casters keep no punctual light off.
    CHECK(world.transmittance(behind, {0.5, 0, 2}, bodies) == glm::vec3(1));
    CHECK(world.transmittance(behind, {-1.2, 0, 0.7}, bodies) == glm::vec3(0));
    CHECK(world.transmittance(behind, {-0.5, 0, -0.5}, bodies) == glm::vec3(1));
  }
}

TEST_CASE("world: what casts no shadow keeps off no punctual light, but all else", "[world]") {
  Scene scene;
  const Id<Instance> screen = add(scene, panel(), Material{});
  add(scene, panel(), Material{}, moved({0, 0, -1}));
  scene.instances.edit(screen)->castsShadow = false;
  const World world = worldOf(scene);
  pathtrace::PathRay ray = toward({0, 0, -0.5}, {0, 0, -1});
  const SurfacePoint p = met(world, ray);
  CHECK(world.transmittance(p, {0, 0, 2}, pathtrace::Bodies::Straight) == glm::vec3(1));
  CHECK(world.transmittance(p, {0, 0, 2}, pathtrace::Bodies::Block) == glm::vec3(0));
  CHECK(world.transmittanceAlong(p, {0, 0, 1}, pathtrace::Bodies::Block) == glm::vec3(0));
}

TEST_CASE("world: blended surfaces and panes let their share through, the same for the path and for shadow rays", "[world]") {
  for (const bool glass : {false, true}) {
    CAPTURE(glass);
    Scene scene;
    Material m;
    m.albedo = {0.5f, 0.75f, 1};
    m.roughness = 0;
    if (glass) m.transmission = 1, m.ior = 1.5f, m.substance = 0.4f;
    else m.blend = true, m.opacity = 0.25f;
    add(scene, panel(), m);
    add(scene, panel(), Material{}, moved({0, 0, -1}));
    const World world = worldOf(scene);
    const SurfacePoint pane = met(world, toward({0, 0, 2}, {0, 0, 0})), wall = met(world, toward({0, 0, -0.5}, {0, 0, -1}));
    const glm::vec3 share = world.crossing(pane, {0, 0, 1});
    near(share, world.transmittance(wall, {0, 0, 2}, pathtrace::Bodies::Block), 1e-6);
    // F = 0.04: a pane passes (1 - F)^2 a/(1 - F^2 a^2); a blended surface 3/4 of what its lobe does not reflect, 0.04 at normal incidence.
    const glm::dvec3 a(m.albedo), exact = glass ? 0.96 * 0.96 * a / (1.0 - 0.0016 * a * a) : glm::dvec3(0.75 * 0.96);
    near(share, exact, 0.003);
    pathtrace::PathRay on = world.past(toward({0, 0, 2}, {0, 0, 0}), pane);
    CHECK(met(world, on).distance == Approx(3));
  }
}

TEST_CASE("world: the camera passes the backs of one-sided surfaces, other rays meet them", "[world]") {
  Scene scene;
  add(scene, panel(), Material{});
  const View behind = lookAt({0, 0, -4}, {0, 0, 0});
  const World world = worldOf(scene, {}, behind);
  pathtrace::PathRay ray = world.cameraRay({16, 16});
  SurfacePoint p;
  CHECK_FALSE(world.nearest(ray, p));
  ray.camera = false;
  CHECK(met(world, ray).back);
}

TEST_CASE("world: degenerate frames give finite unit normals", "[world][H18]") {
  Scene scene;
  Material m;
  m.mapB = addTexture(scene, MapKind::NormalRoughness, plain(2, 2, {1, 128, 128, 255}));
  Mesh mesh = panel();
  mesh.normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, 1}, {0, 0, -1}};  // they cancel inside
  mesh.uv0.assign(4, glm::vec2(0.5f));                             // no tangent
  add(scene, mesh, m);
  glm::dmat4 flat(1);
  flat[2] = glm::dvec4(0);  // a singular placement
  flat[3] = glm::dvec4(3, 0, 0, 1);
  add(scene, mesh, m, flat);
  const World world = worldOf(scene);
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y)
      for (const double middle : {0.0, 3.0}) {
        const glm::dvec2 at(-0.9 + x * 0.257 + middle, -0.9 + y * 0.257);
        const SurfacePoint p = met(world, toward({at, 2}, {at, 0}));
        CHECK(glm::length(p.normal) == Approx(1).margin(1e-4));
        CHECK(glm::length(p.geometric) == Approx(1).margin(1e-4));
      }
}
