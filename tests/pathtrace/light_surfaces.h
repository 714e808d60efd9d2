// Surfaces for the tests of the path tracer's lobes, and what a mean of samples is worth.
#pragma once
#include <cmath>
#include <random>

#include "pathtrace/bsdf.h"
#include "reference/oracle.h"
#include "shading/test_rungs.h"

namespace burnish::test {

inline constexpr double kTurn = 6.283185307179586;

/// A surface with normal +z, as a ray meets it.
inline pathtrace::SurfacePoint surfaceFor(const glm::vec3& albedo, double substance, double alpha) {
  pathtrace::SurfacePoint p;
  p.albedo = albedo, p.substance = float(substance), p.alpha = float(alpha), p.alphaX = float(alpha);
  return p;
}

/// Toward the eye, in the xz plane.
inline glm::vec3 eyeAt(double nov) { return {float(std::sqrt(std::max(1 - nov * nov, 0.0))), 0, float(nov)}; }

/// Mean of samples and its standard error.
class Mean {
 public:
  void add(double x) { ++count_, sum_ += x, squares_ += x * x; }
  [[nodiscard]] double value() const { return sum_ / count_; }
  [[nodiscard]] double error() const { return std::sqrt(std::max(squares_ / count_ - value() * value(), 0.0) / (count_ - 1)); }

 private:
  double count_ = 0, sum_ = 0, squares_ = 0;
};

/// Uniform numbers in [0, 1), the same ones each time.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  float next() { return float(random_() >> 40) * (1.0f / 16777216.0f); }
  glm::vec2 next2() {
    const float x = next();
    return {x, next()};
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace burnish::test
