// What the shadow tests share: a plane, a sphere and a thin wall, and whether a ray meets them, in double.
#pragma once
#include "render/scenes.h"

namespace burnish::test {

/// A floor at height 0, a ball that stands on it and a wall 2 cm thick, in metres around `origin`.
struct Yard {
  static constexpr double kHalf = 6, kBallRadius = 0.6;
  const dvec3 ball{-1.1, kBallRadius, 0.3}, wallLow{0.8, 0, -1.2}, wallHigh{0.82, 1.1, 1.2};
  Scene scene;
  dvec3 origin{0};
  Id<Instance> floor, sphereInstance, wall;

  explicit Yard(dvec3 at = dvec3(0)) : origin(at) {
    Material m;
    m.albedo = vec3(0.5f);
    m.roughness = 1;
    m.substance = 1.0f / 3;
    floor = place(scene, quad({0, 0, 0}, {0, 0, float(kHalf)}, {float(kHalf), 0, 0}), m, translation(at));
    sphereInstance = place(scene, test::sphere(float(kBallRadius), 128, 256), m, translation(at + ball));
    wall = place(scene, box(vec3(wallLow), vec3(wallHigh)), m, translation(at));
  }

  struct Hit {
    double t = 1e30;
    dvec3 point{0}, normal{0, 1, 0};
    int what = 0;  ///< 1 floor, 2 ball, 3 wall
  };
  /// What a ray from the eye shows (local coordinates). Things grown by `grow` metres.
  [[nodiscard]] Hit trace(const Ray& r, double grow = 0) const {
    Hit h;
    if (r.direction.y < 0) {
      const double t = -r.origin.y / r.direction.y;
      const dvec3 p = r.origin + r.direction * t;
      if (t > 0 && std::abs(p.x) < kHalf && std::abs(p.z) < kHalf) h = {t, p, {0, 1, 0}, 1};
    }
    const dvec3 o = r.origin - ball;
    const double b = glm::dot(o, r.direction), d = b * b - glm::dot(o, o) + (kBallRadius + grow) * (kBallRadius + grow);
    if (d > 0 && -b - std::sqrt(d) > 1e-9 && -b - std::sqrt(d) < h.t) {
      const double t = -b - std::sqrt(d);
      h = {t, r.origin + r.direction * t, glm::normalize(o + r.direction * t), 2};
    }
    double enter = -1e30, leave = 1e30;
    int axis = 0;
    for (int i = 0; i < 3; ++i) {
      double t0 = (wallLow[i] - grow - r.origin[i]) / r.direction[i], t1 = (wallHigh[i] + grow - r.origin[i]) / r.direction[i];
      if (t0 > t1) std::swap(t0, t1);
      if (t0 > enter) enter = t0, axis = i;
      leave = std::min(leave, t1);
    }
    if (enter < leave && enter > 1e-9 && enter < h.t) {
      h = {enter, r.origin + r.direction * enter, dvec3(0), 3};
      h.normal[axis] = r.direction[axis] > 0 ? -1 : 1;
    }
    return h;
  }
  /// Whether something stands between a point and a light at the end of `toLight` (unit; `distance` m away). Things grown (or shrunk) by `grow`.
  [[nodiscard]] bool blocked(dvec3 p, dvec3 toLight, double distance, double grow) const {
    const Hit h = trace({p, toLight}, grow);
    return h.t < distance;
  }
};

}  // namespace burnish::test
