#include "probe/rooms_space.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "prefilter/parallel.h"
#include "probe/visibility.h"
#include "reference/shading.h"

namespace burnish::probe {
namespace {

using reference::Hit;
using reference::Ray;

constexpr std::uint32_t kWalls = kOpaque | kTransparent;
constexpr int kSightSize = 5;  // an octahedral map of so many texels a side: directions in which a cell looks around

/// Marks what geometry keeps apart along one axis, and how far up the highest and how far down the lowest surface of each column is.
class Lines {
 public:
  Lines(const Geometry& geometry, Space& space) : geometry_(geometry), space_(space) {}

  void run(int axis, int threads) {
    const glm::ivec3 n = space_.cells.counts;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    // A row of lines writes cells of its own.
    prefilter::forEachPiece(n[v], threads, [&](int j) {
      std::vector<Hit> hits;
      for (int i = 0; i < n[u]; ++i) {
        glm::ivec3 start(0);
        start[u] = i;
        start[v] = j;
        line(axis, start, hits);
      }
    });
  }

 private:
  void line(int axis, glm::ivec3 start, std::vector<Hit>& hits) const {
    const CellBox& cells = space_.cells;
    const int last = cells.counts[axis] - 1;
    geometry_.rays.all({cells.world(start), cells.axes[axis], 0, last * cells.cell, kWalls}, hits);
    for (const Hit& hit : hits) {
      const double place = hit.distance / cells.cell;
      // On a middle it is between that one and both neighbours.
      for (const double at : {place - 1e-6, place + 1e-6}) {
        const int k = int(std::floor(at));
        if (k < 0 || k >= last) continue;
        start[axis] = k;
        space_.blocked[cells.index(start)] |= std::uint8_t(1 << axis);
      }
    }
  }
  const Geometry& geometry_;
  Space& space_;
};

/// Nothing above or nothing below: it is no room, and need not look around.
bool roofed(const Geometry& geometry, glm::dvec3 point) {
  return geometry.rays.occluded(Ray{point, {0, 1, 0}, 0, std::numeric_limits<double>::infinity(), kWalls}) &&
         geometry.rays.occluded(Ray{point, {0, -1, 0}, 0, std::numeric_limits<double>::infinity(), kWalls});
}

}  // namespace

bool Sight::inRoom() const { return backs <= fronts && double(sky) <= kMostSky * (sky + fronts + backs + others); }

Sight lookFrom(const Geometry& geometry, glm::dvec3 point, WallAngles& walls) {
  Sight s;
  WallAngles seen;
  for (int i = 0; i < kSightSize * kSightSize; ++i) {
    const Ray ray{point, shading::f64::distanceDirection(i % kSightSize + 0.5, double(i / kSightSize) + 0.5, kSightSize), 0, std::numeric_limits<double>::infinity(), kWalls};  // NOLINT(bugprone-integer-division)
    const Hit hit = geometry.rays.nearest(ray);
    if (!hit) {
      ++s.sky;
      continue;
    }
    const Side side = sideOf(geometry, ray, hit);
    ++(side == Side::Front ? s.fronts : side == Side::Back ? s.backs : s.others);
    seen.add(hit.normal);
  }
  if (s.inRoom()) walls.add(seen);
  return s;
}

CellBox cellsOver(const glm::dmat3& axes, glm::dvec3 low, glm::dvec3 high, double least, double most) {
  CellBox box;
  box.axes = axes;
  const glm::dvec3 extent = glm::max(high - low, glm::dvec3(least));
  box.cell = std::max(least, std::cbrt(extent.x * extent.y * extent.z / most));
  // Flat extents: a layer of cells is as thin as it gets.
  for (;; box.cell *= 1.05) {
    const glm::dvec3 n = glm::ceil(extent / box.cell) + 2.0;
    if (n.x * n.y * n.z > std::max(1.5 * most, 64.0)) continue;
    box.counts = glm::ivec3(n);
    // Off the round numbers on which walls stand, so that few of them go through cells' middles.
    box.low = (low + high) * 0.5 - glm::dvec3(box.counts) * (0.5 * box.cell) + box.cell * glm::dvec3(0.0531, 0.0373, 0.0617);
    return box;
  }
}

void WallAngles::add(glm::dvec3 n) {
  if (std::abs(n.y) > 0.2) return;
  const double four = 4 * std::atan2(-n.z, n.x);  // a turn about +Y takes x towards -z
  const double turn = four / (2 * std::numbers::pi);
  Bin& bin = bins_[std::size_t(std::min(kBins - 1, int((turn - std::floor(turn)) * kBins)))];
  bin.count += 1;
  bin.sine += std::sin(four);
  bin.cosine += std::cos(four);
}

void WallAngles::add(const WallAngles& other) {
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    bins_[i].count += other.bins_[i].count;
    bins_[i].sine += other.bins_[i].sine;
    bins_[i].cosine += other.bins_[i].cosine;
  }
}

