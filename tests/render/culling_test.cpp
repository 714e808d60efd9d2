// Culling is exact: 1024 lights with ranges through the tiles, against all lights brute force in double for every pixel.
// Faces are axis-aligned, and albedo, roughness and substance lie on the G-buffer's codes, so the formats add next to nothing.
#include <fmt/format.h>

#include <iostream>
#include <numeric>
#include <random>
#include <set>

#include "lighting/light_tiles.h"
#include "lighting/tile_surfaces.h"
#include "render/scenes.h"
#include "shading/test_rungs.h"

using namespace burnish;
using namespace burnish::test;
namespace f64 = burnish::shading::f64;

namespace {

struct Box {
  dvec3 low, high;
};

/// A room of 12 × 4 × 10 m with six columns, seen from within.
struct Hall {
  Scene scene;
  Box room{{-6, 0, -5}, {6, 4, 5}};
  std::vector<Box> columns;
  double albedo = 0, alpha = 0;

  Hall() {
    Material m;
    albedo = std::pow(180.0 / 255, 2);
    alpha = f64::decodeAlpha(215.0 / 255);
    m.albedo = vec3(float(albedo));
    m.roughness = float(std::sqrt(alpha));
    place(scene, box(vec3(room.low), vec3(room.high), true), m);
    for (double x : {-3.0, 0.0, 3.0})
      for (double z : {-2.0, 2.0}) {
        columns.push_back({{x - 0.3, 0, z - 0.3}, {x + 0.3, 3.5, z + 0.3}});
        place(scene, box(vec3(columns.back().low), vec3(columns.back().high)), m);
      }
  }
  void addLights(int count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < count; ++i) {
      const bool spot = i % 5 == 4;
      Light l = light(spot ? LightKind::Spot : LightKind::Point, vec3(glm::dvec3(0.2 + unit(random), 0.2 + unit(random), 0.2 + unit(random))), float(0.1 + 2 * unit(random)),
                      float(i % 64 == 0 ? 6.0 : 0.3 + 1.5 * unit(random)));
      l.outerCone = float(0.2 + 1.3 * unit(random));
      l.innerCone = l.outerCone * float(unit(random) * 0.9);
      const dvec3 at = room.low + (room.high - room.low) * (dvec3(unit(random), unit(random), unit(random)) * 1.1 - 0.05);
      addLight(scene, l, at, dvec3(unit(random) - 0.5, unit(random) - 0.6, unit(random) - 0.5));
    }
  }
};

struct Hit {
  double t = 1e30;
  dvec3 normal{0};
};

void meet(const Ray& r, const Box& b, bool inside, Hit& best) {
  double enter = -1e30, leave = 1e30;
  int enterAxis = 0, leaveAxis = 0;
  for (int i = 0; i < 3; ++i) {
    double t0 = (b.low[i] - r.origin[i]) / r.direction[i], t1 = (b.high[i] - r.origin[i]) / r.direction[i];
    if (t0 > t1) std::swap(t0, t1);
    if (t0 > enter) enter = t0, enterAxis = i;
    if (t1 < leave) leave = t1, leaveAxis = i;
  }
  if (enter > leave || leave < 0 || (!inside && enter < 0.05)) return;
  const double t = inside ? leave : enter;
  if (t >= best.t || t < 0.05) return;
  best.t = t;
  best.normal = dvec3(0);
  const int axis = inside ? leaveAxis : enterAxis;
  best.normal[axis] = r.direction[axis] > 0 ? -1 : 1;
}
Hit trace(const Hall& hall, const Ray& r) {
  Hit h;
  meet(r, hall.room, true, h);
  for (const Box& c : hall.columns) meet(r, c, false, h);
  return h;
}

struct Lamp {
  dvec3 position, axis, color;
  double range, scale, offset;
  bool spot;
};
std::vector<Lamp> lampsOf(const Scene& scene) {
  std::vector<Lamp> lamps;
  scene.lights.each([&](Id<Light>, const Light& l) {
    const glm::dmat4 w = scene.world(l.node);
    const double inner = std::min(double(l.innerCone), l.outerCone - 0.001), scale = 1 / (std::cos(inner) - std::cos(double(l.outerCone)));
    lamps.push_back({dvec3(w[3]), -dvec3(w[2]), dvec3(l.color) * double(l.intensity), l.range, scale, -std::cos(double(l.outerCone)) * scale, l.kind == LightKind::Spot});
  });
  return lamps;
}

