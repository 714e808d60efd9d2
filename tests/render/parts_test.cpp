// Large meshes are drawn in parts: what is in view is in them, what is not is left out, and the picture stays.
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <random>

#include "gpu_scene/mesh_parts.h"
#include "render/workshop.h"

namespace burnish::test {
namespace {

constexpr glm::ivec2 kSize{160, 120};

/// A view from a random place near the origin, perspective or orthographic, sampled off the pixels' middles.
scene::ViewFrame randomFrame(std::mt19937& random) {
  std::uniform_real_distribution<double> d(-1, 1);
  View view = lookAt({d(random) * 2, d(random) * 2, d(random) * 2}, {d(random), d(random), d(random)}, {0, 1, 0}, 0.3f + 0.6f * float(d(random) + 1));
  view.orthographic = d(random) > 0.5;
  return scene::frameOf(view, kSize, {0.4 * d(random), 0.4 * d(random)});
}

}  // namespace

TEST_CASE("parts of large meshes: every triangle that reaches into view is drawn, in order and once") {
  const Mesh mesh = sphere(1, 60, 120);
  const auto parts = gpu_scene::partsOf(mesh);
  REQUIRE(parts.size() == (mesh.indices.size() + gpu_scene::kPartIndices - 1) / gpu_scene::kPartIndices);
  CHECK(gpu_scene::partsOf(sphere(1, 4, 8)).empty());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> d(-1, 1);
  gpu_scene::PartRuns runs;
  std::uint64_t drawn = 0, all = 0, needed = 0;
  int several = 0;
  for (int round = 0; round < 200; ++round) {
    const scene::ViewFrame frame = randomFrame(random);
    glm::dmat4 world(1);
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 3; ++r) world[c][r] = d(random);
    scene::VisibleInstance v;
    if (!scene::setPlacement(v, world, frame.eye)) continue;
    runs.find(scene::Frustum(frame), v, parts, int(mesh.indices.size()), 4);
    std::vector<bool> listed(mesh.indices.size());
    std::size_t next = 0;
    for (GLsizei k = 0; k < runs.size(); ++k) {
      const std::size_t first = reinterpret_cast<std::uintptr_t>(runs.offsets()[k]) / 4, count = std::size_t(runs.counts()[k]);
      REQUIRE(first >= next);
      REQUIRE(first + count <= listed.size());
      REQUIRE(count > 0);
      REQUIRE(count % 3 == 0);
      next = first + count + 1;  // runs that touch would be one
      std::fill_n(listed.begin() + std::ptrdiff_t(first), count, true);
    }
    several += runs.size() > 1;
    drawn += runs.indices();
    all += mesh.indices.size();
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      // Outside when all corners are beyond one plane of the view, as the rasterizer clips.
      bool outside = false;
      glm::dvec4 clip[3];
      for (int k = 0; k < 3; ++k) clip[k] = frame.viewProjection * glm::dvec4(dvec3(world * glm::dvec4(dvec3(mesh.positions[mesh.indices[i + std::size_t(k)]]), 1)) - frame.eye, 1);
      for (int axis = 0; axis < 2; ++axis)
        for (const double sign : {1.0, -1.0}) outside |= std::all_of(clip, clip + 3, [&](const glm::dvec4& p) { return sign * p[axis] > p.w; });
      outside |= std::all_of(clip, clip + 3, [](const glm::dvec4& p) { return p.z > p.w; });
      if (outside) continue;
      needed += 3;
      if (!listed[i]) FAIL("round " << round << ", triangle " << i / 3 << " is left out");
    }
  }
  std::cout << fmt::format("  {:.1f} % of the indices reach into view, {:.1f} % are drawn; {} of 200 in several runs\n", 100.0 * double(needed) / double(all), 100.0 * double(drawn) / double(all), several);
  CHECK(several > 50);
  CHECK(double(drawn) < 0.85 * double(all));  // a part of this sphere is a ring and more of it
}

TEST_CASE("a large mesh drawn in parts gives the picture of the whole, on both paths, in every view") {
  Stage stage;
  Workshop parts;
  Material m = Workshop::base();
  const Id<Material> material = parts.scene.materials.add(m);
  const Id<Mesh> mesh = parts.scene.meshes.add(sphere(3, 60, 120));
  const auto put = [&](Scene& scene) {
    Node node;
    node.local = translation({0.5, -0.5, -1});
    scene.instances.add({.node = scene.nodes.add(node), .mesh = mesh, .material = material});
  };
  put(parts.scene);
  // So many in one place are drawn whole, by one call.
  Scene whole = parts.scene;
  for (std::uint32_t i = 1; i < scene::kInstancedFrom; ++i) put(whole);
  for (const Path path : {Path::Deferred, Path::Forward}) {
    Quality quality;
    quality.path = path;
    for (const dvec3 eye : {dvec3(0.2, 0.1, 5), dvec3(0, 0, 0), dvec3(4, 3, -2)}) {
      const View view = lookAt(eye, {0.5, 0.4, -1});
      const Picture a = stage.draw(parts.scene, {&view, 1}, kSize, quality, {}), b = stage.draw(whole, {&view, 1}, kSize, quality, {});
      CHECK(a.stats.triangles < b.stats.triangles);
      int off = 0;
      for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x) off += a.at(x, y) != b.at(x, y);
      CHECK(off == 0);
    }
  }
}

}  // namespace burnish::test
