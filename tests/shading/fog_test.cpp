// Fog: optical depth against quadrature in double, the phase function's integrals, and numbers that break naive forms.
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <random>

#include "reference/quadrature.h"
#include "reference/shading.h"

using namespace burnish;
using namespace burnish::shading;

namespace {

struct Way {
  double from, to, length, start, density, falloff;
};

/// The integral of density · exp(-falloff · h) over what is not clear, by Gauss's rule in pieces of at most half an e-fold, from the lower end up.
double byQuadrature(const Way& w) {
  static const reference::GaussRule rule(12);
  const double first = std::min(w.start, w.length) / w.length, fold = w.falloff * std::abs(w.to - w.from) * (1 - first);
  const int pieces = int(std::min(std::ceil(2 * fold) + 1, 4000.0));
  const double used = std::min(1.0, pieces / std::max(2 * fold, 1e-9));  // past 2000 e-folds nothing is left
  const double begin = w.from + (w.to - w.from) * first, low = std::min(begin, w.to), rise = std::abs(w.to - begin) * used;
  double sum = 0;
  for (int k = 0; k < pieces; ++k)
    for (std::size_t i = 0; i < rule.node.size(); ++i) sum += rule.weight[i] / pieces * w.density * std::exp(-w.falloff * (low + rise * (k + rule.node[i]) / pieces));
  return sum * w.length * (1 - first) * used;
}

std::vector<Way> ways() {
  std::vector<Way> all;
  for (const double falloff : {0.0, 1e-6, 1e-3, 0.05, 2.0})
    for (const double from : {-30.0, 0.0, 1.7, 400.0})
      for (const double slope : {-1.0, -0.3, -1e-5, 0.0, 1e-7, 0.02, 1.0})
        for (const double length : {0.01, 3.0, 250.0, 1e4, 1e6})
          for (const double start : {0.0, 2.0}) {
            const Way w{from, from + slope * length, length, start, 0.004, falloff};
            if (-falloff * std::min(w.from, w.to) < 30) all.push_back(w);
          }
  return all;
}

}  // namespace

TEST_CASE("fog's optical depth is the integral of its extinction, in double and in float") {
  double worstDouble = 0, worstFloat = 0;
  for (const Way& w : ways()) {
    const double exact = byQuadrature(w);
    const double d = f64::fogDepth(w.from, w.to, w.length, w.start, w.density, w.falloff);
    const double f = f32::fogDepth(float(w.from), float(w.to), float(w.length), float(w.start), float(w.density), float(w.falloff));
    INFO(fmt::format("from {} to {} over {}, start {}, falloff {}", w.from, w.to, w.length, w.start, w.falloff));
    if (w.length <= w.start) {
      REQUIRE(d == 0);
      REQUIRE(f == 0);
      continue;
    }
    // Heights in float are off by half an ulp of the larger, whatever the text does with them; what is left of them after `start` by as much.
    const double heights = w.falloff * (std::abs(w.from) + std::abs(w.to) + 1) * 0x1p-23;
    REQUIRE(std::abs(d - exact) <= 3e-9 * exact);
    REQUIRE(std::abs(f - exact) <= (3e-6 + 4 * heights) * exact + 1e-30);
    worstDouble = std::max(worstDouble, exact > 0 ? std::abs(d / exact - 1) : 0);
    worstFloat = std::max(worstFloat, exact > 1e-30 && heights < 1e-5 ? std::abs(f / exact - 1) : 0);
  }
  std::cout << fmt::format("  fog's optical depth: relative error {:.1e} in double, {:.1e} in float, over {} ways\n", worstDouble, worstFloat, ways().size());
}