dvec3 bruteForce(const Hall& hall, const std::vector<Lamp>& lamps, const Ray& r, const Hit& h) {
  const dvec3 p = r.origin + r.direction * h.t;
  const auto m = f64::makeSurface(h.normal, -r.direction, dvec3(hall.albedo), 1.0 / 3, hall.alpha);
  const shading::Rungs rungs = defaultRungs();
  dvec3 sum(0);
  for (const Lamp& lamp : lamps) {
    const dvec3 l = lamp.position - p;
    const double d2 = std::max(glm::dot(l, l), 1e-4), d = std::sqrt(d2);
    if (d >= lamp.range) continue;  // the window is 0 there
    const double window = 1 - std::pow(d / lamp.range, 4), t = lamp.spot ? std::clamp(-glm::dot(lamp.axis, l) / d * lamp.scale + lamp.offset, 0.0, 1.0) : 1;
    sum += f64::shadeDirection(m, l / d, glm::dvec2(0), rungs) * lamp.color * (window * window / d2 * t * t);
  }
  return sum;
}

dvec3 developed(dvec3 radiance, double ev) {
  const dvec3 t = f64::tonemapNeutral(radiance / (1.2 * std::exp2(ev)));
  return {f64::srgbFromLinear(t.x), f64::srgbFromLinear(t.y), f64::srgbFromLinear(t.z)};
}

/// Compares a picture with brute force. Pixels that a face's edge passes are left out.
Errors compare(const Hall& hall, const View& view, const Picture& p, double ev, double& brightest) {
  const std::vector<Lamp> lamps = lampsOf(hall.scene);
  const glm::ivec2 size(p.image.width, p.image.height);
  Errors e;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const Ray r = rayThrough(view, size, x + 0.5, y + 0.5);
      const Hit h = trace(hall, r);
      bool edge = false;
      for (double dx : {-0.02, 0.02})
        for (double dy : {-0.02, 0.02}) {
          const Hit o = trace(hall, rayThrough(view, size, x + 0.5 + dx, y + 0.5 + dy));
          edge |= o.normal != h.normal || std::abs(o.t - h.t) > 0.1 * h.t;
        }
      if (edge) continue;
      const dvec3 wanted = developed(bruteForce(hall, lamps, r, h), ev), d = glm::abs(wanted - p.at(x, y));
      brightest = std::max(brightest, wanted.x);
      e.add(std::max({d.x, d.y, d.z}), 1.0 / 255);
    }
  return e;
}

/// To the bit; on a chip, whose compiler orders sums by the program, to a half float's step.
bool sameBut(const Picture& a, const Picture& b, bool software) {
  if (software) return same(a, b);
  for (int y = 0; y < a.image.height; ++y)
    for (int x = 0; x < a.image.width; ++x)
      for (int c = 0; c < 3; ++c)
        if (!(std::abs(a.at(x, y)[c] - b.at(x, y)[c]) <= std::exp2(-10) * std::abs(a.at(x, y)[c]) + 1e-6)) return false;
  return true;
}

Quality qualityAt(float ev) {
  Quality q;
  q.exposureEv = ev;
  return q;
}

}  // namespace

