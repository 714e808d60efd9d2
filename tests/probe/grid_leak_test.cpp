// H11: a thin wall between a lit and a dark room, one lattice over both. Points in the lit room have light 1, those in the dark one none; what the lattice says of the dark room's surfaces is the leak.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "grid_sampler.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;

namespace {

/// Two rooms of 2 m x 2 m x 2 m side by side along `axis` of `frame`: the lit one below 0, the dark one above `thickness`.
struct Rooms {
  int axis;
  double thickness;
  glm::dmat3 frame{1};
  /// In the rooms' own axes.
  [[nodiscard]] dvec3 place(double along, double u, double v) const {
    dvec3 p;
    p[axis] = along, p[(axis + 1) % 3] = u, p[(axis + 2) % 3] = v;
    return p;
  }
  [[nodiscard]] std::vector<Solid> solids() const {
    std::vector<Solid> all = roomOf(place(-2, 0, 0), place(2 + thickness, 2, 2), 0.2);
    all.push_back({place(0, -0.1, -0.1), place(thickness, 2.1, 2.1)});
    return all;
  }
};

/// Spacing 0.49 m, so that 5 points stand across a room; `offset` moves them along the axis, `turn` (radians) turns the lattice against the rooms.
AmbientGrid latticeOver(const Rooms& rooms, double offset, double turn) {
  AmbientGrid grid;
  grid.spacing = dvec3(0.49);
  const dvec3 around = rooms.place(0, 1, 0);
  grid.axes = rooms.frame * glm::dmat3(glm::rotate(glm::dmat4(1), turn, around));
  const int more = turn != 0 ? 3 : 0;  // along what is turned
  grid.counts = glm::ivec3(rooms.place(10 + more, 5, 5 + more));
  const dvec3 middle = rooms.place(rooms.thickness / 2 + offset, 1, 1);
  grid.origin = rooms.frame * middle - grid.axes * (dvec3(grid.counts - 1) * grid.spacing * 0.5);
  fillGrid(
      grid, rooms.solids(), [&](const dvec3& p) { return std::array<dvec3, 9>{dvec3(dot(p, rooms.frame[rooms.axis]) < 0 ? 1.0 : 0.0)}; }, rooms.frame);
  return grid;
}

struct Leak {
  double sum = 0, worst = 0;  ///< of the lit side's light
  int count = 0, over = 0, without = 0;  ///< places; those over 1 %; those where the lattice has less than its full say
  void add(double light, double share) {
    sum += light * share;
    worst = std::fmax(worst, light * share);
    ++count;
    over += light * share > 0.01;
    without += share < 0.99;
  }
};

/// On the six surfaces of a room from `begin` along the axis.
template <class F>
void onSurfaces(const Rooms& rooms, double begin, F&& f) {
  constexpr int kSteps = 48;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double a = 2 * (i + 0.5) / kSteps, b = 2 * (j + 0.5) / kSteps;
      for (const double side : {0.0, 2.0}) {
        f(rooms.frame * rooms.place(begin + side, a, b), rooms.frame * rooms.place(1 - side, 0, 0));
        f(rooms.frame * rooms.place(begin + a, side, b), rooms.frame * rooms.place(0, 1 - side, 0));
        f(rooms.frame * rooms.place(begin + a, b, side), rooms.frame * rooms.place(0, 0, 1 - side));
      }
    }
}

}  // namespace

TEST_CASE("H11: light of a lit room on the dark side of a wall") {
  const glm::dmat3 turned(glm::rotate(glm::dmat4(1), 0.7, glm::normalize(dvec3(1, 2, 3))));
  for (const double thickness : {0.02, 0.2})
    for (const auto& [turn, frame] : {std::pair(0.0, glm::dmat3(1)), std::pair(0.4, glm::dmat3(1)), std::pair(0.0, turned)}) {
      Leak all;
      Leak lost;
      int which = 0;
      for (const double offset : {0.0, 0.06, 0.13, 0.2}) {
        const Rooms rooms{which++ % 3, thickness, frame};
        const AmbientGrid grid = latticeOver(rooms, offset, turn);
        const GridSampler sampler(grid);
        Leak leak;
        onSurfaces(rooms, thickness, [&](const dvec3& p, const dvec3& n) {
          const GridLight l = sampler.at(p, n);
          leak.add(l.light.x, l.share);
          all.add(l.light.x, l.share);
        });
        CAPTURE(thickness, turn, offset);
        CHECK(leak.sum / leak.count < 1e-3);
        // Where the lattice is turned against the walls, single places by the edges may see past them.
        if (turn == 0) CHECK(leak.worst < 0.01);
        CHECK(leak.over < 1e-3 * leak.count);
        CHECK(leak.without < 0.1 * leak.count);
        // And the dark room takes nothing from the lit one.
        onSurfaces(rooms, -2, [&](const dvec3& p, const dvec3& n) {
          const GridLight l = sampler.at(p, n);
          lost.add(1 - l.light.x, l.share);
        });
      }
      CHECK(lost.sum / lost.count < 1e-3);
      WARN("wall of " << 100 * thickness << " cm, " << (frame == turned ? "rooms and lattice turned against the world" : turn != 0 ? "lattice turned against the rooms" : "nothing turned") << ": leak " << 100 * all.sum / all.count << " % on the mean, " << 100 * all.worst << " % at worst, " << 100.0 * all.over / all.count << " % of places over 1 %; lit side darker by " << 100 * lost.sum / lost.count << " % on the mean, " << 100 * lost.worst
                      << " % at worst; left to what is there without a lattice: " << 100.0 * all.without / all.count << " % of the dark surfaces");
    }
}

TEST_CASE("H11: things that stand free in the dark room") {
  // Any place and any normal: a surface is looked up a fifth of a cell before itself, so what faces the wall from nearer than that is lit from beyond it. All others see none of it.
  const Rooms rooms{0, 0.02};
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> share(0, 2);
  std::normal_distribution<double> g;
  Leak leak, near;
  for (const double offset : {0.06, 0.13}) {
    const AmbientGrid grid = latticeOver(rooms, offset, 0);
    const GridSampler sampler(grid);
    for (int i = 0; i < 40'000; ++i) {
      const dvec3 p(0.02 + share(random), share(random), share(random)), n = glm::normalize(dvec3(g(random), g(random), g(random)));
      const GridLight l = sampler.at(p, n);
      (p.x + n.x * 0.2 * 0.49 < 0.02 ? near : leak).add(l.light.x, l.share);
    }
  }
  WARN("free surfaces: leak " << 100 * (leak.sum + near.sum) / (leak.count + near.count) << " % on the mean; " << 100 * leak.worst << " % at worst where the lookup stays in the room, "
                              << 100.0 * near.count / (leak.count + near.count) << " % of places are nearer to the wall");
  CHECK((leak.sum + near.sum) / (leak.count + near.count) < 0.01);
  CHECK(leak.sum / leak.count < 1e-3);
}
