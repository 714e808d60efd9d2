// placeProbes(): rooms, their boxes, lattices.
#include <burnish/probe.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <ctime>
#include <iostream>
#include <random>

#include "paths.h"
#include "place_scenes.h"

using namespace burnish;
using namespace burnish::test;
using glm::vec2;

namespace {

ProbeSet placed(const Scene& scene, const PlacementOptions& options = {}, Report* into = nullptr) {
  Report report;
  auto set = placeProbes(scene, options, into ? *into : report);
  if (!set) FAIL(set.error().message());
  return std::move(*set);
}
PlacementOptions withoutGrid() {
  PlacementOptions o;
  o.grid = false;
  return o;
}

void describe(const ProbeSet& set) {
  for (const ReflectionProbe& p : set.reflections)
    std::cout << p.name << ": center " << p.center.x << " " << p.center.y << " " << p.center.z << " half " << p.halfSize.x << " " << p.halfSize.y << " " << p.halfSize.z << " capture " << p.capture.x << " "
              << p.capture.y << " " << p.capture.z << " fade " << p.fade.x << " margin " << p.margin << "\n";
  if (set.grid) {
    int valid = 0;
    for (const auto& q : set.grid->points) valid += q.valid;
    std::cout << "grid " << set.grid->counts.x << " " << set.grid->counts.y << " " << set.grid->counts.z << " spacing " << set.grid->spacing.x << " " << set.grid->spacing.y << " " << set.grid->spacing.z << " valid "
              << valid << "\n";
  }
}

/// The probe's corners against a box that is turned about +Y: the largest distance, metres.
double corners(const ReflectionProbe& p, dvec3 low, dvec3 high, const glm::dmat4& at) {
  double worst = 0;
  for (int i = 0; i < 8; ++i) {
    const dvec3 corner = dvec3(at * glm::dvec4(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z, 1));
    double nearest = INFINITY;
    for (int k = 0; k < 8; ++k) nearest = std::min(nearest, glm::length(p.center + p.axes * (p.halfSize * dvec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)) - corner));
    worst = std::max(worst, nearest);
  }
  return worst;
}
bool inBox(const ReflectionProbe& p, dvec3 point, double slack = 0) { return glm::all(glm::lessThanEqual(glm::abs(glm::transpose(p.axes) * (point - p.center)), p.halfSize + slack)); }

/// A wall across x = at from z0 to z1, two sheets 20 cm apart, with a door from the floor.
void wallWithDoor(Scene& s, const glm::dmat4& to, float at, float z0, float z1, float height, float doorZ, float doorWidth, float doorHeight) {
  const float a = doorZ - doorWidth / 2, b = doorZ + doorWidth / 2;
  place(s, box({at - 0.1f, 0, z0}, {at + 0.1f, height, a}), {}, to);
  place(s, box({at - 0.1f, 0, b}, {at + 0.1f, height, z1}), {}, to);
  place(s, box({at - 0.1f, doorHeight, a}, {at + 0.1f, height, b}), {}, to);
}

/// Two rooms of 5 x 2.7 x 4 and 3 x 2.7 x 4 metres.
Scene flat(const glm::dmat4& to = glm::dmat4(1), float doorWidth = 0.9f, float doorHeight = 2.05f) {
  Scene s;
  place(s, box({0, 0, 0}, {8.2f, 2.7f, 4}, true), {}, to);
  wallWithDoor(s, to, 5.1f, 0, 4, 2.7f, 1.3f, doorWidth, doorHeight);
  return s;
}

/// Floor, ceiling and walls of an L: 8 x 3 and 3 x 7 metres.
Scene ell(const glm::dmat4& to) {
  const float h = 2.6f;
  const vec2 plan[] = {{0, 0}, {8, 0}, {8, 3}, {3, 3}, {3, 7}, {0, 7}};
  Scene s;
  for (int i = 0; i < 6; ++i) {
    const vec3 a(plan[i].x, 0, plan[i].y), b(plan[(i + 1) % 6].x, 0, plan[(i + 1) % 6].y);
    place(s, quad((a + b) * 0.5f + vec3(0, h / 2, 0), (a - b) * 0.5f, {0, -h / 2, 0}), {}, to);
  }
  for (const auto& [low, high] : {std::pair(vec2(0, 0), vec2(8, 3)), std::pair(vec2(0, 3), vec2(3, 7))}) {
    const vec3 c((low.x + high.x) / 2, 0, (low.y + high.y) / 2), u((high.x - low.x) / 2, 0, 0), v(0, 0, (high.y - low.y) / 2);
    place(s, quad(c, v, u), {}, to);
    place(s, quad(c + vec3(0, h, 0), u, v), {}, to);
  }
  return s;
}

