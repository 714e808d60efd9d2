#include "stability/two_rooms.h"

#include <array>
#include <glm/gtc/matrix_transform.hpp>

namespace burnish::stability {

using glm::dvec3;

std::vector<Solid> TwoRooms::solids() const {
  std::vector<Solid> all = roomOf(place(-2, 0, 0), place(2 + thickness, 2, 2), 0.2);
  all.push_back({place(0, -0.1, -0.1), place(thickness, 2.1, 2.1)});
  return all;
}

AmbientGrid latticeOver(const TwoRooms& rooms, double offset, double turn) {
  AmbientGrid grid;
  grid.spacing = dvec3(0.49);
  const dvec3 around = rooms.place(0, 1, 0);
  grid.axes = rooms.frame * glm::dmat3(glm::rotate(glm::dmat4(1), turn, around));
  const int more = turn != 0 ? 3 : 0;  // along what is turned
  grid.counts = glm::ivec3(rooms.place(10 + more, 5, 5 + more));
  const dvec3 middle = rooms.place(rooms.thickness / 2 + offset, 1, 1);
  grid.origin = rooms.frame * middle - grid.axes * (dvec3(grid.counts - 1) * grid.spacing * 0.5);
  fillGrid(
      grid, rooms.solids(), [&](const dvec3& p) { return std::array<dvec3, 9>{dvec3(dot(p, rooms.frame[rooms.axis]) < 0 ? 1.0 : 0.0)}; }, rooms.frame);
  return grid;
}

}  // namespace burnish::stability
