// H11: two rooms that share a thin wall, and a lattice over both: the lit one has light 1, the dark one none.
#pragma once
#include "stability/lattice.h"

namespace burnish::stability {

/// Two rooms of 2 m x 2 m x 2 m side by side along `axis` of `frame`: the lit one below 0, the dark one above `thickness`.
struct TwoRooms {
  int axis = 0;
  double thickness = 0.02;
  glm::dmat3 frame{1};
  /// In the rooms' own axes.
  [[nodiscard]] glm::dvec3 place(double along, double u, double v) const {
    glm::dvec3 p;
    p[axis] = along, p[(axis + 1) % 3] = u, p[(axis + 2) % 3] = v;
    return p;
  }
  [[nodiscard]] std::vector<Solid> solids() const;
};

/// Spacing 0.49 m, so that 5 points stand across a room; `offset` moves them along the axis, `turn` (radians) turns the lattice against the rooms.
AmbientGrid latticeOver(const TwoRooms& rooms, double offset, double turn);

/// f(place, normal) on the six surfaces of the room from `begin` along the axis, steps² places on each.
template <class F>
void onSurfaces(const TwoRooms& rooms, double begin, int steps, F&& f) {
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double a = 2 * (i + 0.5) / steps, b = 2 * (j + 0.5) / steps;
      for (const double side : {0.0, 2.0}) {
        f(rooms.frame * rooms.place(begin + side, a, b), rooms.frame * rooms.place(1 - side, 0, 0));
        f(rooms.frame * rooms.place(begin + a, side, b), rooms.frame * rooms.place(0, 1 - side, 0));
        f(rooms.frame * rooms.place(begin + a, b, side), rooms.frame * rooms.place(0, 0, 1 - side));
      }
    }
}

}  // namespace burnish::stability
