// Rooms and their boxes.
#include <catch2/catch.hpp>
#include <random>

#include "place_rooms.h"

using namespace burnish;
using namespace burnish::test;

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
