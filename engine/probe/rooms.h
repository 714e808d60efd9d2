// Rooms found in geometry: boxes fitted to their walls.
#pragma once
#include <functional>
#include <vector>

#include "probe/rooms_fit.h"

namespace burnish::probe {

struct Rooms {
  std::vector<Room> rooms;
  glm::dmat3 axes{1};  ///< of most walls
  double cell = 0;     ///< metres: rooms and doors much smaller than this are not seen
};

/// Rooms are free space under something from which hardly any sky is seen (kMostSky), cut at doors into boxes. `progress`: 0 to 1, from the calling thread.
Rooms findRooms(const Geometry& geometry, const RoomLimits& limits, int threads, const std::function<void(double)>& progress);

}  // namespace burnish::probe
