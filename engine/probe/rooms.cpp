#include "probe/rooms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "probe/rooms_fit.h"

namespace burnish::probe {
namespace {

constexpr double kCoarseCells = 300'000, kFineCells = 500'000, kTurnedCells = 400'000;  // at most; the last one over all turned rooms together
constexpr double kLeastCell = 0.1;  // metres
constexpr std::size_t kTurnedRooms = 16;

glm::dmat3 turnedBy(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
}

struct Extent {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  void add(glm::dvec3 p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  [[nodiscard]] bool empty() const { return !(low.x <= high.x); }
};

/// The box along `axes` around the cells that are inside, with a cell more on every side.
Extent extentOf(const Space& space, const glm::dmat3& axes) {
  Extent out;
  const glm::ivec3 n = space.cells.counts;
  const glm::dmat3 back = glm::transpose(axes);
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x)
        if (space.in({x, y, z})) out.add(back * space.cells.world({x, y, z}));
  out.low -= 1.5 * space.cells.cell;
  out.high += 1.5 * space.cells.cell;
  return out;
}

double angleOf(const glm::dmat3& axes) { return std::atan2(-axes[0].z, axes[0].x); }

/// What walls a box's free cells see: of up to some hundred cells, spread over it.
WallAngles seenFrom(const Geometry& geometry, const Space& space, const CellRange& box) {
  const glm::dvec3 extent(box.extent());
  const int stride = std::max(1, int(std::cbrt(extent.x * extent.y * extent.z / 300)));
  WallAngles walls;
  for (int z = box.low.z; z <= box.high.z; z += stride)
    for (int y = box.low.y; y <= box.high.y; y += stride)
      for (int x = box.low.x; x <= box.high.x; x += stride)
        if (space.in({x, y, z})) lookFrom(geometry, space.cells.world({x, y, z}), walls);
  return walls;
}

/// Whether the box's own walls run along the axes: if not most of them, then no others do more so.
bool stands(const Geometry& geometry, const Space& space, const CellRange& box, const glm::dmat3& axes) {
  const WallAngles walls = seenFrom(geometry, space, box);
  return walls.share(angleOf(axes)) >= 0.5 * walls.share(walls.most());
}

bool holds(const Room& room, glm::dvec3 point) { return glm::all(glm::lessThanEqual(glm::abs(glm::transpose(room.axes) * (point - room.center)), room.halfSize)); }

void add(std::vector<Room>& rooms, const std::optional<Room>& room) {
  if (room) rooms.push_back(*room);
}

/// A room whose walls run another way than most: looked at again along its own.
void addTurned(const Geometry& geometry, const Space& space, const CellRange& box, double cells, const RoomLimits& limits, int threads, std::vector<Room>& rooms) {
  const glm::dvec3 middle = (space.cells.world(box.low) + space.cells.world(box.high)) * 0.5;
  if (std::any_of(rooms.begin(), rooms.end(), [&](const Room& r) { return holds(r, middle); })) return;
  const glm::dmat3 axes = turnedBy(seenFrom(geometry, space, box).most()), back = glm::transpose(axes);
  const double reach = glm::length(glm::dvec3(box.extent())) * space.cells.cell;
  Space own = spaceOf(geometry, cellsOver(axes, back * middle - reach, back * middle + reach, kLeastCell, cells), threads, {});
  own.clear();
  for (const CellRange& found : growBoxes(own, limits)) {
    const std::optional<Room> room = fitted(geometry, own, found);
    if (room && holds(*room, middle)) return rooms.push_back(*room);
  }
}

}  // namespace

Rooms findRooms(const Geometry& geometry, const RoomLimits& limits, int threads, const std::function<void(double)>& progress) {
  const auto part = [&](double from, double to) { return [=, &progress](double share) { if (progress) progress(from + (to - from) * share); }; };
  Rooms out;
  if (geometry.rays.triangles() == 0) return out;
  const Space coarse = spaceOf(geometry, cellsOver(glm::dmat3(1), geometry.rays.low(), geometry.rays.high(), 2 * kLeastCell, kCoarseCells), threads, part(0, 0.2));
  out.cell = coarse.cells.cell;
  out.axes = turnedBy(coarse.walls.most());
  const Extent rooms = extentOf(coarse, out.axes);
  if (rooms.empty()) return out;
  Space fine = spaceOf(geometry, cellsOver(out.axes, rooms.low, rooms.high, kLeastCell, kFineCells), threads, part(0.2, 0.9));
  fine.clear();
  out.cell = fine.cells.cell;
  std::vector<CellRange> turned;
  for (const CellRange& box : growBoxes(fine, limits))
    if (stands(geometry, fine, box, out.axes))
      add(out.rooms, fitted(geometry, fine, box));
    else
      turned.push_back(box);
  if (turned.size() > kTurnedRooms) turned.resize(kTurnedRooms);
  for (const CellRange& box : turned) addTurned(geometry, fine, box, kTurnedCells / double(std::max<std::size_t>(turned.size(), 4)), limits, threads, out.rooms);
  if (progress) progress(1);
  return out;
}

}  // namespace burnish::probe
