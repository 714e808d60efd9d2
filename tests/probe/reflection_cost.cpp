// What light of captured places costs: printed, not judged. Hidden: test_probe "[reflection-cost]".
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "probe/reflection_room.h"

namespace burnish::test {

TEST_CASE("what captured places cost", "[.][reflection-cost]") {
  Stage stage;
  struct Row {
    const char* name;
    float sky;
    int places;
    double size;  ///< of the boxes, as a share of the room
    Reflection rung;
    Ambient ambient;
  };
  constexpr Row kRows[] = {
      {"the sky alone", 1, 0, 1, Reflection::Box, Ambient::ShL2},
      {"one place, infinite", 1, 1, 1, Reflection::Infinite, Ambient::ShL2},
      {"one place, box", 1, 1, 1, Reflection::Box, Ambient::ShL2},
      {"one place, box-rough", 1, 1, 1, Reflection::BoxRough, Ambient::ShL2},
      {"one place, box, constant ambient", 1, 1, 1, Reflection::Box, Ambient::Constant},
      {"one place, box, no sky", 0, 1, 1, Reflection::Box, Ambient::ShL2},
      {"one place over half of the picture", 1, 1, 0.5, Reflection::Box, Ambient::ShL2},
      {"two places over all of it", 1, 2, 1, Reflection::Box, Ambient::ShL2},
      {"four places over all of it", 1, 4, 1, Reflection::Box, Ambient::ShL2},
  };
  const View view = lookAt({-2.4, 0.6, 1.6}, {0.8, -0.6, -0.4}, {0, 1, 0}, 1.1f);
  for (const Row& row : kRows) {
    Scene scene;
    scene.environment.color = vec3(row.sky);
    Material m;
    m.roughness = 0.4f;
    place(scene, box({-3, -1.5f, -2}, {3, 1.5f, 2}, true), m);
    place(scene, sphere(0.6f, 32, 64), m, translation({0, -0.9, 0}));
    std::vector<ReflectionProbe> probes;
    for (int i = 0; i < row.places; ++i) {
      ReflectionProbe p = boxed(constantProbe(dvec3(1), 128), dvec3(0), dvec3(3 * row.size + 0.01 * i, 1.5 + 0.01 * i, 2 + 0.01 * i));
      p.fade = dvec3(3);
      probes.push_back(std::move(p));
    }
    setProbes(scene, std::move(probes));
    Quality q;
    q.reflection = row.rung;
    q.ambient = row.ambient;
    std::vector<double> times, tiles;
    for (int frame = 0; frame < 14; ++frame) {
      RenderRequest request;
      request.timing = TimingMode::Profile;
      const Picture p = stage.draw(scene, {&view, 1}, {1280, 720}, q, request);
      for (const PassTime& t : p.stats.passes) {
        if (t.name == "lighting" && frame > 2) times.push_back(t.cpuMs);
        if (t.name == "tiles" && frame > 2) tiles.push_back(t.cpuMs);
      }
    }
    REQUIRE(times.size() > 4);
    std::sort(times.begin(), times.end());
    std::sort(tiles.begin(), tiles.end());
    std::cout << fmt::format("  {:<36} lighting {:6.2f} ms ({:.2f} to {:.2f}), tiles {:.2f} ms\n", row.name, times[times.size() / 2], times[times.size() / 4], times[times.size() * 3 / 4], tiles[tiles.size() / 2]);
  }
}

}  // namespace burnish::test
