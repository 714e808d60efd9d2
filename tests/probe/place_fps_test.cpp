// The rooms of samples/fps.
#include <catch2/catch.hpp>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <iostream>

#include "paths.h"
#include "place_rooms.h"

using namespace burnish;
using namespace burnish::test;

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
