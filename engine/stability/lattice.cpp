#include "stability/lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gpu_scene/grid_planes.h"
#include "reference/shading.h"

namespace burnish::stability {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
namespace f64 = shading::f64;

GridSampler::GridSampler(const AmbientGrid& grid, int rung) : grid_(grid), rung_(rung) {
  for (const AmbientGrid::Point& p : grid.points) planes_.push_back(gpu_scene::planesOf(p, f64::distanceLimit(grid.spacing)));
}

GridLight GridSampler::at(const dvec3& p, const dvec3& n) const {
  const dvec3 last = dvec3(grid_.counts - 1), q = glm::transpose(grid_.axes) * (p - grid_.origin) / grid_.spacing;
  const double least = std::min({grid_.spacing.x, grid_.spacing.y, grid_.spacing.z});
  const f64::GridCell cell = f64::gridCell(q, last, grid_.spacing / std::max(grid_.margin, 1e-30));
  dvec3 light(0);
  double sum = 0;
  // Points before the surface's plane; where they know next to nothing, the others take over.
  for (const bool front : {true, false}) {
    const double left = front ? 1 : 1 - f64::gridTrust(sum);
    if (!(left > 0)) break;
    for (int i = 0; i < 8; ++i) {
      const dvec3 side(i & 1, (i >> 1) & 1, i >> 2);
      const glm::ivec3 at = glm::min(glm::ivec3(cell.first + side), grid_.counts - 1);
      const std::size_t index = std::size_t((at.z * grid_.counts.y + at.y) * grid_.counts.x + at.x);
      const dvec3 away = p - grid_.position(at);
      const double before = f64::gridInFront(-dot(away, n), 1 / f64::gridDepth(least));
      double w = f64::gridShare(cell, side) * (front ? before : (1 - before) * left);
      if (!grid_.points[index].valid || !(w > 0)) continue;
      const dvec3 seen = away + grid_.axes * (cell.pull * grid_.spacing);
      w *= sees(index, seen + n * f64::gridAim(least), seen + n * f64::gridBias(least));
      const auto& c = grid_.points[index].irradiance;
      light += w * f64::irradianceSh(n, c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], rung_);
      sum += w;
    }
  }
  if (!(sum > 0)) return {};
  return {glm::max(light / sum, dvec3(0)), cell.weight * f64::gridTrust(sum)};
}

double GridSampler::sees(std::size_t point, const dvec3& aim, const dvec3& away) const {
  constexpr int kSize = AmbientGrid::kDistanceSize;
  const dvec2 t = f64::distanceTexel(aim, kSize) - 0.5;
  const glm::ivec2 low(glm::floor(t));
  double before[4];
  for (int k = 0; k < 4; ++k) {
    int x = low.x + k % 2, y = low.y + k / 2;
    if (x < 0 || x >= kSize) x = x < 0 ? 0 : kSize - 1, y = kSize - 1 - y;
    if (y < 0 || y >= kSize) y = y < 0 ? 0 : kSize - 1, x = kSize - 1 - x;
    before[k] = f64::gridBefore(planes_[point][std::size_t(y * kSize + x)], away);
  }
  return f64::gridSees(before[0], before[1], before[2], before[3], t - dvec2(low));
}

double distanceTo(const std::vector<Solid>& solids, const dvec3& from, const dvec3& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Solid& s : solids) {
    double enter = 0, leave = nearest;
    for (int a = 0; a < 3; ++a) {
      if (direction[a] == 0) {
        if (from[a] < s.min[a] || from[a] > s.max[a]) leave = -1;
        continue;
      }
      const double u = (s.min[a] - from[a]) / direction[a], v = (s.max[a] - from[a]) / direction[a];
      enter = std::max(enter, std::min(u, v));
      leave = std::min(leave, std::max(u, v));
    }
    if (enter <= leave) nearest = std::min(nearest, enter);
  }
  return nearest;
}

void fillGrid(AmbientGrid& grid, const std::vector<Solid>& solids, const std::function<std::array<dvec3, 9>(const dvec3&)>& light, const glm::dmat3& frame) {
  constexpr int kSize = AmbientGrid::kDistanceSize, kSide = 6;
  const double limit = f64::distanceLimit(grid.spacing);
  grid.points.clear();
  for (int z = 0; z < grid.counts.z; ++z)
    for (int y = 0; y < grid.counts.y; ++y)
      for (int x = 0; x < grid.counts.x; ++x) {
        AmbientGrid::Point point;
        const dvec3 p = grid.position({x, y, z}), here = transpose(frame) * p;
        point.valid = std::none_of(solids.begin(), solids.end(), [&](const Solid& s) { return all(greaterThanEqual(here, s.min)) && all(lessThanEqual(here, s.max)); });
        for (int t = 0; point.valid && t < kSize * kSize; ++t) {
          double mean = 0, square = 0;
          for (int k = 0; k < kSide * kSide; ++k) {
            const dvec3 d = f64::distanceDirection(t % kSize + (k % kSide + 0.5) / kSide, t / kSize + (k / kSide + 0.5) / kSide, kSize);  // NOLINT(bugprone-integer-division)
            const double far = std::min(distanceTo(solids, here, transpose(frame) * d), limit);
            mean += far / (kSide * kSide);
            square += far * far / (kSide * kSide);
          }
          point.distances.emplace_back(mean, square);
        }
        if (point.valid) {
          const auto sh = light(p);
          for (std::size_t k = 0; k < 9; ++k) point.irradiance[k] = sh[k];
        }
        grid.points.push_back(std::move(point));
      }
}

std::vector<Solid> roomOf(const dvec3& min, const dvec3& max, double thickness) {
  std::vector<Solid> walls;
  for (int a = 0; a < 3; ++a)
    for (int side = 0; side < 2; ++side) {
      Solid s{min - thickness, max + thickness};
      (side ? s.min : s.max)[a] = side ? max[a] : min[a];
      walls.push_back(s);
    }
  return walls;
}

AmbientGrid gridIn(const dvec3& min, const dvec3& max, glm::ivec3 n, double inset) {
  AmbientGrid grid;
  grid.origin = min + inset;
  grid.counts = n;
  grid.spacing = (max - min - 2 * inset) / glm::max(dvec3(n - 1), dvec3(1));
  return grid;
}

}  // namespace burnish::stability
