// Rooms found in geometry: boxes fitted to their walls.
#pragma once
#include <functional>
#include <vector>

#include "probe/rooms_grow.h"

namespace burnish::probe {

struct Room {
  glm::dvec3 center{0}, halfSize{0};  ///< world, metres
  glm::dmat3 axes{1};
  glm::dvec3 capture{0};              ///< a point in the box with much room around it, near the box's middle
  double doors = 0;                   ///< metres: the depth of the deepest opening that leads out of the box, 0 without any
};

struct Rooms {
  std::vector<Room> rooms;
  glm::dmat3 axes{1};  ///< of most walls
  double cell = 0;     ///< metres: rooms and doors much smaller than this are not seen
};

/// Rooms are free space under something from which hardly any sky is seen (kMostSky), cut at doors into boxes. `progress`: 0 to 1, from the calling thread.
Rooms findRooms(const Geometry& geometry, const RoomLimits& limits, int threads, const std::function<void(double)>& progress);

}  // namespace burnish::probe
