// Lattices over rooms, and placement as a whole.
#include <catch2/catch.hpp>
#include <ctime>
#include <random>

#include "place_rooms.h"

using namespace burnish;
using namespace burnish::test;

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