TEST_CASE("1024 lights in tiles equal all lights brute force within 1/255") {
  Hall hall;
  hall.addLights(1024);
  View orthographic = lookAt({4, 3.5, 4}, {-3, 0.5, -3});
  orthographic.orthographic = true;
  orthographic.height = 3;
  orthographic.near = 0.05f;
  orthographic.far = 30;
  const std::pair<const char*, View> views[] = {{"perspective", lookAt({5, 2, 4.5}, {-2, 1.5, -2}, {0, 1, 0}, 1.2f)}, {"straight down a wall", lookAt({-5.8, 1.7, 4.8}, {-5.8, 1.7, -5})}, {"orthographic", orthographic}};
  for (TileBounds bounds : {TileBounds::Readback, TileBounds::Reduction}) {
    RendererOptions options;
    options.tileBounds = bounds;
    Stage stage(options);
    for (const auto& [name, view] : views) {
      INFO(name << ", bounds " << int(bounds));
      const Picture p = stage.display(hall.scene, view, {251, 143}, qualityAt(0));
      double brightest = 0;
      const Errors e = compare(hall, view, p, 0, brightest);
      std::cout << fmt::format("  {}, tile bounds {}: {} pixels, largest difference {:.2f}/255, {} of 1024 lights in view\n", name, bounds == TileBounds::Readback ? "read back" : "reduced", e.count, e.largest * 255,
                               p.stats.lightsInView);
      CHECK(e.count > 30000);
      // A chip's rasterizer moves walls by up to 1/512 of a pixel, here 0.1 mm, which 1/r² shows two centimetres from a light.
      CHECK(e.largest <= (stage.software() ? 1.0 : 10.0) / 255);
      CHECK(e.share() > 0.998);
      CHECK(brightest > 0.8);
      CHECK(p.stats.lightsInView > 100);
      CHECK(p.stats.lights == 1024);
    }
  }
}

TEST_CASE("both ways to learn a tile's depth range give the same bytes") {
  Hall hall;
  hall.addLights(400);
  const View view = lookAt({5, 2, 4.5}, {-2, 1.5, -2}, {0, 1, 0}, 1.2f);
  std::vector<Picture> pictures;
  bool software = true;
  for (TileBounds bounds : {TileBounds::Readback, TileBounds::Reduction}) {
    RendererOptions options;
    options.tileBounds = bounds;
    Stage stage(options);
    software = stage.software();
    pictures.push_back(stage.linear(hall.scene, view, {333, 187}));
    CHECK((stage.renderer->lastPlan().target("tile_depth") != nullptr) == (bounds == TileBounds::Reduction));
  }
  // Where depth and normals are in memory, lights that reach no surface from its front are left out as well.
  CHECK(pictures[0].stats.lightsInView <= pictures[1].stats.lightsInView);
  CHECK(sameBut(pictures[0], pictures[1], software));
}

TEST_CASE("a view in an odd corner of the target equals the same view alone") {
  Hall hall;
  hall.addLights(400);
  for (TileBounds bounds : {TileBounds::Readback, TileBounds::Reduction}) {
    RendererOptions options;
    options.tileBounds = bounds;
    Stage stage(options);
    View view = lookAt({5, 2, 4.5}, {-2, 1.5, -2}, {0, 1, 0}, 1.2f);
    const Picture alone = stage.display(hall.scene, view, {101, 77}, qualityAt(0));
    view.viewport = {37, 21, 101, 77};
    const Picture corner = stage.display(hall.scene, view, {200, 140}, qualityAt(0));
    Errors e;
    for (int y = 0; y < 77; ++y)
      for (int x = 0; x < 101; ++x) {
        const dvec3 d = glm::abs(alone.at(x, y) - corner.at(x + 37, 140 - 21 - 77 + y));
        e.add(std::max({d.x, d.y, d.z}), 1.0 / 255);
      }
    // Positions at a viewport's offset round differently in the rasteriser: a pixel on an edge may fall to the other side.
    CHECK(e.share() > 0.998);
    CHECK(corner.at(5, 5) == dvec3(0));
  }
}

TEST_CASE("lights outside the view, behind the eye and out of range change nothing") {
  Hall hall;
  hall.addLights(64);
  Stage stage;
  const View view = lookAt({5, 2, 4.5}, {-2, 1.5, -2}, {0, 1, 0}, 0.8f);
  const Picture without = stage.linear(hall.scene, view, {160, 90});
  for (int i = 0; i < 50; ++i) addLight(hall.scene, light(LightKind::Point, vec3(1), 1000, 0.5f), {5.2 + 0.01 * i, 2.5, 5.5});
  const Picture with = stage.linear(hall.scene, view, {160, 90});
  CHECK(same(without, with));
  CHECK(with.stats.lights == 114);
  CHECK(with.stats.lightsInView < 114);
}

