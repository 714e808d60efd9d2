// What ambient light costs by source and rung: printed, not judged. Hidden: test_probe "[.cost]".
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "grid_room.h"

using namespace burnish;
using namespace burnish::test;

namespace {

/// A probe around the cube, with the light of its middle in all of it.
void addProbe(Scene& scene) {
  ReflectionProbe p;
  p.center = p.capture = dvec3(0.5);
  p.halfSize = dvec3(0.5);
  CubeLevel level;
  level.size = 8;
  level.texels.assign(18 * 64, 0.5f);
  p.radiance.levels = {level};
  const AmbientGrid::Point& middle = scene.probes.grid->points[62];
  for (std::size_t k = 0; k < 9; ++k)
    for (int c = 0; c < 3; ++c) p.irradiance[k][std::size_t(c)] = middle.irradiance[k][c];
  scene.probes.reflections = {p};
  ++scene.probes.revision;
}

}  // namespace

TEST_CASE("what ambient light costs", "[.cost]") {
  struct Row {
    const char* name;
    Ambient ambient;
    AmbientSource source;
    std::vector<double> ms{};
  };
  Row rows[] = {{"no ambient light", Ambient::None, AmbientSource::Probes},      {"one probe, sh-l2", Ambient::ShL2, AmbientSource::Probes}, {"one probe, box", Ambient::Box, AmbientSource::Probes},
                {"lattice, constant", Ambient::Constant, AmbientSource::Grid},    {"lattice, sh-l1", Ambient::ShL1, AmbientSource::Grid},    {"lattice, sh-l2", Ambient::ShL2, AmbientSource::Grid}};
  constexpr glm::ivec2 kSize{1280, 720};
  Stage stage;
  Scene scene = furnished(0.5);
  addProbe(scene);
  Light lamp = light(LightKind::Directional, {1, 1, 1}, 1);
  addLight(scene, lamp, {0, 0, 0}, {0.2, -1, 0.1});  // so that lighting runs without ambient light too
  const View view = intoRoom();
  for (int round = 0; round < 10; ++round)
    for (Row& row : rows) {
      Quality q;
      q.environmentSpecular = EnvironmentSpecular::None;
      q.ambient = row.ambient;
      q.ambientSource = row.source;
      q.shadow = Shadow::None;
      RenderRequest request;
      request.timing = TimingMode::Profile;
      const Picture p = stage.draw(scene, {&view, 1}, kSize, q, request);
      for (const PassTime& t : p.stats.passes)
        if (t.name == "lighting" && round > 0) row.ms.push_back(stage.renderer->capabilities().software ? t.cpuMs : t.gpuMs);
    }
  for (Row& row : rows) {
    REQUIRE(row.ms.size() > 4);
    std::sort(row.ms.begin(), row.ms.end());
    const double ms = row.ms[row.ms.size() / 2], more = ms - rows[0].ms[rows[0].ms.size() / 2];
    std::cout << fmt::format("  {:<20} {:7.2f} ms ({:.2f} to {:.2f}); {:6.1f} ns a pixel over none\n", row.name, ms, row.ms[row.ms.size() / 4], row.ms[row.ms.size() * 3 / 4], 1e6 * more / (kSize.x * kSize.y));
  }
}
