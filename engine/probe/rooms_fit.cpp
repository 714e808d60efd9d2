#include "probe/rooms_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "probe/visibility.h"

namespace burnish::probe {
namespace {

using reference::Hit;

constexpr double kEnclosed = 0.5;  // share of a room's sides that has something before it

/// Where most of a wall is: hits within 2 cm of each other, in metres along the axis. NaN without any.
double wallAmong(std::vector<double> places) {
  if (places.empty()) return NAN;
  std::sort(places.begin(), places.end());
  std::size_t bestFrom = 0, bestTo = 0;
  for (std::size_t from = 0, to = 0; from < places.size(); ++from) {
    while (to < places.size() && places[to] <= places[from] + 0.02) ++to;
    if (to - from > bestTo - bestFrom) bestFrom = from, bestTo = to;
  }
  return places[(bestFrom + bestTo) / 2];
}

/// Fits one box of cells to what stands around it.
class Fitter {
 public:
  Fitter(const Geometry& geometry, const Space& space, const CellRange& box) : geometry_(geometry), space_(space), box_(box) {}

  /// Nothing where its sides are mostly open: a roof on posts is no room.
  std::optional<Room> run() {
    glm::dvec3 low(0), high(0);
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = wall(axis, -1);
      high[axis] = wall(axis, 1);
    }
    if (standing_ < kEnclosed * sides_) return {};
    Room room;
    room.axes = space_.cells.axes;
    room.center = room.axes * ((low + high) * 0.5);
    room.halfSize = (high - low) * 0.5;
    room.capture = space_.cells.world(roomiest((low + high) * 0.5));
    for (const int axis : {0, 2})
      for (const int step : {1, -1}) room.doors = std::max(room.doors, opening(axis, step));
    return room;
  }

 private:
  /// The face's place along the axis: by rays from the free cells beside it to what lies flat before them; without such a thing the edge between cells.
  [[nodiscard]] double wall(int axis, int step) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3, layer = step > 0 ? box_.high[axis] : box_.low[axis];
    const double cell = space_.cells.cell;
    std::vector<double> places;
    glm::ivec3 c(0);
    for (c[u] = box_.low[u]; c[u] <= box_.high[u]; ++c[u])
      for (c[v] = box_.low[v]; c[v] <= box_.high[v]; ++c[v])
        for (int k = 0; k < 3; ++k) {
          c[axis] = layer - step * k;
          if (!box_.has(c) || !space_.in(c)) continue;
          const glm::dvec3 from = space_.cells.world(c), along = space_.cells.axes[axis] * double(step);
          const Hit hit = geometry_.rays.nearest({from, along, 0, (k + 2) * cell, kOpaque | kTransparent});
          if (hit && std::abs(glm::dot(hit.normal, along)) > 0.97) places.push_back(space_.cells.local(c)[axis] + step * hit.distance);
          if (axis != 1) standing_ += bool(hit), ++sides_;
          break;
        }
    const double found = wallAmong(std::move(places));
    c[axis] = layer;
    return std::isfinite(found) ? found : space_.cells.local(c)[axis] + step * 0.5 * cell;
  }

  /// The free cell with the most around it, less what it is away from the middle.
  [[nodiscard]] glm::ivec3 roomiest(glm::dvec3 middle) const {
    glm::ivec3 best = (box_.low + box_.high) / 2, c(0);
    double most = -std::numeric_limits<double>::infinity();
    for (c.z = box_.low.z; c.z <= box_.high.z; ++c.z)
      for (c.y = box_.low.y; c.y <= box_.high.y; ++c.y)
        for (c.x = box_.low.x; c.x <= box_.high.x; ++c.x) {
          if (!space_.in(c)) continue;
          const double value = double(space_.clearance[space_.cells.index(c)]) - 0.3 * glm::length(space_.cells.local(c) - middle);
          if (value > most && isFree(geometry_, space_.cells.world(c))) most = value, best = c;
        }
    return best;
  }

  /// How deep the deepest opening in a side is: free cells outward until the way widens, or a metre and a half.
  [[nodiscard]] double opening(int axis, int step) const {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3, layer = step > 0 ? box_.high[axis] : box_.low[axis];
    const int deepest = int(std::ceil(1.5 / space_.cells.cell));
    // Open cells of the side, then of each layer beyond it: at the wall's other side many more are open.
    CellRange side = box_;
    const int cells = (box_.high[u] - box_.low[u] + 1) * (box_.high[v] - box_.low[v] + 1);
    const int open = int(std::lround((1 - closureOf(space_, side, axis, step, layer).total) * cells));
    if (open * space_.cells.cell * space_.cells.cell < 0.25) return 0;
    for (int k = 1; k <= deepest; ++k) {
      const int now = int(std::lround((1 - closureOf(space_, side, axis, step, layer + step * k).total) * cells));
      if (now > open * 5 / 4 || now < open / 4) return k * space_.cells.cell;
    }
    return deepest * space_.cells.cell;
  }

  const Geometry& geometry_;
  const Space& space_;
  CellRange box_;
  int standing_ = 0, sides_ = 0;  // free places along the sides, and those of them that have something before them
};

}  // namespace

std::optional<Room> fitted(const Geometry& geometry, const Space& space, const CellRange& box) { return Fitter(geometry, space, box).run(); }

}  // namespace burnish::probe
