// A disc of light as an analytic light shows it: the lobe of the direct lights' own shading text over its area, in double. What prefiltered levels are held against (H27 of docs/hard_cases.md).
#pragma once
#include <array>
#include <vector>

#include "reference/shading.h"
#include "stability/cube_texels.h"

namespace burnish::stability {

struct Disc {
  glm::dvec3 centre{1, 0, 0};  ///< unit
  double radius = 0.5 * 0.53 / 360 * kCircle;  ///< radians; the sun's, on the mean
  double radiance = 1000;
  [[nodiscard]] double solidAngle() const { return 2 * kCircle * std::pow(std::sin(radius / 2), 2); }
  [[nodiscard]] bool holds(const glm::dvec3& d) const { return glm::length(d - centre) < 2 * std::sin(radius / 2); }
};

/// What a mirror-like surface of that roughness at n = v = R shows of a disc: ∫ L w(l·R) dl over the disc, over ∫ w over the sphere, w = D(n·h) n·l with the D of shaders/shading.
class DiscProfile {
 public:
  DiscProfile(const Disc& disc, ReflectionLobe lobe, double roughness) : disc_(disc), lobe_(lobe), alpha_(shading::f64::alphaFromRoughness(roughness)), power_(shading::f64::powerFromAlpha(alpha_)) {
    constexpr int kSteps = 200'000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {  // x = t², so that narrow lobes are resolved
      const double t = (i + 0.5) / kSteps;
      sum += weight(t * t) * 2 * t / kSteps;
    }
    total_ = kCircle * sum;
    const glm::dvec3 side = glm::normalize(glm::cross(disc.centre, std::abs(disc.centre.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0))), up = glm::cross(disc.centre, side);
    for (int ring = 0; ring < kRings; ++ring)  // of equal areas
      for (int k = 0; k < kSpokes; ++k) {
        const double x = (ring + 0.5) / kRings * 2 * std::pow(std::sin(disc.radius / 2), 2), s = std::sqrt(x * (2 - x)), phi = (k + 0.5 * (ring % 2)) / kSpokes * kCircle;
        points_.push_back(disc.centre * (1 - x) + (side * std::cos(phi) + up * std::sin(phi)) * s);
      }
  }
  /// Toward R, unit.
  double operator()(const glm::dvec3& r) const {
    double sum = 0;
    for (const glm::dvec3& l : points_) sum += weight(distance(l, r));
    return disc_.radiance * disc_.solidAngle() * sum / (double(points_.size()) * total_);
  }
  /// The same light from the disc's centre alone.
  [[nodiscard]] double ofPoint(const glm::dvec3& r) const { return disc_.radiance * disc_.solidAngle() * weight(distance(disc_.centre, r)) / total_; }
  [[nodiscard]] double peak() const { return (*this)(disc_.centre); }
  /// Angle (radians) at which the lobe is half its peak.
  [[nodiscard]] double halfWidth() const {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) (weight((low + high) / 2) > weight(0) / 2 ? low : high) = (low + high) / 2;
    return std::acos(1 - low);
  }

 private:
  static constexpr int kRings = 6, kSpokes = 12;
  static double distance(const glm::dvec3& l, const glm::dvec3& r) { return glm::dot(l - r, l - r) / 2; }
  /// x = 1 - l·n. The half vector of l and v = n has |n × h|² = x/2.
  [[nodiscard]] double weight(double x) const {
    if (x >= 1) return 0;
    namespace f64 = shading::f64;
    return (lobe_ == ReflectionLobe::Ggx ? f64::D_ggx(x / 2, alpha_) : f64::D_blinnPhong(f64::lobeStable(x / 2, power_), power_)) * (1 - x);
  }

  Disc disc_;
  ReflectionLobe lobe_;
  double alpha_, power_, total_ = 1;
  std::vector<glm::dvec3> points_;
};

/// Radiance times the share of each texel's face area that the disc covers, from 64² points where it is near; black elsewhere.
CubeLevel discCube(int size, const Disc& disc);
/// The same as a lat-long picture, from 16² points.
Image discPicture(int width, const Disc& disc);

}  // namespace burnish::stability
