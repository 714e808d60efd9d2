// Lobes over a pixel: filteredAlpha against the mean of Beckmann's lobe over the pixel's filter, in double.
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <iostream>

#include "reference/shading.h"
#include "sphere.h"

using namespace burnish::test;
using glm::dvec3;
namespace f64 = burnish::shading::f64;
namespace f32 = burnish::shading::f32;

namespace {

/// Density of Beckmann's slopes: a Gaussian with variance alpha²/2 along each axis.
double slopes(double alpha, double x, double y) { return std::exp(-(x * x + y * y) / (alpha * alpha)) / (kPi * alpha * alpha); }

/// The mean of that density over a Gaussian pixel filter on a surface whose slope turns by kx and ky a pixel along the two axes, by sums over a grid that reaches six widths.
double meanSlopes(double alpha, double kx, double ky, double x, double y) {
  constexpr int kSteps = 400;
  const double sigma = std::sqrt(1 / (2 * kPi));
  double sum = 0, total = 0;
  for (int j = -kSteps; j <= kSteps; ++j)
    for (int i = -kSteps; i <= kSteps; ++i) {
      const double u = 6 * sigma * i / kSteps, v = 6 * sigma * j / kSteps, w = std::exp(-(u * u + v * v) / (2 * sigma * sigma));
      sum += w * slopes(alpha, x - kx * u, y - ky * v);
      total += w;
    }
  return sum / total;
}

}  // namespace

TEST_CASE("the lobe of a pixel on a curved surface is the mean of its lobes") {
  for (const double alpha : {0.01, 0.04, 0.2})
    for (const double turn : {0.25, 1.0, 3.0}) {  // of alpha, a pixel
      const double k = turn * alpha;
      const double wide = f64::filteredAlpha(alpha, dvec3(k, 0, 0), dvec3(0, k, 0));
      CAPTURE(alpha, turn);
      for (const double at : {0.0, 0.7, 1.5}) CHECK(slopes(wide, at * alpha, 0) == Approx(meanSlopes(alpha, k, k, at * alpha, 0)).epsilon(1e-6));
      // Turned along one axis alone, the lobe is round all the same: the variance of both axes together is right.
      const double bent = f64::filteredAlpha(alpha, dvec3(k, 0, 0), dvec3(0));
      CHECK(bent * bent - alpha * alpha == Approx(0.5 * (wide * wide - alpha * alpha)).epsilon(1e-9));
    }
}

TEST_CASE("a filtered lobe is never narrower than the lobe, never wider than the limit") {
  double before = 0;
  for (const double turn : {0.0, 1e-4, 0.01, 0.1, 0.5, 1.0, 2.0, 1e9}) {
    const double a = f64::filteredAlpha(0.1, dvec3(turn, 0, 0), dvec3(0, 0, turn));
    CHECK(a >= before);
    CHECK(a >= 0.1);
    CHECK(a <= std::sqrt(0.01 + 0.18) + 1e-12);
    before = a;
  }
  CHECK(before == Approx(std::sqrt(0.19)));
  CHECK(f64::filteredAlpha(0.3, dvec3(0), dvec3(0)) == Approx(0.3));
  CHECK(f64::filteredAlpha(1, dvec3(1), dvec3(1)) == 1);
  CHECK(f32::filteredAlpha(0.5f, glm::vec3(3e38f), glm::vec3(-3e38f)) == Approx(std::sqrt(0.25 + 0.18)));
}
