// A lattice through the shading text in double: a field without walls, and numbers that no lattice should have.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "grid_sampler.h"
#include "reference/shading.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;

namespace {

dvec3 unit(std::mt19937_64& random) {
  std::normal_distribution<double> g;
  return glm::normalize(dvec3(g(random), g(random), g(random)));
}

/// Light that rises evenly through the room, no walls near.
AmbientGrid smooth() {
  AmbientGrid grid;
  grid.origin = {-1, 2, 0.5};
  grid.axes = {{0.8, 0, -0.6}, {0, 1, 0}, {0.6, 0, 0.8}};
  grid.spacing = {0.5, 0.7, 0.4};
  grid.counts = {4, 3, 5};
  fillGrid(grid, {}, [](const dvec3& p) {
    std::array<dvec3, 9> sh{};
    sh[0] = dvec3(3, 2, 1) + dvec3(0.4, 0.2, 0.1) * p.x + dvec3(0.1) * p.y + dvec3(0.05, 0.1, 0.2) * p.z;
    sh[1] = dvec3(0.5, 0.1, 0.2) * p.x;
    sh[8] = dvec3(0.1, 0.2, 0.1) * p.y;
    return sh;
  });
  return grid;
}

}  // namespace

TEST_CASE("grid: constant light comes out as it went in") {
  AmbientGrid grid = smooth();
  for (auto& point : grid.points) point.irradiance = {glm::vec3(0.3f, 0.2f, 0.1f)};
  const GridSampler sampler(grid);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-4, 6);
  int inside = 0;
  for (int i = 0; i < 20'000; ++i) {
    const GridLight l = sampler.at({place(random), place(random), place(random)}, unit(random));
    REQUIRE(l.share >= 0);
    REQUIRE(l.share <= 1);
    if (l.share == 0) continue;
    ++inside;
    REQUIRE(glm::length(l.light - dvec3(glm::vec3(0.3f, 0.2f, 0.1f))) < 1e-12);
  }
  CHECK(inside > 100);
}

TEST_CASE("grid: no step where cells meet, in a field without walls") {
  const AmbientGrid grid = smooth();
  const GridSampler sampler(grid);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> share(0, 1);
  double worst = 0;
  for (int i = 0; i < 20'000; ++i) {
    // A point on the border of two cells, and a micrometre to either side of it.
    dvec3 q = dvec3(share(random), share(random), share(random)) * dvec3(grid.counts - 1);
    const int axis = i % 3;
    q[axis] = std::round(q[axis]);
    dvec3 step(0);
    step[axis] = 1e-6;
    const dvec3 n = unit(random);
    const auto at = [&](const dvec3& place) { return sampler.at(grid.origin + grid.axes * (place * grid.spacing), n); };
    const GridLight a = at(q - step), b = at(q + step);
    REQUIRE(a.share == Approx(b.share).margin(1e-4));
    for (int c = 0; c < 3; ++c) worst = std::fmax(worst, std::abs(a.light[c] - b.light[c]) / std::fmax(a.light[c], b.light[c]));
  }
  INFO("largest step, relative: " << worst);
  CHECK(worst < 1.0 / 255);
}

TEST_CASE("grid: the field itself, where points before the surface know it") {
  // Between the points before its plane, and beyond the outer ones as at them.
  const AmbientGrid grid = smooth();
  const GridSampler sampler(grid);
  const dvec3 up = grid.axes[1];
  for (const double height : {0.0, 0.01, 0.1, 0.3}) {
    const dvec3 p = grid.origin + grid.axes * (dvec3(1.3, 0, 2.7) * grid.spacing) - up * height;  // below the lowest points, looking up: light goes on as it is at them
    const dvec3 there = p + up * height;
    const dvec3 expected = dvec3(3, 2, 1) + dvec3(0.4, 0.2, 0.1) * there.x + dvec3(0.1) * there.y + dvec3(0.05, 0.1, 0.2) * there.z + dvec3(0.5, 0.1, 0.2) * there.x * up.y +
                           dvec3(0.1, 0.2, 0.1) * there.y * (up.x * up.x - up.y * up.y);
    const GridLight l = sampler.at(p, up);
    CHECK(glm::length(l.light - expected) < 1e-5);  // irradiance is float
    CHECK(l.share == Approx(1));
  }
}

TEST_CASE("grid: half a cell around it is the lattice's, then it gives way over the margin") {
  AmbientGrid grid = smooth();
  grid.margin = 0.3;
  const GridSampler sampler(grid);
  const auto share = [&](double beyond) { return sampler.at(grid.origin + grid.axes * (dvec3(1.4, 0.8, 2.2) * grid.spacing) - grid.axes[0] * (1.4 * 0.5 + beyond), grid.axes[0]).share; };
  CHECK(share(0.25) == 1);
  CHECK(share(0.25 + 0.15) == Approx(0.5));
  CHECK(share(0.25 + 0.3) == Approx(0).margin(1e-9));
  CHECK(share(100) == 0);
  grid.margin = 0;
  CHECK(share(0.249) == 1);
  CHECK(share(0.251) == 0);
}

TEST_CASE("grid: finite whatever it holds and wherever it is asked") {
  const double inf = std::numeric_limits<double>::infinity();
  const auto check = [&](const AmbientGrid& grid) {
    const GridSampler sampler(grid);
    for (const dvec3& p : {dvec3(0), grid.origin, grid.position(grid.counts - 1), dvec3(1e18), dvec3(-1e9, 1e-30, 3)})
      for (const dvec3& n : {dvec3(0), dvec3(0, 0, 1), dvec3(0, -1, 0), dvec3(0.6, 0, 0.8)}) {
        const GridLight l = sampler.at(p, n);
        REQUIRE(std::isfinite(l.light.x + l.light.y + l.light.z));
        REQUIRE(l.share >= 0);
        REQUIRE(l.share <= 1);
      }
  };
  AmbientGrid grid = smooth();
  check(grid);
  for (auto& point : grid.points) point.distances.assign(point.distances.size(), {0, 0});
  check(grid);
  for (auto& point : grid.points) point.distances.assign(point.distances.size(), {float(inf), float(inf)});
  check(grid);
  for (auto& point : grid.points) point.distances.assign(point.distances.size(), {1e-20f, 1e30f});
  check(grid);
  for (auto& point : grid.points) point.distances.clear();
  check(grid);
  for (auto& point : grid.points) point.valid = false;
  const GridSampler none(grid);
  CHECK(none.at(grid.position({1, 1, 1}), {0, 1, 0}).share == 0);
  check(grid);
  grid.counts = {1, 1, 1};
  grid.points.resize(1);
  grid.points[0].valid = true;
  check(grid);
  CHECK(GridSampler(grid).at(grid.origin - grid.axes[1] * 0.1, grid.axes[1]).share == 1);
}
