// Scenes of boxes, and a search of all their triangles in double: what the tests of placement judge by.
#pragma once
#include <algorithm>
#include <cmath>
#include <map>

#include "probe/geometry.h"
#include "render/deformed.h"
#include "render/scenes.h"

namespace burnish::test {

/// One triangle of an instance, in the world, wound as its front is.
struct Facet {
  Id<Instance> instance;
  dvec3 a, u, v;
  bool twoSided = false, opaque = true;
};

inline std::vector<Facet> facetsOf(const Scene& scene) {
  std::vector<Facet> out;
  scene.instances.each([&](Id<Instance> id, const Instance& instance) {
    if (!instance.visible) return;
    const Mesh& mesh = *scene.meshes.get(instance.mesh);
    const Material* material = scene.materials.get(instance.material);
    const std::vector<Vertex> vertices = deformedBy(scene, instance);
    const bool mirrored = !scene.skins.has(instance.skin) && glm::determinant(glm::dmat3(scene.world(instance.node))) < 0;
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
      const dvec3 a = vertices[mesh.indices[t]].position, b = vertices[mesh.indices[t + 1]].position, c = vertices[mesh.indices[t + 2]].position;
      Facet f{id, a, b - a, c - a, material && material->twoSided, !material || (!material->blend && !material->alphaTest && material->transmission == 0)};
      if (mirrored) std::swap(f.u, f.v);
      out.push_back(f);
    }
  });
  return out;
}

/// Distance along the ray, or infinity (Möller and Trumbore 1997).
inline double meets(const Facet& f, dvec3 origin, dvec3 direction) {
  const dvec3 p = glm::cross(direction, f.v);
  const double det = glm::dot(f.u, p);
  if (det == 0) return INFINITY;
  const dvec3 s = origin - f.a, q = glm::cross(s, f.u);
  const double x = glm::dot(s, p) / det, y = glm::dot(direction, q) / det, d = glm::dot(f.v, q) / det;
  return x >= 0 && y >= 0 && x + y <= 1 && d > 0 ? d : INFINITY;
}
inline bool seenFromBehind(const Facet& f, dvec3 direction) { return glm::dot(glm::cross(f.u, f.v), direction) > 0; }

/// Inside a body: most rays in irregular directions leave one and the same instance through more backs than they enter through fronts.
inline bool insideSolid(const std::vector<Facet>& facets, dvec3 point) {
  const dvec3 directions[] = {{0.531, 0.722, 0.443}, {-0.612, 0.431, -0.663}, {0.213, -0.911, 0.353}, {-0.377, -0.253, 0.891}, {0.845, 0.119, -0.521}};
  std::map<std::uint32_t, int> votes;
  for (const dvec3& d : directions) {
    std::map<std::uint32_t, int> balance;
    for (const Facet& f : facets)
      if (f.opaque && !f.twoSided && std::isfinite(meets(f, point, d))) balance[f.instance.index] += seenFromBehind(f, d) ? 1 : -1;
    for (const auto& [instance, count] : balance) votes[instance] += count > 0;
  }
  return std::any_of(votes.begin(), votes.end(), [](const auto& v) { return v.second > 2; });
}

inline probe::Geometry geometryOf(const Scene& scene) {
  auto made = probe::Geometry::create(scene, nullptr);
  if (!made) FAIL(made.error().message());
  return std::move(*made);
}

/// A turn about +Y, degrees, then a move.
inline glm::dmat4 turned(double degrees, dvec3 to = dvec3(0)) {
  glm::dmat4 m = translation(to);
  const double a = degrees * kPi / 180;
  m[0] = {std::cos(a), 0, -std::sin(a), 0};
  m[2] = {std::sin(a), 0, std::cos(a), 0};
  return m;
}

}  // namespace burnish::test
