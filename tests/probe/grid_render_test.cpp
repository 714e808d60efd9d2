// Pictures lit by a lattice: against the shading text in double and the oracle, deferred against forward, transparent surfaces, and what the plan says.
#include <fmt/format.h>

#include <algorithm>

#include "gpu_scene/grid.h"
#include "grid_room.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr int kPixels = 64;

/// From the middle of the cube onto one wall, which fills the picture.
View onto(int wall) {
  View v;
  const dvec3 back = wallNormal(wall), up = wall / 2 == 1 ? dvec3(0, 0, 1) : dvec3(0, 1, 0);
  v.eye = dvec3(0.5);
  v.axes = {glm::cross(up, back), up, back};
  v.fovY = float(kPi / 2);
  v.near = 0.01f;
  return v;
}
/// Where the ray through a pixel's middle meets that wall.
dvec3 placeOf(const View& view, int wall, int x, int y) {
  const Ray r = rayThrough(view, {kPixels, kPixels}, x + 0.5, y + 0.5);
  return r.origin + r.direction * (-0.5 / dot(r.direction, wallNormal(wall)));
}

/// Pixels as shares of what the second shows, and 2 % of its mean.
Errors shares(const Picture& a, const Picture& b, double bound) {
  double mean = 0;
  for (int y = 0; y < b.image.height; ++y)
    for (int x = 0; x < b.image.width; ++x) mean += b.at(x, y).x / double(b.image.pixelCount());
  Errors e;
  for (int y = 0; y < b.image.height; ++y)
    for (int x = 0; x < b.image.width; ++x) {
      const dvec3 p = a.at(x, y), q = b.at(x, y), d = glm::abs(p - q);
      e.add(std::max({d.x, d.y, d.z}) / (std::max({q.x, q.y, q.z}) + 0.02 * mean), bound);
    }
  return e;
}

}  // namespace

TEST_CASE("a picture lit by a lattice is what the text says in double, and near the oracle") {
  Stage stage;
  for (const double albedo : {0.2, 0.5, 0.8}) {
    const CubeOracle oracle(albedo, 20);
    Scene scene;
    place(scene, box({0, 0, 0}, {1, 1, 1}, true), white());
    setGrid(scene, gridOf(oracle));
    const GridSampler sampler(*scene.probes.grid);
    for (const int wall : {2, 3, 5}) {
      const View view = onto(wall);
      const Picture picture = stage.linear(scene, view, {kPixels, kPixels}, bare());
      REQUIRE(stage.renderer->lastPlan().on("ambient_grid"));
      double text = 0, mean = 0, worst = 0, atEdge = 0;
      for (int y = 0; y < kPixels; ++y)
        for (int x = 0; x < kPixels; ++x) {
          const dvec3 p = placeOf(view, wall, x, y), n = wallNormal(wall), shown = picture.at(x, y);
          const GridLight l = sampler.at(p, n);
          text = std::max(text, std::abs(shown.x / l.light.x - 1));
          REQUIRE(shown.y == Approx(0.5 * shown.x).epsilon(2e-3));
          // Every other pixel each way: what is 1/32 of the side from the edges and farther, and nearer.
          if (x % 2 || y % 2) continue;
          const double off = std::abs(shown.x / oracle.irradiance(p, n) - 1), edge = (std::min({x, y, kPixels - 1 - x, kPixels - 1 - y}) + 0.5) / kPixels;
          mean += off / (kPixels * kPixels / 4.0);
          (edge >= 1.0 / 32 ? worst : atEdge) = std::max(edge >= 1.0 / 32 ? worst : atEdge, off);
        }
      WARN(fmt::format("albedo {}, wall {}: picture off the text by at most {:.3f} %, off the oracle by {:.1f} % on the mean, {:.1f} % at worst, {:.1f} % within 1/32 of the edges", albedo, wall, 100 * text, 100 * mean, 100 * worst, 100 * atEdge));
      // Half floats round each coefficient by 2^-11 of it, and three bands sum up to a few times their result under a bright ceiling; planes' rounding moves what a point sees where that changes.
      CHECK(text < 0.02);
      CHECK(mean < 0.05);
      CHECK(worst < 0.15);
    }
  }
}

TEST_CASE("half floats keep a lattice's constant") {
  AmbientGrid::Point p;
  for (const float v : {1e-30f, 3e-6f, 0.7f, 1e5f, 3e38f}) {
    p.valid = true;
    p.irradiance = {glm::vec3(v)};
    AmbientGrid grid;
    grid.points = {p};
    const float scale = gpu_scene::lightScale(grid);
    REQUIRE(scale > 0);
    const auto words = gpu_scene::packedLight(p, scale);
    REQUIRE(words.size() == 16);
    const std::uint32_t bits = words[0] & 0xffff, exponent = bits >> 10, mantissa = bits & 0x3ff;
    const double half = exponent ? std::ldexp(1 + mantissa / 1024.0, int(exponent) - 15) : std::ldexp(mantissa / 1024.0, -14);
    CHECK(half * double(scale) == Approx(v).epsilon(1.0 / 2048));
  }
}

