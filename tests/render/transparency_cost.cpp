// What transparent surfaces cost: printed, not judged. Hidden: test_render "[transparency-cost]".
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "render/transparent.h"

namespace burnish::test {
namespace {

Material blended(float opacity) {
  Material m;
  m.blend = m.twoSided = true;
  m.opacity = opacity;
  m.roughness = 0.4f;
  return m;
}
}  // namespace

TEST_CASE("what transparent surfaces cost", "[.][transparency-cost]") {
  Stage stage;
  struct Row {
    const char* name;
    std::function<void(Scene&)> fill;
  };
  const auto panes = [](Scene& s, const Material& m, dvec3 step, double turn) {
    for (int i = 0; i < 8; ++i) {
      glm::dmat4 at = glm::rotate(glm::dmat4(1), turn * i, dvec3(0, 1, 0));
      at[3] = glm::dvec4(step * (i - 3.5), 1);
      place(s, quad({0, 0, 0}, {0.3f, 0, 0}, {0, 0.5f, 0}), m, at);
    }
  };
  const Row rows[] = {
      {"8 blended panes side by side", [&](Scene& s) { panes(s, blended(0.5f), {0.7, 0, 0}, 0); }},
      {"8 blended panes one behind the other", [&](Scene& s) { panes(s, blended(0.5f), {0, 0, 0.1}, 0); }},
      {"8 blended panes that cross (peeled)", [&](Scene& s) { panes(s, blended(0.5f), {0, 0, 0}, kPi / 8); }},
      {"a clear pane of glass", [&](Scene& s) { place(s, quad({0, 0, 0}, {0.9f, 0, 0}, {0, 0.9f, 0}), glassOf(1.5f, 0, 0)); }},
      {"a frosted pane of glass", [&](Scene& s) { place(s, quad({0, 0, 0}, {0.9f, 0, 0}, {0, 0.9f, 0}), glassOf(1.5f, 0, 0.4f)); }},
      {"a slab of glass", [&](Scene& s) { place(s, quad({0, 0, 0}, {0.9f, 0, 0}, {0, 0.9f, 0}), glassOf(1.5f, 0.2f, 0)); }},
      {"a ball of glass", [&](Scene& s) { place(s, sphere(0.9f, 48, 96), glassOf(1.5f, 1.8f, 0)); }},
      {"8 balls of glass in a row", [&](Scene& s) { for (int i = 0; i < 8; ++i) place(s, sphere(0.3f, 32, 64), glassOf(1.5f, 0.6f, 0), translation({0.7 * (i - 3.5), 0, 0})); }},
  };
  const View view = lookAt({0, 0.3, 4.5}, {0, 0, 0});
  for (const Row& row : rows) {
    Workshop w;
    row.fill(w.scene);
    std::vector<double> times;
    std::string bytes;
    for (int frame = 0; frame < 12; ++frame) {
      RenderRequest request;
      request.timing = TimingMode::Profile;
      const Picture p = stage.draw(w.scene, {&view, 1}, {1280, 720}, {}, request);
      for (const PassTime& t : p.stats.passes)
        if (t.name == "transparent" && frame > 2) times.push_back(t.cpuMs);
    }
    REQUIRE(times.size() > 4);
    std::sort(times.begin(), times.end());
    std::cout << fmt::format("  {:<40} {:7.2f} ms ({:.2f} to {:.2f})\n", row.name, times[times.size() / 2], times[times.size() / 4], times[times.size() * 3 / 4]);
  }
}

}  // namespace burnish::test
