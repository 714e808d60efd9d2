// The text of captured places (shaders/shading/probes.h): box projection against ray-box in double, in float and through GLSL; shares that sum to 1 and do not jump.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <random>

#include "gpu/shader_cases.h"
#include "interface/limits.h"
#include "reference/shading.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
using glm::vec3;
using glm::vec4;

namespace {

namespace f32 = shading::f32;
namespace f64 = shading::f64;
using Random = std::mt19937;

double uniform(Random& random, double lo, double hi) { return lo + (hi - lo) * (double(random()) + 0.5) * 0x1p-32; }
dvec3 randomUnit(Random& random) {
  const double z = uniform(random, -1, 1), phi = uniform(random, 0, 6.283185307179586), s = std::sqrt(1 - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}
dvec3 within(Random& random, const dvec3& extent) { return extent * dvec3(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)); }

/// Where the ray leaves the box, found without a division: by halving the way until inside and outside are a rounding apart. p inside or on the box.
dvec3 leaves(const dvec3& p, const dvec3& d, const dvec3& extent) {
  const auto outside = [&](double way) {
    const dvec3 q = glm::abs(p + d * way) - extent;
    return std::max({q.x, q.y, q.z}) > 0;
  };
  double in = 0, out = 4 * glm::length(extent) + 1;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (in + out);
    (outside(middle) ? out : in) = middle;
  }
  return p + d * in;
}

struct Ask {
  vec3 p, d, extent, capture;
};
/// Inside, in boxes of 1 cm to 1 km a side that need not be cubes.
Ask ordinary(Random& random) {
  const double size = std::exp2(uniform(random, -6, 9));
  const dvec3 extent = size * dvec3(std::exp2(uniform(random, -2, 0)), std::exp2(uniform(random, -2, 0)), std::exp2(uniform(random, -2, 0)));
  return {vec3(within(random, extent)), vec3(randomUnit(random)), vec3(extent), vec3(within(random, extent * 0.9))};
}
/// On faces, edges and corners with rays that lead inward, parallel to faces, along edges.
Ask degenerate(Random& random) {
  Ask a = ordinary(random);
  const int held = 1 + int(random() % 7);
  for (int k = 0; k < 3; ++k) {
    if (!(held & (1 << k))) continue;
    a.p[k] = random() & 1 ? a.extent[k] : -a.extent[k];
    a.d[k] = std::copysign(a.d[k], -a.p[k]);
  }
  const int parallel = int(random() % 8);
  vec3 d = a.d;
  for (int k = 0; k < 3; ++k)
    if (parallel & (1 << k)) d[k] = random() & 1 ? 0.0f : -0.0f;
  if (glm::dot(d, d) > 0.01f) a.d = glm::normalize(d);
  return a;
}

std::vector<Ask> asks() {
  Random random(6061);
  std::vector<Ask> all;
  for (int i = 0; i < 100'000; ++i) all.push_back(ordinary(random));
  for (int i = 0; i < 20'000; ++i) all.push_back(degenerate(random));
  return all;
}

double largest(const vec3& v) { return double(std::max({v.x, v.y, v.z})); }
/// Off by so much of the box's largest half size, with the direction from the capture taken to the same distance.
double errorOf(const Ask& a, const dvec3& truth, const dvec3& hit) { return glm::length(hit - truth) / largest(a.extent); }

}  // namespace

TEST_CASE("box projection meets the box where a ray does: float, double and GLSL", "[reflection]") {
  const std::vector<Ask> all = asks();
  std::vector<ShaderCase> cases;
  for (const Ask& a : all) cases.push_back({vec4(a.p, 0), vec4(a.d, 0), vec4(a.extent, 0), vec4(a.capture, 0)});
  GlFixture f;
  const std::vector<vec4> hits = onGpu(f, cases, "vec4(probeHit(a.xyz, b.xyz, c.xyz), 0.0)");
  const std::vector<vec4> directions = onGpu(f, cases, "vec4(probeDirection(probeHit(a.xyz, b.xyz, c.xyz), b.xyz, d.xyz), 0.0)");
  double inDouble = 0, inFloat = 0, inGlsl = 0, aimed = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Ask& a = all[i];
    // float's unit is a unit of double within 1e-7: what is compared is where the very ray leads.
    const dvec3 p = glm::clamp(dvec3(a.p), -dvec3(a.extent), dvec3(a.extent)), truth = leaves(p, dvec3(a.d), dvec3(a.extent));
    inDouble = std::max(inDouble, errorOf(a, truth, f64::probeHit(p, dvec3(a.d), dvec3(a.extent))));
    inFloat = std::max(inFloat, errorOf(a, truth, dvec3(f32::probeHit(a.p, a.d, a.extent))));
    inGlsl = std::max(inGlsl, errorOf(a, truth, dvec3(hits[i])));
    aimed = std::max(aimed, errorOf(a, truth, dvec3(a.capture) + dvec3(directions[i])));
  }
  std::cout << fmt::format("  box projection against ray-box, {} rays, share of the box's size: double {:.2g}, float {:.2g}, GLSL {:.2g}, re-aimed in GLSL {:.2g}\n", all.size(), inDouble, inFloat, inGlsl, aimed);
  for (const double error : {inDouble, inFloat, inGlsl, aimed}) CHECK(error < 1e-4);
}

