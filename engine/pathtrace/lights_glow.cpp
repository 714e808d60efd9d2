#include "pathtrace/lights_glow.h"

#include <algorithm>
#include <cmath>

#include "pathtrace/lights.h"

namespace burnish::pathtrace {

using glm::dvec3;
using glm::vec3;

namespace {

constexpr double kPi = 3.14159265358979324;
constexpr int kRays = 256;
constexpr double kNear = 0.5;  // metres

/// Evenly over the sphere (a spherical Fibonacci lattice).
dvec3 direction(int i) {
  const double z = 1 - (2 * i + 1.0) / kRays, phi = 2.39996322972865332 * i, s = std::sqrt(1 - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

float solidAngle(float halfAngle) {
  const float s = std::sin(0.5f * halfAngle);
  return float(4 * kPi) * s * s;
}

}  // namespace

Glows::Glows(const World& world) {
  for (const PunctualLight& light : world.lights()) {
    if (light.directional) continue;
    double power = 0, weight = 0, weighted = 0;
    dvec3 middle(0);
    for (int i = 0; i < kRays; ++i) {
      SurfacePoint p;
      PathRay ray;
      ray.origin = light.position;
      ray.direction = direction(i);
      if (!world.nearest(ray, p) || p.distance > kNear || p.unlit) continue;
      // What falls on it, in candela: the inverse square is the lattice's.
      const double d2 = std::max(p.distance * p.distance, 1e-4), candela = double(luminance(receive(light, p.position).irradiance)) * d2 * double(std::max(luminance(p.albedo), 0.02f));
      if (!(candela > 0) || !std::isfinite(candela)) continue;
      const double brightness = candela / d2;
      power += candela * 4 * kPi / kRays;
      weight += brightness, weighted += brightness * p.distance, middle += p.position * brightness;
    }
    if (!(weight > 0)) continue;
    // The ball around the spots, by brightness.
    const dvec3 center = middle / weight;
    glows_.push_back({center, float(std::clamp(1.5 * weighted / weight, 0.02, kNear)), float(power)});
  }
  std::stable_sort(glows_.begin(), glows_.end(), [](const Glow& a, const Glow& b) { return a.power / (a.radius * a.radius) > b.power / (b.radius * b.radius); });
  if (glows_.size() > kMost) glows_.resize(kMost);
}

Glows::Cones Glows::from(const dvec3& at, const vec3& normal) const {
  Cones cones;
  float sum = 0;
  for (const Glow& glow : glows_) {
    const vec3 to(glow.middle - at);
    const float d2 = glm::dot(to, to);
    if (d2 < 4 * glow.radius * glow.radius || glm::dot(to, normal) < -glow.radius) continue;
    const float d = std::sqrt(d2), sine = glow.radius / d;
    const std::size_t i = cones.count++;
    cones.axis[i] = to / d;
    cones.halfAngle[i] = std::asin(sine);
    cones.sine2[i] = sine * sine;
    cones.density[i] = glow.power / d2;
    sum += cones.density[i];
  }
  if (!(sum > 0)) cones.count = 0;
  for (std::size_t i = 0; i < cones.count; ++i) cones.density[i] /= sum * solidAngle(cones.halfAngle[i]);
  return cones;
}

vec3 Glows::sample(const Cones& cones, float pick, const glm::vec2& place) {
  std::size_t i = 0;
  for (; i + 1 < cones.count; ++i) {
    const float chance = cones.density[i] * solidAngle(cones.halfAngle[i]);
    if (pick < chance) break;
    pick -= chance;
  }
  return inCone(cones.axis[i], cones.halfAngle[i], place);
}

float Glows::density(const Cones& cones, const vec3& direction) {
  float sum = 0;
  // By the sine: cosines of narrow cones round.
  for (std::size_t i = 0; i < cones.count; ++i) {
    const vec3 across = glm::cross(cones.axis[i], direction);
    if (glm::dot(across, across) <= cones.sine2[i] && glm::dot(cones.axis[i], direction) > 0) sum += cones.density[i];
  }
  return sum;
}

}  // namespace burnish::pathtrace
