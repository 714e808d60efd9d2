// H11: a thin wall between a lit and a dark room, one lattice over both. Points in the lit room have light 1, those in the dark one none; what the lattice says of the dark room's surfaces is the leak.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "grid_sampler.h"
#include "stability/two_rooms.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;

namespace {

using Rooms = stability::TwoRooms;
using stability::latticeOver;
using stability::onSurfaces;
constexpr int kSteps = 48;

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
        onSurfaces(rooms, thickness, kSteps, [&](const dvec3& p, const dvec3& n) {
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
        onSurfaces(rooms, -2, kSteps, [&](const dvec3& p, const dvec3& n) {
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
