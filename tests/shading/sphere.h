// Unit vectors and quadrature that the shading tests share.
#pragma once
#include <cmath>
#include <glm/glm.hpp>
#include <random>

namespace burnish::test {

inline constexpr double kPi = 3.14159265358979323846;

/// Uniform on the sphere.
inline glm::dvec3 randomUnit(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const double z = 2 * uniform(random) - 1, phi = 2 * kPi * uniform(random), s = std::sqrt(1 - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

/// Angle between unit vectors, radians; exact also where it is tiny.
inline double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return 2 * std::asin(std::fmin(0.5 * glm::length(a - b), 1.0));
}

/// Unit vector in the xz plane at cosine `nov` from +z.
inline glm::dvec3 viewAt(double nov) { return {std::sqrt(1 - nov * nov), 0, nov}; }

/// Integral of f(direction) over the hemisphere about +z by midpoints, for f symmetric about the xz plane.
template <class F>
double integrateHemisphere(F&& f, int steps) {
  double sum = 0;
  const double dTheta = 0.5 * kPi / steps, dPhi = kPi / steps;
  for (int i = 0; i < steps; ++i) {
    const double theta = (i + 0.5) * dTheta, s = std::sin(theta), c = std::cos(theta);
    double ring = 0;
    for (int j = 0; j < steps; ++j) {
      const double phi = (j + 0.5) * dPhi;
      ring += f(glm::dvec3(s * std::cos(phi), s * std::sin(phi), c));
    }
    sum += ring * s;
  }
  return 2 * sum * dTheta * dPhi;
}

}  // namespace burnish::test