TEST_CASE("box projection is finite and continuous from outside, on faces and in boxes without size", "[reflection]") {
  Random random(6062);
  double jump = 0;
  const auto finite = [](const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  for (int i = 0; i < 50'000; ++i) {
    const dvec3 extent(std::exp2(uniform(random, -1, 1)), std::exp2(uniform(random, -1, 1)), std::exp2(uniform(random, -1, 1)));
    // A point on a face and steps to either side of it, any ray: outward and within 1e-3 of the face's plane too.
    dvec3 p = within(random, extent), d = randomUnit(random);
    const int axis = int(random() % 3);
    p[axis] = random() & 1 ? extent[axis] : -extent[axis];
    if (random() & 1) d[axis] *= 1e-3;
    d = glm::normalize(d);
    dvec3 out(0);
    out[axis] = p[axis] > 0 ? 1 : -1;
    // A step of a ten-millionth of the box moves the hit by that over the cosine with the face, 1e3 at most; on the outside not at all.
    const double step = 1e-7;
    const dvec3 at = f64::probeHit(p, d, extent), inside = f64::probeHit(p - out * step, d, extent), outside = f64::probeHit(p + out * step, d, extent);
    REQUIRE((finite(at) && finite(inside) && finite(outside)));
    const double bound = 4 * step / std::max(std::abs(d[axis]), 1e-7);
    jump = std::max(jump, std::max(glm::length(inside - at), glm::length(outside - at)) / bound);
    CHECK(std::max({std::abs(at.x) - extent.x, std::abs(at.y) - extent.y, std::abs(at.z) - extent.z}) < 4e-6);
    // Edges, corners and far away: the nearest point of the box stands for it.
    const dvec3 far = extent * dvec3(uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -3, 3));
    CHECK(glm::length(f64::probeHit(far, d, extent) - f64::probeHit(glm::clamp(far, -extent, extent), d, extent)) == 0);
    // Boxes without a size along one, two or three axes.
    dvec3 flat = extent;
    for (int k = 0; k < 3; ++k)
      if (i >> k & 1) flat[k] = 0;
    const vec3 hit = f32::probeHit(vec3(p), vec3(d), vec3(flat)), to = f32::probeDirection(hit, vec3(d), vec3(0));
    CHECK((finite(dvec3(hit)) && finite(dvec3(to)) && glm::dot(to, to) > 0));
    if ((i & 7) == 7) CHECK(to == vec3(d));  // a point is as far away as the sky
    const float r = f32::probeRoughness(float(uniform(random, 0, 1)), vec3(p), hit, vec3(0));
    CHECK((r >= 0 && r <= 1));
  }
  CHECK(jump < 1);
}

