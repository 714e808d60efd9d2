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

}  // namespace

std::vector<dvec4> planesOf(const AmbientGrid::Point& point, double limit) {
  static const Map map = directions();
  std::vector<dvec2> near(std::size_t(kSize * kSize), dvec2(1 / limit, 0));
  if (point.distances.size() == near.size())
    for (std::size_t i = 0; i < near.size(); ++i) near[i] = nearness(point.distances[i], limit);
  std::vector<dvec4> planes;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const std::size_t c = texelAt(x, y);
      // One-sided fits: of the four blocks of 2 x 2 texels with this one, the one that lies on a plane best, so that edges between walls stay sharp.
      dvec3 best = map[c].mean * (near[c].x / dot(map[c].mean, map[c].mean));
      double misfit = 1e300;
      for (int k = 0; k < 4; ++k) {
        const int dx = k % 2 ? 1 : -1, dy = k / 2 ? 1 : -1;
        const std::size_t h = texelAt(x + dx, y), v = texelAt(x, y + dy), d = texelAt(x + dx, y + dy);
        const glm::dmat3 rows = glm::transpose(glm::dmat3(map[c].mean, map[h].mean, map[v].mean));
        if (std::abs(determinant(rows)) < 1e-6) continue;
        const dvec3 g = inverse(rows) * dvec3(near[c].x, near[h].x, near[v].x);
        const double off = std::abs(dot(g, map[d].mean) / near[d].x - 1);
        if (off < misfit) misfit = off, best = g;
      }
      double mean = 0, square = 0;
      for (const dvec3& u : map[c].all) {
        const double n = dot(best, u) / near[c].x;
        mean += n / (kSide * kSide), square += n * n / (kSide * kSide);
      }
      const double rest = std::max(near[c].y - (square - mean * mean), 0.0);
      planes.emplace_back(best, 1 / (kSharp + 0.25 * std::min(misfit, 1.0) + 0.25 * std::sqrt(rest)));
    }
  return planes;
}

}  // namespace burnish::gpu_scene