TEST_CASE("lights that reach no surface of a tile from its front: none that does is left out, none that clearly does not is kept") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> d(-1, 1);
  int reached = 0, missed = 0, kept = 0;
  for (int round = 0; round < 60; ++round) {
    View view = lookAt({d(random), d(random), d(random)}, {d(random), d(random), -4});
    view.orthographic = round % 4 == 3;
    const glm::ivec2 size{37, 29};  // whole tiles and cut ones
    const scene::ViewFrame frame = scene::frameOf(view, size, {0.4 * d(random), 0.4 * d(random)});
    std::vector<float> depth;
    std::vector<std::uint32_t> normals;
    std::vector<dvec3> positions, directions;
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const double away = 3 + 0.05 * x + d(random), image = view.orthographic ? 1 : away;
        const bool surface = d(random) > -0.8;
        depth.push_back(surface ? float(view.orthographic ? (frame.depthParams.x - away) / frame.depthParams.y : frame.depthParams.x / away - frame.depthParams.y) : 0.0f);
        positions.push_back(frame.axes[0] * ((2 * (x + 0.5 + frame.jitter.x) / size.x - 1) * frame.tanX * image) + frame.axes[1] * ((2 * (y + 0.5 + frame.jitter.y) / size.y - 1) * frame.tanY * image) -
                            frame.axes[2] * away);
        const dvec3 n(d(random), d(random), d(random));
        const dvec3 packed = f64::packNormal(n) * 255.0;
        normals.push_back(std::uint32_t(std::lround(packed.x)) | std::uint32_t(std::lround(packed.y)) << 8 | std::uint32_t(std::lround(packed.z)) << 16 | 0x7f000000u);
        directions.push_back(surface ? f64::unpackNormal(packed / 255.0) : dvec3(0));
      }
    lighting::TileSurfaces surfaces;
    surfaces.begin(frame, depth, normals, NormalStorage::Oct12);
    for (int ty = 0; ty < 2; ++ty)
      for (int tx = 0; tx < 3; ++tx) {
        surfaces.load(tx, ty);
        for (int i = 0; i < 40; ++i) {
          scene::LocalLight light;
          light.radius = float(0.05 + 0.5 * std::abs(d(random)));
          light.position = vec3(positions[std::size_t(std::min(ty * 16 + 8, size.y - 1) * size.x + std::min(tx * 16 + 3, size.x - 1))] + dvec3(d(random), d(random), d(random)));
          bool any = false, nearly = false;
          for (int y = ty * 16; y < std::min(ty * 16 + 16, size.y); ++y)
            for (int x = tx * 16; x < std::min(tx * 16 + 16, size.x); ++x) {
              const std::size_t p = std::size_t(y * size.x + x);
              const dvec3 to = dvec3(light.position) - positions[p];
              any |= glm::length(to) < double(light.radius) && glm::dot(to, directions[p]) > 0;
              nearly |= directions[p] != dvec3(0) && glm::length(to) < double(light.radius) + 0.01 && glm::dot(to, directions[p]) > -0.01;
            }
          const bool found = surfaces.reached(light);
          reached += any;
          missed += any && !found;
          kept += found && !nearly;
        }
      }
  }
  CHECK(reached > 1000);
  CHECK(missed == 0);
  CHECK(kept == 0);
}