TEST_CASE("a way to the sky meets density / (falloff · slope), a level one density · length; both agree where they meet") {
  for (const double slope : {0.01, 0.2, 1.0}) CHECK(f64::fogDepth(5, 5 + slope * 1e6, 1e6, 0, 0.003, 0.05) == Approx(0.003 * std::exp(-0.25) / (0.05 * slope)).epsilon(1e-9));
  CHECK(f64::fogDepth(5, 5, 1e6, 0, 0.003, 0.05) == Approx(0.003 * std::exp(-0.25) * 1e6));
  // The series and the closed form of (1 - e^-x)/x take over from each other without a step.
  const double below = std::nextafter(0.0625, 0), above = 0.0625;
  CHECK(std::abs(f64::meanExponential(below) - f64::meanExponential(above)) < 2e-9);
  CHECK(std::abs(f32::meanExponential(float(below)) - f32::meanExponential(float(above))) < 1e-6f);
  CHECK(f64::meanExponential(0) == 1);
  for (double x = 1e-9; x < 600; x *= 1.7) {
    CHECK(f64::meanExponential(x) == Approx(-std::expm1(-x) / x).epsilon(2e-9));
    CHECK(f32::meanExponential(float(x)) == Approx(-std::expm1(-x) / x).epsilon(2e-6));
  }
}

TEST_CASE("fog lets through what it does not take") {
  for (double depth = 1e-8; depth < 1e5; depth *= 3) {
    CHECK(f64::fogThrough(depth) + f64::fogTaken(depth) == Approx(1).epsilon(3e-9));
    CHECK(f32::fogThrough(float(depth)) + f32::fogTaken(float(depth)) == Approx(1).epsilon(1e-6));
    CHECK(f32::fogTaken(float(depth)) == Approx(-std::expm1(-depth)).epsilon(2e-6));
  }
  CHECK(f32::fogThrough(1e18f) == 0);
  CHECK(f32::fogTaken(1e18f) == Approx(1));
}

TEST_CASE("fog stays finite far above, far below, over no way at all and without end") {
  for (const float falloff : {0.0f, 1e-6f, 0.05f, 1e6f})
    for (const float from : {-1e9f, -1e4f, 0.0f, 1e4f, 1e9f})
      for (const float to : {-1e9f, -1e4f, 0.0f, 1e4f, 1e9f})
        for (const float way : {0.0f, 1e-20f, 1.0f, 1e6f, 1e18f})
          for (const float density : {0.0f, 1e-30f, 0.01f, 1e6f}) {
            const float depth = f32::fogDepth(from, to, way, 0, density, falloff);
            REQUIRE(depth >= 0);
            REQUIRE(depth <= 1e18f);
            REQUIRE(std::isfinite(f32::fogThrough(depth)));
            REQUIRE(f32::fogTaken(depth) <= 1 + 1e-6f);
          }
  // An eye above what floats can tell from empty still sees the layer under it whole.
  CHECK(f32::fogDepth(1e5f, 0, 1e5f, 0, 0.01f, 0.05f) == Approx(0.01 / 0.05).epsilon(1e-5));
}

TEST_CASE("the phase function scatters all that comes, with its mean cosine and the harmonics g^l") {
  const reference::GaussRule rule(256);
  for (const double g : {-0.95, -0.4, 0.0, 0.3, 0.76, 0.95}) {
    double sum = 0, first = 0, second = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double c = 2 * rule.node[i] - 1, p = f64::phaseHenyeyGreenstein(c, g) * rule.weight[i] * 4 * 3.14159265358979323846;
      sum += p, first += p * c, second += p * (1.5 * c * c - 0.5);
      CHECK(f32::phaseHenyeyGreenstein(float(c), float(g)) == Approx(f64::phaseHenyeyGreenstein(double(float(c)), double(float(g)))).epsilon(3e-5));
    }
    CHECK(sum == Approx(1).epsilon(1e-6));
    CHECK(first == Approx(g).margin(1e-6));
    CHECK(second == Approx(g * g).margin(1e-6));
  }
  CHECK(f64::phaseHenyeyGreenstein(1, 0.5) > f64::phaseHenyeyGreenstein(-1, 0.5));
}
