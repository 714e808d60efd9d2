// Two rooms that know nothing of each other: four reflection probes, a lattice through both, a lamp in each.
#pragma once
#include "probe/capture.h"
#include "store_fixture.h"

namespace store_test {

/// Quads with their fronts toward `inside`.
inline Mesh box(glm::vec3 half, bool inside) {
  Mesh mesh;
  for (int face = 0; face < 6; ++face) {
    glm::vec3 n(0), u(0), v(0);
    n[face / 2] = face % 2 ? -1.0f : 1.0f;
    u[(face / 2 + 1) % 3] = 1;
    v = glm::cross(n, u);
    const auto first = std::uint32_t(mesh.positions.size());
    for (const auto& [s, t] : {std::pair(-1.0f, -1.0f), {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
      mesh.positions.push_back((n + s * u + t * v) * half);
      mesh.normals.push_back(inside ? -n : n);
    }
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
    if (inside) std::reverse(mesh.indices.end() - 6, mesh.indices.end());
  }
  return mesh;
}

struct Rooms {
  Scene scene;
  Id<Light> lamps[2];
  Id<Material> walls[2], table[2];
  Id<Node> tables[2];
};

inline Rooms twoRooms() {
  Rooms out;
  Scene& s = out.scene;
  Report report;
  const Id<Mesh> room = s.meshes.add(validated(box({2, 1.5, 2}, true), report).value()), block = s.meshes.add(validated(box({0.4, 0.3, 0.3}, false), report).value());
  for (int i = 0; i < 2; ++i) {
    const double x = 20 * i;
    const auto node = [&](glm::dvec3 at) {
      glm::dmat4 local(1);
      local[3] = glm::dvec4(at, 1);
      return s.nodes.add({"", {}, local});
    };
    out.walls[i] = s.materials.add({.albedo = i ? glm::vec3(0.2f, 0.3f, 0.8f) : glm::vec3(0.8f, 0.5f, 0.3f), .roughness = 0.7f});
    out.table[i] = s.materials.add({.albedo = glm::vec3(0.5f), .roughness = 0.4f});
    out.tables[i] = node({x + 0.5, -1.2, 0.3});
    s.instances.add({.node = node({x, 0, 0}), .mesh = room, .material = out.walls[i]});
    s.instances.add({.node = out.tables[i], .mesh = block, .material = out.table[i]});
    Light lamp;
    lamp.node = node({x - 0.5, 1, 0.2});
    lamp.intensity = 40, lamp.range = 8, lamp.castsShadow = true;
    out.lamps[i] = s.lights.add(lamp);
    for (int half = 0; half < 2; ++half) {
      ReflectionProbe& p = s.probes.reflections.emplace_back();
      p.name = std::string(i ? "blue" : "red") + (half ? " east" : " west");
      p.center = p.capture = {x + (half ? 1.0 : -1.0), 0, 0.1};
      p.center.z = 0;
      p.halfSize = {1, 1.5, 2};
    }
  }
  AmbientGrid& grid = s.probes.grid.emplace();
  // Beside the rooms' planes of symmetry: rays along the edge of two triangles meet either, and their distances differ in the last digit.
  grid.origin = {-1.03, 0.07, -0.96}, grid.spacing = {1.76, 1, 1.97}, grid.counts = {14, 1, 2};
  return out;
}

inline BakeOptions smallBake() {
  BakeOptions options;
  options.size = options.ambientSize = 16;
  options.bounces = 3;
  return options;
}

}  // namespace store_test