double WallAngles::most() const {
  const auto around = [&](int i, int step) { return bins_[std::size_t((i + step + kBins) % kBins)]; };
  int best = 0;
  double most = 0;
  for (int i = 0; i < kBins; ++i)
    if (const double n = around(i, -1).count + around(i, 0).count + around(i, 1).count; n > most) most = n, best = i;
  double sine = 0, cosine = 0;
  for (int step = -1; step <= 1; ++step) sine += around(best, step).sine, cosine += around(best, step).cosine;
  return most > 0 ? std::atan2(sine, cosine) / 4 : 0;
}

double WallAngles::share(double angle) const {
  double all = 0, near = 0;
  for (const Bin& b : bins_) all += b.count;
  const double turn = 4 * angle / (2 * std::numbers::pi);
  const int middle = int((turn - std::floor(turn)) * kBins);
  for (int step = -2; step <= 2; ++step) near += bins_[std::size_t((middle + step + kBins) % kBins)].count;
  return all > 0 ? near / all : 0;
}

void Space::clear() {
  const glm::ivec3 n = cells.counts;
  std::vector<int> steps(cells.size());
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) {
        const glm::ivec3 c(x, y, z);
        bool edge = false;
        for (int axis = 0; axis < 3 && !edge; ++axis) edge = !open(c, axis, 1) || !open(c, axis, -1);
        steps[cells.index(c)] = !in(c) ? 0 : edge ? 1 : 1 << 20;
      }
  // Distances along the farthest axis, in two sweeps over all neighbours that come before (Rosenfeld and Pfaltz 1966, "Sequential Operations in Digital Picture Processing").
  const auto sweep = [&](int dir) {
    for (int z = dir > 0 ? 0 : n.z - 1; z >= 0 && z < n.z; z += dir)
      for (int y = dir > 0 ? 0 : n.y - 1; y >= 0 && y < n.y; y += dir)
        for (int x = dir > 0 ? 0 : n.x - 1; x >= 0 && x < n.x; x += dir) {
          int& own = steps[cells.index({x, y, z})];
          for (int k = 0; own > 1 && k < 13; ++k) {
            const glm::ivec3 other(x - dir * (k < 9 ? k % 3 - 1 : k < 12 ? k - 10 : 1), y - dir * (k < 9 ? k / 3 - 1 : k < 12 ? 1 : 0), z - dir * (k < 9 ? 1 : 0));
            own = std::min(own, (cells.has(other) ? steps[cells.index(other)] : 0) + 1);
          }
        }
  };
  sweep(1);
  sweep(-1);
  clearance.resize(cells.size());
  for (std::size_t i = 0; i < steps.size(); ++i) clearance[i] = float((steps[i] - 0.5) * cells.cell);
}

Space spaceOf(const Geometry& geometry, const CellBox& cells, int wanted, const std::function<void(double)>& progress) {
  const int threads = prefilter::threadsFor(wanted);
  Space space;
  space.cells = cells;
  space.inside.assign(cells.size(), 0);
  space.blocked.assign(cells.size(), 0);
  for (int axis = 0; axis < 3; ++axis) Lines(geometry, space).run(axis, threads);
  // Slice by slice, so that the sums of angles do not depend on the threads.
  const int slices = cells.counts.z;
  std::vector<WallAngles> angles(static_cast<std::size_t>(slices));
  constexpr int kBatch = 8;
  for (int first = 0; first < slices; first += kBatch) {
    if (progress) progress(double(first) / slices);
    prefilter::forEachPiece(std::min(kBatch, slices - first), threads, [&](int piece) {
      const int z = first + piece;
      for (int y = 0; y < cells.counts.y; ++y)
        for (int x = 0; x < cells.counts.x; ++x) {
          const glm::dvec3 point = cells.world({x, y, z});
          if (roofed(geometry, point) && lookFrom(geometry, point, angles[std::size_t(z)]).inRoom()) space.inside[cells.index({x, y, z})] = 1;
        }
    });
  }
  for (const WallAngles& a : angles) space.walls.add(a);
  if (progress) progress(1);
  return space;
}

}  // namespace burnish::probe
