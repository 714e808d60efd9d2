#include "probe/rooms_grow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace burnish::probe {
namespace {

// What is a wall, seen from inside a box: shares of the layer that are closed.
constexpr double kClosed = 0.6;     // so much of it anyhow
constexpr double kFrameTop = 0.3;   // or so much of its upper part: the wall over a door
constexpr double kFrame = 0.2;      //    and so much of it all: less is a beam
constexpr double kUpper = 0.15;     // share of the height that is the upper part
constexpr int kSeeds = 1000;

bool isWall(const Closure& c, int axis) { return c.total >= kClosed || (axis != 1 && c.top >= kFrameTop && c.total >= kFrame); }

int& face(CellRange& box, int axis, int step) { return step > 0 ? box.high[axis] : box.low[axis]; }

/// Grows one box from the cube around a seed.
class Grower {
 public:
  Grower(const Space& space, glm::ivec3 seed) : space_(space), seed_(seed) {
    const int half = std::max(0, int(space.clearance[space.cells.index(seed)] / space.cells.cell - 0.5));
    box_ = {seed - half, seed + half};
  }

  CellRange run() {
    do {
      while (growUpright()) {}
    } while (growAside());
    cut();
    return box_;
  }

 private:
  [[nodiscard]] Closure beyond(int axis, int step) const { return closureOf(space_, box_, axis, step, step > 0 ? box_.high[axis] : box_.low[axis]); }

  bool growUpright() {
    bool grown = false;
    for (const int step : {1, -1})
      if (!isWall(beyond(1, step), 1)) {
        face(box_, 1, step) += step;
        grown = true;
      }
    return grown;
  }

  /// The side with the least that stands in its way goes first, and among equals the one that is nearest to the seed: the box reaches the walls beside a door before it could pass through it.
  bool growAside() {
    int bestAxis = -1, bestStep = 0;
    std::pair<double, int> best{std::numeric_limits<double>::infinity(), 0};
    for (const int axis : {0, 2})
      for (const int step : {1, -1}) {
        const Closure c = beyond(axis, step);
        if (isWall(c, axis)) continue;
        const std::pair<double, int> rank{std::round(c.top * 50) / 50, std::abs(face(box_, axis, step) - seed_[axis])};
        if (rank < best) best = rank, bestAxis = axis, bestStep = step;
      }
    if (bestAxis < 0) return false;
    face(box_, bestAxis, bestStep) += bestStep;
    return true;
  }

  /// A wall that only shows now that the box has its full size: a door as wide as the box was when it went through.
  void cut() {
    for (const int axis : {0, 2})
      for (const int step : {1, -1})
        for (int layer = seed_[axis]; layer != face(box_, axis, step); layer += step)
          if (isWall(closureOf(space_, box_, axis, step, layer), axis)) {
            face(box_, axis, step) = layer;
            break;
          }
  }

  const Space& space_;
  glm::ivec3 seed_;
  CellRange box_;
};

/// The free cell with the largest clearance among those that are left; among equals the one in the middle of their order.
std::optional<glm::ivec3> seedOf(const Space& space, const std::vector<std::uint8_t>& left, double least) {
  std::vector<std::size_t> best;
  float most = float(least);
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!left[i] || space.clearance[i] < most) continue;
    if (space.clearance[i] > most) best.clear();
    most = space.clearance[i];
    best.push_back(i);
  }
  if (best.empty()) return {};
  const std::size_t i = best[best.size() / 2], nx = std::size_t(space.cells.counts.x), ny = std::size_t(space.cells.counts.y);
  return glm::ivec3(int(i % nx), int(i / nx % ny), int(i / nx / ny));
}

template <class F>
void eachCell(const CellRange& box, const F& f) {
  for (int z = box.low.z; z <= box.high.z; ++z)
    for (int y = box.low.y; y <= box.high.y; ++y)
      for (int x = box.low.x; x <= box.high.x; ++x) f(glm::ivec3(x, y, z));
}

}  // namespace

Closure closureOf(const Space& space, const CellRange& box, int axis, int step, int layer) {
  const int u = axis == 1 ? 0 : 2 - axis, v = axis == 1 ? 2 : 1;  // v: upright, for the sides
  const int rows = box.high[v] - box.low[v] + 1, columns = box.high[u] - box.low[u] + 1;
  const int upper = std::max(1, int(std::lround(kUpper * rows)));
  int closed = 0, closedAbove = 0;
  glm::ivec3 c(0);
  c[axis] = layer;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      c[u] = box.low[u] + i;
      c[v] = box.low[v] + j;
      glm::ivec3 next = c;
      next[axis] += step;
      // Out of a piece of furniture into the room behind it is no wall.
      if (space.in(next) && (!space.in(c) || space.open(c, axis, step))) continue;
      ++closed;
      closedAbove += j >= rows - upper;
    }
  return {double(closed) / (rows * columns), double(closedAbove) / (upper * columns)};
}

std::vector<CellRange> growBoxes(const Space& space, const RoomLimits& limits) {
  std::vector<CellRange> out;
  std::vector<std::uint8_t> left = space.inside;
  const double cell = space.cells.cell;
  for (int n = 0; n < kSeeds && int(out.size()) < limits.rooms; ++n) {
    const std::optional<glm::ivec3> seed = seedOf(space, left, limits.side / 2 - cell / 2);
    if (!seed) break;
    const CellRange box = Grower(space, *seed).run();
    std::size_t free = 0, fresh = 0;
    eachCell(box, [&](glm::ivec3 c) {
      free += space.in(c);
      fresh += space.in(c) && left[space.cells.index(c)];
    });
    const glm::dvec3 side = glm::dvec3(box.extent()) * cell;
    const bool room = double(free) * cell * cell * cell >= limits.volume && std::min({side.x, side.y, side.z}) >= limits.side && double(fresh) >= limits.fresh * double(free);
    if (room) out.push_back(box);
    // What a refused box began with is not tried again.
    const int half = std::max(1, int(space.clearance[space.cells.index(*seed)] / cell));
    const CellRange done = room ? CellRange{box.low - 1, box.high + 1} : CellRange{*seed - half, *seed + half};
    eachCell(done, [&](glm::ivec3 c) {
      if (space.cells.has(c)) left[space.cells.index(c)] = 0;
    });
  }
  return out;
}

}  // namespace burnish::probe