/// A table top on four legs and a cupboard that does not reach the ceiling.
void furnish(Scene& s, const glm::dmat4& to) {
  place(s, box({1.5f, 0.7f, 1.2f}, {3.5f, 0.75f, 2.6f}), {}, to);
  for (const float x : {1.55f, 3.4f})
    for (const float z : {1.25f, 2.5f}) place(s, box({x, 0, z}, {x + 0.06f, 0.7f, z + 0.06f}), {}, to);
  place(s, box({0.02f, 0, 0.3f}, {0.55f, 2, 2.3f}), {}, to);
  place(s, sphere(0.2f, 8, 16), {}, to * translation({2.5, 2.2, 1.9}));  // a lamp
}

}  // namespace

TEST_CASE("a closed box is one room, whichever way it is turned", "[place][rooms]") {
  const double degrees = GENERATE(0.0, 30.0, -17.3, 44.9);
  const dvec3 low(-2.13, 0, -1.71), high(2.41, 2.52, 3.07);
  const glm::dmat4 to = turned(degrees, {211.3, -4.2, 87.9});
  Scene s;
  place(s, box(vec3(low), vec3(high), true), {}, to);
  const ProbeSet set = placed(s, withoutGrid());
  INFO(degrees);
  REQUIRE(set.reflections.size() == 1);
  const ReflectionProbe& p = set.reflections[0];
  const double off = corners(p, low, high, to);
  CAPTURE(off);
  CHECK(off < 0.01);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) CHECK(glm::dot(p.axes[a], p.axes[b]) == Approx(a == b).margin(1e-12));
  CHECK(glm::determinant(p.axes) > 0);
  CHECK(glm::length(p.capture - p.center) < 0.3);
  CHECK(p.radiance.levels.empty());
  CHECK(p.margin == 0.25);
}

TEST_CASE("two rooms with a door between them", "[place][rooms]") {
  const double degrees = GENERATE(0.0, 30.0);
  const float doorHeight = GENERATE(2.05f, 2.7f);  // with a lintel, and up to the ceiling
  const glm::dmat4 to = turned(degrees, {-3, 1, 4});
  const ProbeSet set = placed(flat(to, 0.9f, doorHeight), withoutGrid());
  CAPTURE(degrees, doorHeight);
  REQUIRE(set.reflections.size() == 2);
  CHECK(corners(set.reflections[0], dvec3(0), {5, 2.7, 4}, to) < 0.01);
  CHECK(corners(set.reflections[1], {5.2, 0, 0}, {8.2, 2.7, 4}, to) < 0.01);
  // Half way through the door a quarter of the light at most is the sky's: 1 - 0.1 / margin.
  for (const ReflectionProbe& p : set.reflections) CHECK(1 - 0.1 / p.margin >= 0.74);
}

TEST_CASE("a wing that is turned keeps its own walls", "[place][rooms]") {
  Scene s = flat();
  const glm::dmat4 wing = turned(33, {12, 0, 3});
  place(s, box({0, 0, 0}, {5, 3, 4}, true), {}, wing);
  furnish(s, wing);
  const ProbeSet set = placed(s, withoutGrid());
  REQUIRE(set.reflections.size() == 3);
  double best = INFINITY;
  for (const ReflectionProbe& p : set.reflections) best = std::min(best, corners(p, dvec3(0), {5, 3, 4}, wing));
  CHECK(best < 0.01);
  for (const auto& [low, high] : {std::pair(dvec3(0), dvec3(5, 2.7, 4)), std::pair(dvec3(5.2, 0, 0), dvec3(8.2, 2.7, 4))}) {
    double own = INFINITY;
    for (const ReflectionProbe& p : set.reflections) own = std::min(own, corners(p, low, high, glm::dmat4(1)));
    CHECK(own < 0.01);
  }
}

TEST_CASE("an L has boxes that cover it and stay within its walls", "[place][rooms]") {
  const double degrees = GENERATE(0.0, 25.0);
  const glm::dmat4 to = turned(degrees, {1, 2, 3}), back = glm::inverse(to);
  const ProbeSet set = placed(ell(to), withoutGrid());
  CAPTURE(degrees);
  REQUIRE(set.reflections.size() == 2);
  for (double x = 0.05; x < 8; x += 0.1)
    for (double z = 0.05; z < 7; z += 0.1) {
      const dvec3 p = dvec3(to * glm::dvec4(x, 1.3, z, 1));
      const bool inside = z < 3 || x < 3;
      const bool covered = std::any_of(set.reflections.begin(), set.reflections.end(), [&](const ReflectionProbe& r) { return inBox(r, p, 0.01); });
      if (covered != inside) FAIL("(" << x << ", " << z << "): " << covered);
    }
  for (const ReflectionProbe& r : set.reflections) {
    const dvec3 p = dvec3(back * glm::dvec4(r.capture, 1));
    CHECK((p.z < 2.8 || p.x < 2.8));
  }
}

