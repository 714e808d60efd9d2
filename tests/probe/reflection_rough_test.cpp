// Which of the rungs infinite, box and box-rough is nearest to what a lobe really receives in a painted room: integrals in double, no cube between.
#include <fmt/format.h>

#include <iostream>
#include <random>

#include "probe/reflection_room.h"
#include "reference/shading.h"

using namespace burnish;
using namespace burnish::test;

namespace {

namespace f64 = shading::f64;
using Random = std::mt19937;
double uniform(Random& random, double lo, double hi) { return lo + (hi - lo) * (double(random()) + 0.5) * 0x1p-32; }

const dvec3 kHalf(3, 1.5, 3);

/// Walls of different greys, a bright window in one, a bright stripe along another, a dark door: edges of all sizes.
double paint(const dvec3& at, int axis, bool positive) {
  if (axis == 0 && positive && std::abs(at.z - 0.5) < 0.8 && std::abs(at.y - 0.2) < 0.6) return 8;
  if (axis == 2 && !positive && std::abs(at.y - 0.9) < 0.15) return 4;
  if (axis == 2 && positive && std::abs(at.x + 1) < 0.5 && at.y < 0.5) return 0.05;
  return axis == 1 ? (positive ? 1.2 : 0.4) : 0.6 + 0.2 * axis + (positive ? 0.3 : 0);
}

/// The mean over the lobe of roughness r about R of what `radiance` sees (docs/shading.md, section 5). l with n·l <= 0 count for nothing where n is given.
template <class F>
double lobeMean(double r, const dvec3& R, const dvec3* n, F&& radiance) {
  constexpr int kRings = 48, kColumns = 96;
  const double alpha = r * r, e = 0.5 * f64::powerFromAlpha(alpha) + 1, least = std::exp2(-e);
  dvec3 t, b;
  f64::basisFrom(R, t, b);
  double sum = 0, weights = 0;
  for (int i = 0; i < kRings; ++i) {
    const double x = std::pow(least + (1 - least) * (i + 0.5) / kRings, 1 / e), c = 2 * x - 1, s = std::sqrt(std::max(1 - c * c, 0.0));
    for (int j = 0; j < kColumns; ++j) {
      const double phi = 2 * kPi * (j + 0.5 * (i & 1)) / kColumns;
      const dvec3 l = R * c + t * (s * std::cos(phi)) + b * (s * std::sin(phi));
      if (n && glm::dot(*n, l) <= 0) continue;
      sum += c * radiance(l);
      weights += c;
    }
  }
  return sum / weights;
}
double seenFrom(const dvec3& p, const dvec3& l) {
  const WallHit hit = wallHit(p, l, kHalf);
  return paint(hit.at, hit.axis, hit.positive);
}

struct Errors3 {
  double infinite = 0, box = 0, rough = 0;
};

/// rms over points of the floor, the walls and inside, of the difference to the truth, over the truth's mean.
Errors3 measure(double r, const dvec3& capture, int count) {
  Random random(977);
  Errors3 e;
  double mean = 0;
  for (int i = 0; i < count; ++i) {
    dvec3 p(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)), n(0), v;
    p *= kHalf * 0.98;
    const int axis = i % 2 ? 1 : int(random() % 3);  // every other one on the floor or the ceiling
    p[axis] = p[axis] > 0 ? kHalf[axis] : -kHalf[axis];
    n[axis] = p[axis] > 0 ? -1 : 1;
    do v = glm::normalize(dvec3(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)));
    while (glm::dot(n, v) < 0.15);
    const dvec3 R = n * (2 * glm::dot(n, v)) - v, q = p + n * 1e-9;
    const double truth = lobeMean(r, R, &n, [&](const dvec3& l) { return seenFrom(q, l); });
    const dvec3 hit = f64::probeHit(p, R, kHalf), to = glm::normalize(f64::probeDirection(hit, R, capture));
    const auto captured = [&](const dvec3& d, double roughness) { return lobeMean(roughness, d, nullptr, [&](const dvec3& l) { return seenFrom(capture, l); }); };
    const auto square = [&](double x) { return (x - truth) * (x - truth) / count; };
    e.infinite += square(captured(R, r));
    e.box += square(captured(to, r));
    e.rough += square(captured(to, f64::probeRoughness(r, p, hit, capture)));
    mean += truth / count;
  }
  return {std::sqrt(e.infinite) / mean, std::sqrt(e.box) / mean, std::sqrt(e.rough) / mean};
}

}  // namespace

TEST_CASE("how near the rungs of reflection are to what a lobe receives in a painted room", "[reflection]") {
  double box = 0, rough = 0, infinite = 0;
  for (const dvec3& capture : {dvec3(0), dvec3(1.2, -0.5, -0.8)})
    for (const double r : {0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0}) {
      const Errors3 e = measure(r, capture, 400);
      std::cout << fmt::format("  captured from {}, roughness {:<4}: rms error infinite {:5.1f} %, box {:5.1f} %, box-rough {:5.1f} %\n", capture == dvec3(0) ? "the middle" : "beside it", r, 100 * e.infinite, 100 * e.box, 100 * e.rough);
      box += e.box;
      rough += e.rough;
      infinite += e.infinite;
      // A mirror's reflection in a room of boxes is the box projection's; the room's light is not infinitely far away at any roughness at which there is a reflection.
      if (r <= 0.1) CHECK(e.box < 0.1 * e.infinite);
      if (r <= 0.6) CHECK(e.box < e.infinite);
    }
  // What the presets rest on: box-rough is the nearest on the mean, by little.
  CHECK(rough < box);
  CHECK(box < 1.1 * rough);
  CHECK(box < 0.4 * infinite);
  std::cout << fmt::format("  mean over all of them: infinite {:.1f} %, box {:.1f} %, box-rough {:.1f} %\n", 100 * infinite / 16, 100 * box / 16, 100 * rough / 16);
}
