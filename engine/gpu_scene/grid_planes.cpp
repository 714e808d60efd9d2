#include "gpu_scene/grid_planes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/shading.h"

namespace burnish::gpu_scene {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
constexpr int kSize = AmbientGrid::kDistanceSize;
constexpr int kSide = 4;  ///< directions along a side of a texel that stand for all of them

/// Depth behind a plane, over its distance, where light ends: rounding of half floats, and what means over a texel leave of the curve of 1/cos.
constexpr double kSharp = 0.01;
/// And as much more for each unit by which a texel's plane is off: what is cluttered hides nothing for sure. (At 14 light of the next room shows in corners: tests/probe/grid_leak_test.)
constexpr double kUnsure = 8;
/// A texel whose plane is off by more than this, as a share of its nearness, takes a neighbour's that is off by so much less.
constexpr double kMixed = 0.5, kBetter = 0.3;

struct Directions {
  std::array<dvec3, kSide * kSide> all;
  dvec3 mean{0};
};
using Map = std::array<Directions, kSize * kSize>;

Map directions() {
  Map map;
  for (int i = 0; i < kSize * kSize; ++i) {
    Directions& d = map[std::size_t(i)];
    for (int k = 0; k < kSide * kSide; ++k) {
      d.all[std::size_t(k)] = shading::f64::distanceDirection(i % kSize + (k % kSide + 0.5) / kSide, i / kSize + (k / kSide + 0.5) / kSide, kSize);  // NOLINT(bugprone-integer-division)
      d.mean += d.all[std::size_t(k)] / double(kSide * kSide);
    }
  }
  return map;
}

/// Neighbours across the square's border lie mirrored on it.
std::size_t texelAt(int x, int y) {
  if (x < 0 || x >= kSize) {
    x = x < 0 ? 0 : kSize - 1;
    y = kSize - 1 - y;
  }
  if (y < 0 || y >= kSize) {
    y = y < 0 ? 0 : kSize - 1;
    x = kSize - 1 - x;
  }
  return std::size_t(y * kSize + x);
}

/// Mean of 1/distance over a texel, and the relative variance, from mean and mean square of distance: E[1/d] = (1 + var/m²)/m but for third moments.
dvec2 nearness(const glm::vec2& distance, double limit) {
  const double m = std::isfinite(distance.x) && distance.x > 0 ? std::min(double(distance.x), limit) : limit;
  const double v = std::isfinite(distance.y) ? std::clamp(distance.y / (m * m) - 1, 0.0, 1.0) : 0;
  return {(1 + v) / m, v};
}

/// A plane through texel c and how far it is from what the texels say (0: they lie on it).
struct Fit {
  dvec3 plane{0};
  double off = 0;
};

// One-sided: of the four blocks of 2 x 2 texels with this one, the one that lies on a plane best, so that edges between walls stay sharp.
Fit fitOf(const Map& map, const std::vector<dvec2>& near, int x, int y) {
  const std::size_t c = texelAt(x, y);
  Fit fit{map[c].mean * (near[c].x / dot(map[c].mean, map[c].mean)), 1};
  for (int k = 0; k < 4; ++k) {
    const int dx = k % 2 ? 1 : -1, dy = k / 2 ? 1 : -1;
    const std::size_t h = texelAt(x + dx, y), v = texelAt(x, y + dy), d = texelAt(x + dx, y + dy);
    const glm::dmat3 rows = glm::transpose(glm::dmat3(map[c].mean, map[h].mean, map[v].mean));
    if (std::abs(determinant(rows)) < 1e-6) continue;
    const dvec3 g = inverse(rows) * dvec3(near[c].x, near[h].x, near[v].x);
    const double off = std::abs(dot(g, map[d].mean) / near[d].x - 1);
    if (off < fit.off) fit = {g, off};
  }
  // And what its own directions vary by beyond that plane.
  double mean = 0, square = 0;
  for (const dvec3& u : map[c].all) {
    const double n = dot(fit.plane, u) / near[c].x;
    mean += n / (kSide * kSide), square += n * n / (kSide * kSide);
  }
  fit.off += std::sqrt(std::max(near[c].y - (square - mean * mean), 0.0));
  return fit;
}

}  // namespace

std::vector<dvec4> planesOf(const AmbientGrid::Point& point, double limit) {
  if (!point.valid) return std::vector<dvec4>(std::size_t(kSize * kSize), dvec4(0, 0, 0, -1));
  static const Map map = directions();
  std::vector<dvec2> near(std::size_t(kSize * kSize), dvec2(1 / limit, 0));
  if (point.distances.size() == near.size())
    for (std::size_t i = 0; i < near.size(); ++i) near[i] = nearness(point.distances[i], limit);
  std::vector<Fit> fits;
  for (int i = 0; i < kSize * kSize; ++i) fits.push_back(fitOf(map, near, i % kSize, i / kSize));
  std::vector<dvec4> planes;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      // A texel across an edge shows a mixture of two walls: it takes the plane of the neighbour that knows its own best.
      const Fit* best = &fits[texelAt(x, y)];
      const double own = best->off;
      for (int k = 0; k < 9; ++k) {
        const Fit& other = fits[texelAt(x + k % 3 - 1, y + k / 3 - 1)];
        if (other.off < best->off && own > kMixed && other.off < kBetter * own) best = &other;
      }
      planes.emplace_back(best->plane, 1 / (kSharp + kUnsure * std::min(best->off, 2.0)));
    }
  return planes;
}

}  // namespace burnish::gpu_scene