TEST_CASE("furniture does not move the box, and the capture keeps clear of it", "[place][rooms]") {
  const double degrees = GENERATE(0.0, 30.0);
  const glm::dmat4 to = turned(degrees, {0, 0, 0});
  Scene s = flat(to);
  furnish(s, to);
  const ProbeSet set = placed(s, withoutGrid());
  REQUIRE(set.reflections.size() == 2);
  const ReflectionProbe& room = inBox(set.reflections[0], dvec3(to * glm::dvec4(1, 1, 1, 1))) ? set.reflections[0] : set.reflections[1];
  CHECK(corners(room, dvec3(0), {5, 2.7, 4}, to) < 0.01);
  const probe::Geometry g = geometryOf(s);
  double nearest = INFINITY;
  std::mt19937_64 random(5);
  std::normal_distribution<double> n;
  for (int i = 0; i < 5000; ++i) nearest = std::min(nearest, g.rays.nearest({room.capture, glm::normalize(dvec3(n(random), n(random), n(random)))}).distance);
  CHECK(nearest > 0.3);
}

TEST_CASE("cupboards, roofs on posts and open land are no rooms", "[place][rooms]") {
  Report report;
  Scene cupboard;
  place(cupboard, box({0, 0, 0}, {1.2f, 2.1f, 1}, true), {});  // 2.5 m³
  CHECK(placed(cupboard, {}, &report).reflections.empty());
  Scene roof;
  place(roof, quad({0, 0, 0}, {40, 0, 0}, {0, 0, -40}), {});
  place(roof, box({-3, 2.5f, -3}, {3, 2.7f, 3}), {});
  for (const float x : {-2.9f, 2.9f})
    for (const float z : {-2.9f, 2.9f}) place(roof, box({x - 0.1f, 0, z - 0.1f}, {x + 0.1f, 2.5f, z + 0.1f}), {});
  CHECK(placed(roof, {}, &report).reflections.empty());
  Scene hills;
  Mesh land;
  for (int z = 0; z <= 60; ++z)
    for (int x = 0; x <= 60; ++x) land.positions.emplace_back(float(x * 5), 12 * std::sin(float(x) * 0.4f) * std::cos(float(z) * 0.3f), float(z * 5));
  for (std::uint32_t z = 0; z < 60; ++z)
    for (std::uint32_t x = 0; x < 60; ++x) {
      const std::uint32_t i = z * 61 + x;
      land.indices.insert(land.indices.end(), {i, i + 61, i + 62, i, i + 62, i + 1});
    }
  place(hills, land, {});
  Report warned;
  const ProbeSet none = placed(hills, {}, &warned);
  CHECK(none.reflections.empty());
  CHECK(!none.grid);
  REQUIRE(warned.warnings().size() == 1);
  CHECK(warned.warnings()[0].message().find("no room is found") != std::string::npos);
}

TEST_CASE("a room with windows is one; glass closes it", "[place][rooms]") {
  Scene s;
  place(s, box({-30, -0.1f, -30}, {30, 0, 30}), {});
  // Walls of 20 cm around 6 x 3 x 4 metres; the one at x = 3 is all glass.
  for (const auto& [low, high] : {std::pair(vec3(-3.2f, 0, -2.2f), vec3(-3, 3, 2.2f)), std::pair(vec3(-3, 0, -2.2f), vec3(3, 3, -2)), std::pair(vec3(-3, 0, 2), vec3(3, 3, 2.2f)), std::pair(vec3(-3.2f, 3, -2.2f), vec3(3, 3.2f, 2.2f))})
    place(s, box(low, high), {});
  Material glass;
  glass.transmission = 1;
  glass.twoSided = true;
  place(s, quad({3, 1.5f, 0}, {0, 0, -2}, {0, 1.5f, 0}), glass);
  const ProbeSet set = placed(s, withoutGrid());
  REQUIRE(set.reflections.size() == 1);
  CHECK(corners(set.reflections[0], {-3, 0, -2}, {3, 3, 2}, glm::dmat4(1)) < 0.01);
}