// A ray in a face's own plane, from a point on the face: it turns from the wall ahead to the point itself within a millionth of a radian, without a jump.
TEST_CASE("box projection: rays turn through the plane of a face without a jump", "[reflection]") {
  const dvec3 extent(1, 2, 3), p(1, 0.3, -0.7);
  dvec3 before(0);
  double largestStep = 0;
  const int steps = 4000;
  for (int i = 0; i <= steps; ++i) {
    const double angle = 4e-6 * (2.0 * i / steps - 1);
    const dvec3 hit = f64::probeHit(p, {std::sin(angle), std::cos(angle), 0}, extent);
    if (i > 0) largestStep = std::max(largestStep, glm::length(hit - before));
    before = hit;
  }
  // The gap is extent/2^20: the hit's way is 1e-6 m over the sine, which changes fastest where it reaches the wall 1.7 m ahead: by 1.7² · 1e6 m a radian, over 2e-9 rad a step.
  CHECK(largestStep < 1.1 * (1.7 * 1.7 * 1048576) * 2e-9);
}

TEST_CASE("box projection at every roughness: the same reflected point", "[reflection]") {
  // The direction takes no roughness; what box-rough changes is the level, and it never gets rougher.
  Random random(6063);
  for (int i = 0; i < 20'000; ++i) {
    const Ask a = ordinary(random);
    const dvec3 hit = f64::probeHit(dvec3(a.p), dvec3(a.d), dvec3(a.extent));
    const double r = uniform(random, 0, 1), got = f64::probeRoughness(r, dvec3(a.p), hit, dvec3(a.capture)), toPoint = glm::length(hit - dvec3(a.p)), toCapture = glm::length(hit - dvec3(a.capture));
    CHECK(got <= r * (1 + 1e-12));
    // The listing, written down once more.
    const double listed = std::clamp(toPoint / toCapture * r, 0.0, r);
    CHECK(got == Approx(listed * (1 - r) + r * r).epsilon(1e-9));
  }
}

namespace {

struct Box {
  dvec3 center, extent, fade;
  double margin;
};
std::vector<Box> boxes(Random& random, int count) {
  std::vector<Box> all;
  for (int i = 0; i < count; ++i) {
    const dvec3 extent(uniform(random, 0.3, 2), uniform(random, 0.3, 2), uniform(random, 0.3, 2));
    all.push_back({within(random, dvec3(1.5)), extent, extent * uniform(random, 0.05, 1), uniform(random, 0.05, 1)});
  }
  std::sort(all.begin(), all.end(), [](const Box& a, const Box& b) { return a.extent.x * a.extent.y * a.extent.z < b.extent.x * b.extent.y * b.extent.z; });
  return all;
}
f64::ProbeBlend blendAt(const std::vector<Box>& all, const dvec3& p) {
  f64::ProbeBlend b = f64::beginBlend();
  for (std::size_t i = 0; i < all.size(); ++i) f64::addToBlend(b, int(i), p - all[i].center, all[i].extent, all[i].fade, all[i].margin);
  f64::endBlend(b);
  return b;
}
bool inside(const Box& b, const dvec3& p) {
  const dvec3 q = glm::abs(p - b.center) - b.extent;
  return std::max({q.x, q.y, q.z}) <= 0;
}

}  // namespace

TEST_CASE("shares of places and sky sum to 1, and the sky has none inside", "[reflection]") {
  static_assert(PROBES_BLENDED == MAX_TILE_PROBES);
  Random random(6064);
  int within1 = 0, outside = 0;
  for (int i = 0; i < 50'000; ++i) {
    const std::vector<Box> all = boxes(random, 1 + i % PROBES_BLENDED);
    const dvec3 p = within(random, dvec3(2.5));
    const f64::ProbeBlend b = blendAt(all, p);
    double sum = b.sky;
    for (int k = 0; k < PROBES_BLENDED; ++k) {
      const double w = b.weight[k];
      CHECK((w >= 0 && w <= 1 + 1e-12));
      sum += w;
    }
    CHECK(sum == Approx(1).epsilon(1e-12));
    const bool in = std::any_of(all.begin(), all.end(), [&](const Box& box) { return inside(box, p); });
    if (in) CHECK(b.sky == 0);
    for (std::size_t k = 0; k < all.size(); ++k)
      if (in && !inside(all[k], p)) CHECK(b.weight[k] == 0);
    (in ? within1 : outside) += 1;
    if (all.size() == 1 && in) CHECK(b.weight[0] == Approx(1));
  }
  CHECK((within1 > 5000 && outside > 5000));
}

