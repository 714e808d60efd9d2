// Normal storage: the table of docs/shading.md, section 2.
#include <catch2/catch.hpp>
#include <functional>

#include "reference/shading.h"
#include "sphere.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec2;
using glm::dvec3;

namespace {

dvec3 xyz888(const dvec3& n) { return glm::normalize(glm::round((n * 0.5 + 0.5) * 255.0) / 255.0 * 2.0 - 1.0); }

/// Octahedral with codes 0..2^bits - 2, so that the axes are exact.
dvec3 octahedral(const dvec3& n, int bits) {
  const double half = double((1 << bits) - 2) / 2;
  const dvec2 e = shading::f64::octahedralEncode(n);
  return shading::f64::octahedralDecode(glm::floor((e + 1.0) * half + 0.5) / half - 1.0);
}

/// What the G-buffer holds: three 8-bit channels.
dvec3 packed(const dvec3& n) {
  return shading::f64::unpackNormal(glm::round(shading::f64::packNormal(n) * 255.0) / 255.0);
}

/// Two 8-bit channels, and two 16-bit ones.
dvec3 packed8(const dvec3& n) { return shading::f64::unpackNormal8(glm::round(shading::f64::packNormal8(n) * 255.0) / 255.0); }
dvec3 packed16(const dvec3& n) { return shading::f64::unpackNormal16(glm::round(shading::f64::packNormal16(n) * 65535.0) / 65535.0); }

struct Row {
  const char* layout;
  std::function<dvec3(const dvec3&)> store;
  double mean, worst;  // degrees
};

}  // namespace

TEST_CASE("normal encodings err as the table says") {
  const Row rows[] = {
      {"xyz 8:8:8", xyz888, 0.170, 0.386},
      {"octahedral 2x8", packed8, 0.335, 0.942},
      {"octahedral 2x10", [](const dvec3& n) { return octahedral(n, 10); }, 0.0836, 0.236},
      {"octahedral 2x12, packed in 24 bits", packed, 0.0209, 0.0589},
      {"octahedral 2x16", packed16, 0.0013, 0.0037},
  };
  constexpr int kCount = 2'000'000;
  std::mt19937_64 random(1);
  std::array<double, std::size(rows)> sum{}, worst{};
  for (int i = 0; i < kCount; ++i) {
    const dvec3 n = randomUnit(random);
    for (std::size_t k = 0; k < std::size(rows); ++k) {
      const double angle = angleBetween(n, rows[k].store(n)) * 180 / kPi;
      sum[k] += angle;
      worst[k] = std::fmax(worst[k], angle);
    }
  }
  for (std::size_t k = 0; k < std::size(rows); ++k) {
    const double mean = sum[k] / kCount;
    WARN(rows[k].layout << ": mean " << mean << " degrees, worst " << worst[k]);
    // The last row is given to two digits.
    const double digits = 0.00005;
    CHECK(std::abs(mean - rows[k].mean) <= 0.02 * rows[k].mean + digits * (k == 4));
    CHECK(std::abs(worst[k] - rows[k].worst) <= 0.02 * rows[k].worst + digits * (k == 4));
  }
}

TEST_CASE("mean square errors of normals go by the square of a code's step, as what is stored of alpha takes them") {
  constexpr int kCount = 500'000;
  std::mt19937_64 random(3);
  double sum[3] = {};
  for (int i = 0; i < kCount; ++i) {
    const dvec3 n = randomUnit(random), stored[3] = {packed8(n), packed(n), packed16(n)};
    for (int k = 0; k < 3; ++k) sum[k] += glm::dot(n - stored[k], n - stored[k]) / kCount;  // chord for angle: under 0.02 rad the same to 1e-4
  }
  const double twelve = 1.61e-7, variance[3] = {twelve * std::pow(2047.0 / 127, 2), twelve, twelve * std::pow(2047.0 / 32767, 2)};
  for (int k = 0; k < 3; ++k) {
    WARN("mean square error " << sum[k] << " rad^2; " << variance[k] << " by the step");
    CHECK(std::abs(sum[k] / variance[k] - 1) < 0.02);
    CHECK(shading::f64::storedAlphaBeside(0.1, variance[k]) == Approx(std::sqrt(0.01 - variance[k])));
  }
  CHECK(shading::f64::storedAlphaBeside(0.003, variance[0]) == Approx(4e-4));
}

TEST_CASE("the axes are stored exactly, in float and in double") {
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      dvec3 n(0);
      n[axis] = sign;
      CHECK((packed(n) == n && packed8(n) == n && packed16(n) == n));
      const glm::vec3 f(n);
      CHECK(shading::f32::unpackNormal(glm::round(shading::f32::packNormal(f) * 255.0f) / 255.0f) == f);
      CHECK(shading::f32::unpackNormal8(glm::round(shading::f32::packNormal8(f) * 255.0f) / 255.0f) == f);
      CHECK(shading::f32::unpackNormal16(glm::round(shading::f32::packNormal16(f) * 65535.0f) / 65535.0f) == f);
    }
}

TEST_CASE("packed normals in float are those in double but for ties") {
  std::mt19937_64 random(2);
  int differing = 0;
  double worst = 0;
  constexpr int kCount = 200'000;
  for (int i = 0; i < kCount; ++i) {
    const glm::vec3 n(randomUnit(random));
    const glm::vec3 f = glm::round(shading::f32::packNormal(n) * 255.0f);
    differing += f != glm::vec3(glm::round(shading::f64::packNormal(dvec3(n)) * 255.0));
    worst = std::fmax(
        worst, angleBetween(glm::normalize(dvec3(shading::f32::unpackNormal(f / 255.0f))), glm::normalize(dvec3(n))));
  }
  CHECK(differing < kCount / 500);
  CHECK(worst * 180 / kPi < 0.0589 * 1.02);
}

TEST_CASE("vectors that are no normals pack to finite unit vectors") {
  for (const glm::vec3 n :
       {glm::vec3(0), glm::vec3(1e-30f, 0, 0), glm::vec3(-1e18f, 1e18f, 1e18f), glm::vec3(0, 0, -1e-38f)}) {
    const glm::vec3 u = shading::f32::unpackNormal(shading::f32::packNormal(n));
    CHECK(glm::length(u) == Approx(1).margin(1e-6));
  }
  CHECK(shading::f32::unpackNormal(shading::f32::packNormal(glm::vec3(0))) == glm::vec3(0, 0, 1));
}