TEST_CASE("constant light of a lattice is constant in the picture") {
  Stage stage;
  Scene scene = furnished(0.5);
  scene.materials.each([&](Id<Material> id, const Material&) { scene.materials.edit(id)->albedo = {1, 1, 1}; });
  for (auto& p : scene.probes.grid->points) p.irradiance = {glm::vec3(0.7f, 70, 7000)};
  ++scene.probes.revision;
  const Picture picture = stage.linear(scene, intoRoom(), {96, 72}, bare());
  for (int y = 0; y < 72; ++y)
    for (int x = 0; x < 96; ++x) {
      const dvec3 c = picture.at(x, y);
      CAPTURE(x, y);
      CHECK(c.x == Approx(0.7).epsilon(1.0 / 1024));
      CHECK(c.y == Approx(70).epsilon(1.0 / 1024));
      CHECK(c.z == Approx(7000).epsilon(1.0 / 1024));
    }
}

TEST_CASE("deferred equals forward under a lattice, every rung of ambient") {
  Stage stage;
  const Scene scene = furnished(0.5);
  const glm::ivec2 size{120, 90};
  for (const Ambient rung : {Ambient::Constant, Ambient::ShL1, Ambient::ShL2, Ambient::Box}) {
    Quality deferred = bare(), forward = bare(Path::Forward);
    deferred.ambient = forward.ambient = rung;
    const Picture reference = stage.linear(scene, intoRoom(), size, forward);
    REQUIRE(stage.renderer->lastPlan().on("forward_reference"));
    // The normal's 24 bits are off by 1e-3 at most, albedo's by 0.6 %: light that changes over a radian changes by as much.
    const Errors e = shares(stage.linear(scene, intoRoom(), size, deferred), reference, 0.01);
    WARN(fmt::format("rung {}: largest {:.3f} %, {:.2f} % within 1 %", int(rung), 100 * e.largest, 100 * e.share()));
    CHECK(e.largest < 0.03);
    CHECK(e.share() > 0.99);
  }
  // Without the lattice it is another picture.
  Scene dark = scene;
  dark.probes.grid.reset();
  ++dark.probes.revision;
  CHECK(shares(stage.linear(dark, intoRoom(), size, bare()), stage.linear(scene, intoRoom(), size, bare()), 0.01).share() < 0.01);
}

TEST_CASE("a blended surface is lit by a lattice as an opaque one") {
  Stage stage;
  Scene scene = furnished(0.5);
  const Picture opaque = stage.linear(scene, intoRoom(), {96, 72}, bare());
  scene.materials.each([&](Id<Material> id, const Material&) {
    Material& m = *scene.materials.edit(id);
    m.blend = true;
    m.opacity = 1;
  });
  const Picture blended = stage.linear(scene, intoRoom(), {96, 72}, bare());
  REQUIRE(stage.renderer->lastPlan().on("alpha_blend"));
  const Errors e = shares(blended, opaque, 0.01);
  CHECK(e.largest < 0.03);
  CHECK(e.share() > 0.99);
}

TEST_CASE("the plan says what of a lattice it draws, and why not") {
  Stage stage;
  Scene scene = furnished(0.5);
  const auto plan = [&](const Scene& s, const View& view, const Quality& q) {
    stage.linear(s, view, {32, 24}, q);
    return stage.renderer->lastPlan();
  };
  CHECK(plan(scene, intoRoom(), bare()).on("ambient_grid"));
  Quality q = bare();
  q.ambientSource = AmbientSource::Probes;
  CHECK(!plan(scene, intoRoom(), q).on("ambient_grid"));
  q = bare();
  q.ambient = Ambient::None;
  CHECK(!plan(scene, intoRoom(), q).on("ambient_grid"));
  View away = intoRoom();
  away.eye = {40, 0, 0};
  away.axes = {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};  // looks along -x, at the room from far: in view
  CHECK(plan(scene, away, bare()).on("ambient_grid"));
  away.axes = {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};
  CHECK(!plan(scene, away, bare()).on("ambient_grid"));
  for (auto& p : scene.probes.grid->points) p.valid = false;
  ++scene.probes.revision;
  CHECK(!plan(scene, intoRoom(), bare()).on("ambient_grid"));
}
