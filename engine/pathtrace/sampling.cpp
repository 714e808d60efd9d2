#include "pathtrace/sampling.h"

#include <algorithm>
#include <cmath>

namespace burnish::pathtrace {
namespace {

constexpr float kPi = 3.14159265f;

}  // namespace

Frame::Frame(const glm::vec3& normal) : t(0), b(0), n(normal) { shading::f32::basisFrom(n, t, b); }

glm::vec2 onDisc(const glm::vec2& u) {
  const glm::vec2 p = 2.0f * u - 1.0f;
  if (p.x == 0 && p.y == 0) return p;
  const bool wide = std::abs(p.x) > std::abs(p.y);
  const float r = wide ? p.x : p.y, angle = wide ? kPi / 4 * (p.y / p.x) : kPi / 2 - kPi / 4 * (p.x / p.y);
  return r * glm::vec2(std::cos(angle), std::sin(angle));
}

glm::vec3 inCone(const glm::vec3& axis, float halfAngle, const glm::vec2& u) {
  // 1 - cos of the half angle as 2 sin² of its half: narrow cones lose nothing.
  const float s = std::sin(0.5f * halfAngle), drop = 2 * s * s * u.x, sine = std::sqrt(std::max(drop * (2 - drop), 0.0f)), phi = 2 * kPi * u.y;
  return glm::normalize(Frame(axis).toWorld({sine * std::cos(phi), sine * std::sin(phi), 1 - drop}));
}

glm::vec3 visibleGgx(const glm::vec3& eye, float alphaX, float alphaY, const glm::vec2& u) {
  const glm::vec3 v = glm::normalize(glm::vec3(alphaX * eye.x, alphaY * eye.y, std::max(eye.z, 0.0f)));
  const float length2 = v.x * v.x + v.y * v.y;
  const glm::vec3 t = length2 > 0 ? glm::vec3(-v.y, v.x, 0) / std::sqrt(length2) : glm::vec3(1, 0, 0), b = glm::cross(v, t);
  const float r = std::sqrt(u.x), phi = 2 * kPi * u.y, x = r * std::cos(phi), s = 0.5f * (1 + v.z);
  const float y = (1 - s) * std::sqrt(std::max(1 - x * x, 0.0f)) + s * r * std::sin(phi);
  const glm::vec3 h = x * t + y * b + std::sqrt(std::max(1 - x * x - y * y, 0.0f)) * v;
  return glm::normalize(glm::vec3(alphaX * h.x, alphaY * h.y, std::max(h.z, 1e-7f)));
}

// Heitz 2014, eq. 72: G1 = 2/(1 + sqrt(1 + alpha² tan²)).
float visibleGgxShare(float nov, float alphaEye) { return 2 / (nov + std::sqrt(alphaEye * alphaEye * (1 - nov * nov) + nov * nov)); }

}  // namespace burnish::pathtrace