TEST_CASE("what the scene has stays, and its rooms get no second probe", "[place][rooms]") {
  Scene s = flat();
  ReflectionProbe own;
  own.name = "own";
  own.center = {6.7, 1.35, 2};
  own.halfSize = {1.4, 1.3, 1.9};
  s.probes.reflections.push_back(own);
  AmbientGrid grid;
  grid.name = "mine";
  grid.origin = {1, 1, 1};
  grid.counts = {3, 1, 2};
  s.probes.grid = grid;
  const ProbeSet set = placed(s);
  REQUIRE(set.reflections.size() == 2);
  CHECK(set.reflections[0].name == "own");
  CHECK(corners(set.reflections[1], dvec3(0), {5, 2.7, 4}, glm::dmat4(1)) < 0.01);
  REQUIRE(set.grid);
  CHECK(set.grid->name == "mine");
  CHECK(set.grid->points.size() == 6);
  CHECK(set.revision != s.probes.revision);
}

TEST_CASE("the lattice over a room: five across, close to the walls", "[place][rooms]") {
  Scene s;
  const dvec3 low(-1, 0, -2), high(1.3, 2.5, 2.2);
  const glm::dmat4 to = turned(30, {5, 6, 7});
  place(s, box(vec3(low), vec3(high), true), {}, to);
  const ProbeSet set = placed(s);
  REQUIRE(set.grid);
  const AmbientGrid& g = *set.grid;
  CHECK(g.counts == glm::ivec3(5));
  const glm::dmat4 back = glm::inverse(to);
  for (int z = 0; z < 5; ++z)
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 5; ++x) {
        const dvec3 p = dvec3(back * glm::dvec4(g.position({x, y, z}), 1));
        CHECK(glm::all(glm::greaterThan(p, low)));
        CHECK(glm::all(glm::lessThan(p, high)));
        CHECK(g.points[std::size_t(x + 5 * (y + 5 * z))].valid);
      }
  const dvec3 first = dvec3(back * glm::dvec4(g.position({0, 0, 0}), 1));
  for (int k = 0; k < 3; ++k) CHECK(first[k] - low[k] == Approx(0.04 * (high[k] - low[k]) / 4.08).margin(0.002));
  CHECK(g.points[0].distances.size() == 256);
}

TEST_CASE("lattices keep to the spacing and the number of points that are asked for", "[place][rooms]") {
  const Scene s = flat();
  PlacementOptions o;
  o.gridSpacing = 0.5;
  const ProbeSet set = placed(s, o);
  REQUIRE(set.grid);
  for (int k = 0; k < 3; ++k) CHECK(set.grid->spacing[k] <= 0.5 + 1e-9);
  for (int k = 0; k < 3; ++k) CHECK(set.grid->spacing[k] >= 0.3);
  o.maxGridPoints = 200;
  Report report;
  const ProbeSet few = placed(s, o, &report);
  REQUIRE(few.grid);
  CHECK(few.grid->points.size() <= 200);
  CHECK(few.grid->points.size() > 100);
  REQUIRE(report.warnings().size() == 1);
  CHECK(report.warnings()[0].message().find("at most 200 are allowed") != std::string::npos);
  Report bad;
  o.maxGridPoints = 0;
  CHECK_FALSE(placeProbes(s, o, bad));
  o = {};
  o.gridSpacing = NAN;
  CHECK_FALSE(placeProbes(s, o, bad));
  o.gridSpacing = -1;
  CHECK_FALSE(placeProbes(s, o, bad));
}

TEST_CASE("placement: threads change nothing, progress runs from 0 to 1", "[place][rooms]") {
  Scene s = flat();
  furnish(s, glm::dmat4(1));
  PlacementOptions one;
  one.threads = 1;
  std::vector<double> shares;
  one.progress = [&](double share) { shares.push_back(share); };
  PlacementOptions many;
  many.threads = 6;
  const ProbeSet a = placed(s, one), b = placed(s, many);
  REQUIRE(a.reflections.size() == b.reflections.size());
  for (std::size_t i = 0; i < a.reflections.size(); ++i) {
    CHECK(a.reflections[i].center == b.reflections[i].center);
    CHECK(a.reflections[i].halfSize == b.reflections[i].halfSize);
    CHECK(a.reflections[i].capture == b.reflections[i].capture);
    CHECK(a.reflections[i].axes == b.reflections[i].axes);
  }
  REQUIRE(a.grid);
  REQUIRE(b.grid);
  CHECK(a.grid->origin == b.grid->origin);
  bool same = a.grid->points.size() == b.grid->points.size();
  for (std::size_t i = 0; same && i < a.grid->points.size(); ++i) same = a.grid->points[i].valid == b.grid->points[i].valid && a.grid->points[i].distances == b.grid->points[i].distances;
  CHECK(same);
  REQUIRE(shares.size() > 4);
  CHECK(shares.front() == 0);
  CHECK(shares.back() == 1);
  CHECK(std::is_sorted(shares.begin(), shares.end()));
}

