// Shadow maps' text: faces of a cube against its axes, the filter against nine bilinear lookups, soft edges against the geometry of a disc behind an edge.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "reference/shading.h"

namespace f64 = burnish::shading::f64;
namespace f32 = burnish::shading::f32;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

namespace {

/// Right, up and axis of a face, as engine/scene/shadows.cpp has them.
struct Face {
  dvec3 right{0}, up{0}, axis{0};
  explicit Face(int face) {
    const int a = face / 2;
    right[(a + 1) % 3] = up[(a + 2) % 3] = 1;
    axis[a] = face % 2 ? -1 : 1;
  }
};

}  // namespace

TEST_CASE("cube faces: every direction falls on the face whose axis is nearest, where its axes say") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  int seen[6] = {};
  for (int i = 0; i < 20000; ++i) {
    const dvec3 d(normal(random), normal(random), normal(random)), v(normal(random), normal(random), normal(random));
    const dvec4 f = f64::cubeFace(d);
    const int face = int(f.w);
    REQUIRE(face >= 0);
    REQUIRE(face < 6);
    ++seen[face];
    const Face axes(face);
    const double along = glm::dot(axes.axis, d);
    for (int other = 0; other < 6; ++other) REQUIRE(along >= glm::dot(Face(other).axis, d));
    REQUIRE(f.z == Approx(along));
    REQUIRE(f.x == Approx(glm::dot(axes.right, d) / along));
    REQUIRE(f.y == Approx(glm::dot(axes.up, d) / along));
    const dvec3 turned = f64::onCubeFace(v, f.w);
    REQUIRE(glm::length(turned - dvec3(glm::dot(axes.right, v), glm::dot(axes.up, v), glm::dot(axes.axis, v))) < 1e-15);
  }
  for (const int count : seen) CHECK(count > 2500);
  // The light itself, corners and edges: finite, on the face.
  for (const dvec3 d : {dvec3(0), dvec3(1), dvec3(-1), dvec3(0, 1, 1), dvec3(1e-30, 0, 0), dvec3(1e18, -1e18, 0)}) {
    const glm::vec4 f = f32::cubeFace(glm::vec3(d));
    CHECK((std::abs(f.x) <= 1 && std::abs(f.y) <= 1 && std::isfinite(f.z) && f.w >= 0 && f.w <= 5));
  }
}

TEST_CASE("the 3 x 3 filter is nine bilinear lookups") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 1000; ++i) {
    double t[4][4];
    for (auto& row : t)
      for (double& v : row) v = i == 0 ? 1 : unit(random);
    const dvec2 f(unit(random), unit(random));
    double sum = 0;
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x) sum += glm::mix(glm::mix(t[y][x], t[y][x + 1], f.x), glm::mix(t[y + 1][x], t[y + 1][x + 1], f.x), f.y) / 9;
    // As textureGather orders them.
    const auto gather = [&](int x, int y) { return dvec4(t[y + 1][x], t[y + 1][x + 1], t[y][x + 1], t[y][x]); };
    REQUIRE(f64::shadowFiltered(gather(0, 0), gather(2, 0), gather(0, 2), gather(2, 2), f) == Approx(sum).epsilon(1e-12));
    if (i == 0) REQUIRE(sum == Approx(1));
  }
}

TEST_CASE("the disc's points cover it evenly") {
  for (const int n : {16, 32}) {
    dvec2 mean(0);
    double xx = 0, yy = 0, xy = 0, nearest = 10;
    for (int i = 0; i < n; ++i) {
      const dvec2 p = f64::vogelDisc(i, n);
      CHECK(glm::length(p) < 1);
      mean += p / double(n);
      xx += p.x * p.x / n;
      yy += p.y * p.y / n;
      xy += p.x * p.y / n;
      for (int k = 0; k < i; ++k) nearest = std::min(nearest, glm::length(p - f64::vogelDisc(k, n)));
    }
    // Of a uniform disc: mean 0, second moments 1/4; points a hexagonal lattice's spacing apart at best, sqrt(2 pi/(sqrt(3) n)).
    CHECK(glm::length(mean) < 0.05);
    CHECK(std::abs(xx - 0.25) < 0.5 / n);  // half of one point at the rim
    CHECK(std::abs(yy - 0.25) < 0.5 / n);
    CHECK(std::abs(xy) < 0.02);
    CHECK(nearest > 0.55 * std::sqrt(2 * M_PI / (std::sqrt(3.0) * n)));
  }
}

TEST_CASE("soft edges: a disc of light past an edge, in texels of the map") {
  const double near = 0.01, far = 20, a = near * far / (far - near), b = near / (far - near), tangent = 0.8, texels = 1024;
  for (const double radius : {0.01, 0.1, 0.5})
    for (const double w : {0.5, 3.0, 15.0})
      for (const double share : {0.05, 0.5, 0.9, 1.0, 1.2}) {
        const double blocker = w * share;
        CHECK(f64::shadowDepth(near, a, b) == Approx(1));
        CHECK(f64::shadowDepth(far, a, b) == Approx(0).margin(1e-12));
        // Rays from the light's rim through the edge meet the receiver's plane radius (w - b)/b beside the ray from the middle; a texel is 2 tangent w / texels wide there.
        const double wanted = share < 1 ? radius * (w - blocker) / blocker / (2 * tangent * w / texels) : 0;
        const double perDepth = radius / a / (2 * tangent / texels);
        CHECK(f64::shadowBlur(f64::shadowDepth(blocker, a, b), f64::shadowDepth(w, a, b), perDepth) == Approx(wanted).epsilon(1e-9).margin(1e-9));
      }
}