// Along lines, in steps of 1e-4 m, through boxes that begin and end in a large one, whose influence is 1: shares are influences then, and change by at most 1/fade a metre along each axis.
TEST_CASE("shares do not jump across borders", "[reflection]") {
  Random random(6065);
  const double step = 1e-4;
  double largestStep = 0;
  std::size_t compared = 0;
  for (int line = 0; line < 400; ++line) {
    std::vector<Box> all = boxes(random, 3);
    all.push_back({dvec3(0), dvec3(40), dvec3(1), 1});
    const dvec3 from = within(random, dvec3(3.5)), d = randomUnit(random);
    f64::ProbeBlend before = blendAt(all, from);
    for (int i = 1; i < 20'000; ++i) {
      const f64::ProbeBlend b = blendAt(all, from + d * (step * i));
      for (int k = 0; k < PROBES_BLENDED; ++k) largestStep = std::max(largestStep, std::abs(b.weight[k] - before.weight[k]));
      before = b;
      ++compared;
    }
  }
  // fade >= 0.05 · 0.3 m along three axes, in up to three boxes one after the other; the least share on a face adds 2^-20.
  CHECK(largestStep < 3 * 3 * step / 0.015 + 1e-6);
  std::cout << fmt::format("  shares along lines of 2 m: largest change over 0.1 mm {:.2g}, {} steps\n", largestStep, compared);
}

TEST_CASE("a box on its own: all of it up to its faces, then less until the margin ends", "[reflection]") {
  const std::vector<Box> all{{dvec3(0), dvec3(1, 2, 3), dvec3(0.5), 0.25}};
  for (const double x : {0.0, 0.9, 0.999999, 1.0}) CHECK(blendAt(all, {x, 0, 0}).weight[0] == Approx(1).epsilon(1e-12));
  for (const double beyond : {1e-9, 1e-3, 0.1, 0.2, 0.249999, 0.25, 0.3, 1e6}) CHECK(blendAt(all, {1 + beyond, 0, 0}).weight[0] == Approx(std::max(1 - beyond / 0.25, 0.0)).margin(1e-9));
  // Off an edge and a corner the distance counts.
  CHECK(blendAt(all, {1.03, 2.04, 0}).weight[0] == Approx(1 - 0.05 / 0.25));
  CHECK(blendAt(all, {1.02, 2.01, 3.02}).sky == Approx(0.03 / 0.25));
  // No margin, no fade, no size.
  const std::vector<Box> hard{{dvec3(0), dvec3(1), dvec3(0), 0}}, point{{dvec3(0), dvec3(0), dvec3(0), 0.5}};
  CHECK(blendAt(hard, {1, 1, 1}).sky == 0);
  CHECK(blendAt(hard, {1 + 1e-9, 0, 0}).sky == 1);
  CHECK(blendAt(point, {0, 0, 0}).weight[0] == Approx(1));
  CHECK(blendAt(point, {0.25, 0, 0}).weight[0] == Approx(0.5));
}

TEST_CASE("smaller boxes come before larger ones", "[reflection]") {
  const std::vector<Box> all{{dvec3(0), dvec3(1), dvec3(0.5), 0.25}, {dvec3(0), dvec3(4), dvec3(1), 0.25}};
  CHECK(blendAt(all, {0, 0, 0}).weight[0] == Approx(1));
  CHECK(blendAt(all, {0.75, 0, 0}).weight[0] == Approx(0.5));  // half of its fade
  CHECK(blendAt(all, {0.75, 0, 0}).weight[1] == Approx(0.5));
  CHECK(blendAt(all, {1.01, 0, 0}).weight[1] == Approx(1));
  // Beside two boxes the nearer one has more; all in all as much as the nearer one alone would have.
  const std::vector<Box> beside{{dvec3(-2, 0, 0), dvec3(1), dvec3(0.5), 2}, {dvec3(2.5, 0, 0), dvec3(1), dvec3(0.5), 2}};
  const f64::ProbeBlend b = blendAt(beside, {0, 0, 0});
  CHECK(b.sky == Approx(0.5));                                   // 1 m from the first: coverage 0.5; 1.5 m from the second: 0.25
  CHECK(b.weight[0] / b.weight[1] == Approx(1.0 / (0.25 / 0.75)));
}