TEST_CASE("scenes that are broken, empty, endless or flat end soon and quietly", "[place][rooms]") {
  Report report;
  CHECK(placed(Scene{}, {}, &report).reflections.empty());
  Scene wild;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> spread(-1, 1);
  Mesh soup;
  for (int i = 0; i < 1500; ++i) {
    soup.positions.emplace_back(vec3(spread(random), spread(random), spread(random)) * std::pow(10.0f, 6 * spread(random)));
    soup.indices.push_back(std::uint32_t(i));
  }
  soup.positions[77].x = NAN;
  place(wild, soup, {});
  Scene plane;
  place(plane, quad({0, 0, 0}, {1e7f, 0, 0}, {0, 0, -1e7f}), {});
  Scene point;
  place(point, quad({0, 0, 0}, {0, 0, 0}, {0, 0, 0}), {});
  Scene far = flat(translation({1e6, 0, -1e6}));
  place(far, quad({-1e6f, 0, 1e6f}, {1, 0, 0}, {0, 0, -1}), {});
  for (const Scene* s : {&wild, &plane, &point, &far}) {
    const auto start = std::clock();
    placed(*s, {}, &report);
    CHECK(double(std::clock() - start) / CLOCKS_PER_SEC < 60);
  }
}

TEST_CASE("more triangles than rays can take are an error before they are made", "[place][rooms]") {
  Scene s;
  Mesh m = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const std::vector<std::uint32_t> once = m.indices;
  for (int i = 0; i < 100000; ++i) m.indices.insert(m.indices.end(), once.begin(), once.end());
  Instance instance;
  instance.mesh = s.meshes.add(std::move(m));
  for (int i = 0; i < 151; ++i) s.instances.add(instance);
  Report report;
  const auto none = placeProbes(s, {}, report);
  REQUIRE_FALSE(none);
  CHECK(none.error().message().find("at most 30000000") != std::string::npos);
}

TEST_CASE("the fps sample has its four rooms", "[place][fps]") {
  Report report;
  auto scene = loadScene(std::filesystem::path(BURNISH_BINARY_DIR) / "share/burnish/samples/fps/fps.gltf", {}, report);
  REQUIRE(scene);
  // The file's own probes are those of ROOMS in samples/fps/make_scene.py: what is to be found.
  const ProbeSet own = std::move(scene->probes);
  REQUIRE(own.reflections.size() == 4);
  scene->probes = {};
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  const ProbeSet set = placed(*scene);
  std::cout << "fps: placed in " << std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() << " s (" << double(std::clock() - cpu) / CLOCKS_PER_SEC << " s of CPU)\n";
  describe(set);
  REQUIRE(set.reflections.size() == 4);
  for (const ReflectionProbe& room : own.reflections) {
    double best = INFINITY;
    for (const ReflectionProbe& p : set.reflections) best = std::min(best, corners(p, room.center - room.halfSize, room.center + room.halfSize, glm::dmat4(1)));
    std::cout << room.name << ": corners off by " << best * 1000 << " mm at most\n";
    CHECK(best < 0.05);
  }
  const Solids solids(*scene);
  for (const ReflectionProbe& p : set.reflections) CHECK_FALSE(solids.hold(p.capture));
  REQUIRE(set.grid);
  const AmbientGrid& g = *set.grid;
  int valid = 0, wrong = 0;
  for (int z = 0; z < g.counts.z; ++z)
    for (int y = 0; y < g.counts.y; ++y)
      for (int x = 0; x < g.counts.x; ++x) {
        if (!g.points[std::size_t(x + g.counts.x * (y + g.counts.y * z))].valid) continue;
        const dvec3 p = g.position({x, y, z});
        ++valid;
        const bool inRoom = std::any_of(own.reflections.begin(), own.reflections.end(), [&](const ReflectionProbe& r) { return inBox(r, p); });
        if (solids.hold(p)) {
          ++wrong;
          std::cout << "in something: " << p.x << " " << p.y << " " << p.z << (inRoom ? " in a room" : "") << "\n";
        }
      }
  std::cout << valid << " valid points\n";
  CHECK(wrong == 0);
}
