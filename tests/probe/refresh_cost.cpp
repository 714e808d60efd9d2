// What refreshes cost: test_probe "[refresh_cost]" prints the figures of docs/probes.md, wall time of each kind of piece with the GPU's work in it.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <vector>

#include "probe/probes.h"
#include "probe/reflection_room.h"

using namespace burnish;
using namespace burnish::test;

namespace {

Scene furnished() {
  Scene scene;
  Material m;
  m.albedo = vec3(0.5f);
  addRoom(scene, vec3(-5, -2, -5), vec3(5, 2, 5), m);
  for (int i = 0; i < 40; ++i) place(scene, sphere(0.3f, 12, 16), m, translation({-4 + i % 8 * 1.1, -1, -4 + i / 8 * 1.7}));
  for (int i = 0; i < 8; ++i) addLight(scene, light(LightKind::Point, {1, 1, 1}, 5, 4), {-4.0 + i, 1, 2});
  return scene;
}

std::string spread(std::vector<double>& ms) {
  std::sort(ms.begin(), ms.end());
  return fmt::format("{} of them, median {:.1f} ms, longest {:.1f} ms", ms.size(), ms[ms.size() / 2], ms.back());
}

}  // namespace

TEST_CASE("refresh: what its pieces cost", "[.][refresh_cost]") {
  using Clock = std::chrono::steady_clock;
  for (const int size : {32, 64, 128, 256}) {
    Scene scene = furnished();
    setProbes(scene, {boxed(constantProbe(dvec3(0), size), {0, 0, 0}, {5, 2, 5})});
    Stage stage;
    const auto finish = reinterpret_cast<void (*)()>(stage.context->procAddress()("glFinish"));
    std::vector<double> faces, slices;
    for (int turn = 0; turn < 3; ++turn)
      for (bool ready = false; !ready;) {
        const auto start = Clock::now();
        auto state = stage.renderer->refreshProbe(scene, 0, {});
        REQUIRE(state);
        finish();
        const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
        ready = state->ready;
        if (turn > 0 && !ready) (state->done <= 6 ? faces : slices).push_back(ms);
      }
    std::cout << fmt::format("  faces of {}: {}; slices: {}\n", size, spread(faces), spread(slices));
  }
}
