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

/// Inside a body: in every one of many directions a ray leaves one and the same instance through more backs than it enters through fronts. (A sheet, which has no inside, is left in half of them.)
class Solids {
 public:
  explicit Solids(const Scene& scene) {
    for (const Facet& f : facetsOf(scene)) {
      if (!f.opaque || f.twoSided) continue;
      Body& body = bodies_[f.instance.index];
      body.facets.push_back(f);
      for (const dvec3& corner : {f.a, f.a + f.u, f.a + f.v}) body.low = glm::min(body.low, corner), body.high = glm::max(body.high, corner);
    }
  }
  [[nodiscard]] bool hold(dvec3 point) const {
    return std::any_of(bodies_.begin(), bodies_.end(), [&](const auto& b) {
      return glm::all(glm::lessThan(b.second.low, point)) && glm::all(glm::lessThan(point, b.second.high)) && inside(b.second, point);
    });
  }

 private:
  struct Body {
    std::vector<Facet> facets;
    dvec3 low{INFINITY}, high{-INFINITY};
  };
  static bool inside(const Body& body, dvec3 point) {
    constexpr int kDirections = 14;
    for (int i = 0; i < kDirections; ++i) {
      const double y = 1 - 2 * (i + 0.5) / kDirections, r = std::sqrt(1 - y * y), turn = 2.399963 * i + 0.3;
      const dvec3 d(r * std::cos(turn), y, r * std::sin(turn));
      int balance = 0;
      for (const Facet& f : body.facets)
        if (std::isfinite(meets(f, point, d))) balance += seenFromBehind(f, d) ? 1 : -1;
      if (balance <= 0) return false;
    }
    return true;
  }
  std::map<std::uint32_t, Body> bodies_;
};

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
