// A box of cells becomes a room: its faces on the walls, a point to capture from.
#pragma once
#include <optional>

#include "probe/rooms_grow.h"

namespace burnish::probe {

struct Room {
  glm::dvec3 center{0}, halfSize{0};  ///< world, metres
  glm::dmat3 axes{1};
  glm::dvec3 capture{0};              ///< a point in the box with much room around it, near the box's middle
  double doors = 0;                   ///< metres: the depth of the deepest opening that leads out of the box, 0 without any
};

/// Faces go where rays from the free cells beside them find most of a wall. Nothing where the box's sides are mostly open: a roof on posts is no room.
std::optional<Room> fitted(const Geometry& geometry, const Space& space, const CellRange& box);

}  // namespace burnish::probe
