// Views from cameras, from eye and target, and from nothing but the scene's bounds.
#include <burnish/plan.h>

#include <algorithm>
#include <cmath>

namespace burnish {
namespace {

// Right-handed orthonormal axes whose third column is `back`; any input gives some.
glm::dmat3 axesFrom(glm::dvec3 back, glm::dvec3 up) {
  if (!(glm::dot(back, back) > 1e-30)) back = {0, 0, 1};
  back = glm::normalize(back);
  glm::dvec3 right = glm::cross(up, back);
  if (!(glm::dot(right, right) > 1e-16 * glm::dot(up, up)) || !(glm::dot(up, up) > 0)) {
    const glm::dvec3 other = std::abs(back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
    right = glm::cross(other, back);
  }
  right = glm::normalize(right);
  return {right, glm::cross(back, right), back};
}

}  // namespace

View lookAt(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 up, float fovY) {
  View v;
  v.eye = eye;
  v.axes = axesFrom(eye - target, up);
  v.fovY = fovY;
  return v;
}

View viewOf(const Scene& scene, const Camera& camera) {
  const glm::dmat4 m = scene.world(camera.node);
  View v;
  v.eye = glm::dvec3(m[3]);
  v.axes = axesFrom(glm::dvec3(m[2]), glm::dvec3(m[1]));
  v.orthographic = camera.orthographic;
  v.fovY = camera.fovY;
  v.height = camera.height;
  v.near = camera.near;
  v.far = camera.far;
  return v;
}

View framingView(const Scene& scene, float aspect) {
  const Bounds b = scene.bounds();
  if (b.empty()) return lookAt({0, 0, 3}, {0, 0, 0});
  const glm::dvec3 center = (glm::dvec3(b.min) + glm::dvec3(b.max)) * 0.5;
  const double radius = std::max(glm::length(glm::dvec3(b.max) - glm::dvec3(b.min)) * 0.5, 1e-6);
  const float fovY = 0.6981317f;  // 40 degrees
  const double half = std::min(fovY * 0.5, std::atan(std::tan(fovY * 0.5) * std::max(aspect, 1e-3f)));
  const double distance = radius / std::sin(half);
  View v = lookAt(center + glm::normalize(glm::dvec3(0.5, 0.35, 1.0)) * distance, center, {0, 1, 0}, fovY);
  v.near = float(std::max((distance - radius) * 0.5, distance * 1e-3));
  return v;
}

}  // namespace burnish