TEST_CASE("each tile is shaded once, by a program that is right for it, and none draws few tiles where another could") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> d(-1, 1);
  std::size_t moved = 0;
  for (int round = 0; round < 96; ++round) {
    const glm::ivec2 size{320, 192};
    const scene::ViewFrame frame = scene::frameOf(lookAt({0, 0, 0}, {0, 0, -4}), size);
    std::vector<lighting::TileDepth> depths(20 * 12);
    for (lighting::TileDepth& t : depths) {
      if (d(random) < -0.9) continue;  // nothing is drawn there
      t.near = t.nearEnd = float(frame.depthParams.x / 3.9 - frame.depthParams.y);
      t.far = t.farBegin = float(frame.depthParams.x / 4.1 - frame.depthParams.y);
    }
    std::vector<scene::LocalLight> lights(std::size_t(round % 12));
    for (scene::LocalLight& l : lights) {
      l.position = vec3(float(4 * d(random)), float(2 * d(random)), -4);
      l.radius = float(1 + std::abs(2.5 * d(random)));
      l.axis = {0, 0, -1};
      l.cosOuter = round % 3 == 1 && d(random) > 0.8 ? -0.5f : -1.0f;
    }
    const std::size_t shadowed = round % 4 == 3 ? std::min<std::size_t>(lights.size(), 2) : 0;
    std::vector<lighting::DetailBox> details;
    if (round % 5 == 4) details.push_back({{-3, 0, -4}, {0.5f, 0.5f, 0.5f}, {true, false}});
    std::vector<lighting::ProbeBox> probes(std::size_t(round / 2 % 6));
    for (lighting::ProbeBox& p : probes) p.center = {4 * d(random), d(random), -4}, p.halfSize = dvec3(std::abs(d(random)) * 1.5);
    lighting::TileCuller culler;
    const lighting::TileLists lists = culler.cull(frame, depths, lights, shadowed, details, {}, probes.empty() ? nullptr : &probes);

    // Which lights reach which tiles, one by one.
    std::vector<std::vector<std::size_t>> wanted(depths.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
      lighting::TileCuller one;
      const lighting::TileLists alone = one.cull(frame, depths, {&lights[i], 1});
      for (const lighting::TileGroup& g : alone.groups)
        for (int k = g.first; k < g.first + g.count; ++k)
          for (int e = 0; e < (alone.tiles[std::size_t(k)].w & 0xffff); ++e)
            if (alone.entries[std::size_t(alone.tiles[std::size_t(k)].z + e)] == 1) wanted[std::size_t(alone.tiles[std::size_t(k)].y * 20 + alone.tiles[std::size_t(k)].x)].push_back(i + 1);
    }
    std::vector<int> times(depths.size(), 0);
    for (const lighting::TileGroup& g : lists.groups)
      for (int k = g.first; k < g.first + g.count; ++k) {
        const lighting::TileVertex tile = lists.tiles[std::size_t(k)];
        const std::size_t at = std::size_t(tile.y * 20 + tile.x);
        ++times[at];
        std::vector<std::size_t> listed;
        bool spot = false;
        int casters = 0;
        for (int e = 0; e < (tile.w & 0xffff); ++e)
          if (const std::size_t light = lists.entries[std::size_t(tile.z + e)]; light > 0) listed.push_back(light), spot |= lights[light - 1].cosOuter > -1, casters += light <= shadowed;
        CHECK(listed == wanted[at]);
        if (g.bucket >= 0) CHECK((tile.w & 0xffff) == g.bucket);
        if (spot) CHECK((g.bucket == plan::kLoopSpots || g.bucket == plan::kLoopShadows));
        CHECK(casters == tile.w >> 16);
        if (casters > 0) CHECK(g.bucket == plan::kLoopShadows);
        if (probes.empty()) continue;
        const lighting::TileProbes near = lists.probes[std::size_t(k)];
        CHECK((near.x < 0 || g.places != plan::Places::None));
        CHECK((near.y < 0 || g.places == plan::Places::Many));
      }
    for (std::size_t i = 0; i < depths.size(); ++i) CHECK(times[i] == (depths[i].far >= 0 ? 1 : 0));
    const auto lit = std::accumulate(times.begin(), times.end(), 0);
    const auto order = [](int bucket) { return bucket >= 0 ? bucket : 100 - bucket; };
    for (const lighting::TileGroup& small : lists.groups)
      for (const lighting::TileGroup& other : lists.groups)
        if (&small != &other && small.count * 50 < lit && other.details.brushed == small.details.brushed) CHECK_FALSE(((other.places == small.places || other.places == plan::Places::Many) && order(other.bucket) >= order(small.bucket)));
    std::set<std::size_t> sizes;
    for (const auto& w : wanted) sizes.insert(w.size());
    moved += sizes.size() > lists.groups.size();
  }
  CHECK(moved > 0);
}
