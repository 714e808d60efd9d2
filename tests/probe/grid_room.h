// What the tests of pictures lit by a lattice share: a cube of a metre with an emissive ceiling, its lattice, things in it.
#pragma once
#include "grid_oracle.h"
#include "grid_sampler.h"
#include "render/scenes.h"

namespace burnish::test {

/// What shows ambient light and nothing else: diffuse white reflects all of it.
inline Quality bare(Path path = Path::Deferred) {
  Quality q;
  q.diffuse = Diffuse::Lambert;
  q.environmentSpecular = EnvironmentSpecular::None;
  q.path = path;
  return q;
}
inline Material white() {
  Material m;
  m.roughness = 1;
  return m;
}

/// 5 points across, the outer ones 1 cm from the walls; green has half of red's light, blue a quarter.
inline AmbientGrid gridOf(const CubeOracle& oracle) {
  AmbientGrid grid = gridIn(dvec3(0), dvec3(1), glm::ivec3(5), 0.01);
  fillGrid(grid, roomOf(dvec3(0), dvec3(1), 0.1), [&](const dvec3& p) {
    const auto sh = oracle.harmonics(p);
    std::array<dvec3, 9> all;
    for (std::size_t k = 0; k < 9; ++k) all[k] = sh[k] * dvec3(1, 0.5, 0.25);
    return all;
  });
  return grid;
}
inline void setGrid(Scene& scene, AmbientGrid grid) {
  scene.probes.grid = std::move(grid);
  ++scene.probes.revision;
}

/// The cube with a ball and a box in it.
inline Scene furnished(double albedo) {
  Scene scene;
  place(scene, box({0, 0, 0}, {1, 1, 1}, true), white());
  Material red = white();
  red.albedo = {0.8f, 0.3f, 0.2f};
  place(scene, sphere(0.15f, 24, 48), red, translation({0.35, 0.3, 0.4}));
  place(scene, box({0.6f, 0.0f, 0.55f}, {0.8f, 0.4f, 0.75f}), white());
  setGrid(scene, gridOf(CubeOracle(albedo, 16)));
  return scene;
}
inline View intoRoom() {
  View v = lookAt({0.9, 0.55, 0.95}, {0.4, 0.35, 0.4}, {0, 1, 0}, 1.2f);
  v.near = 0.01f;
  return v;
}

}  // namespace burnish::test
