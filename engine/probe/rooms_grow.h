// Boxes of cells that fill free space up to its walls.
#pragma once
#include <vector>

#include "probe/rooms_space.h"

namespace burnish::probe {

/// Cells from low to high, both inside.
struct CellRange {
  glm::ivec3 low{0}, high{0};
  [[nodiscard]] bool has(glm::ivec3 c) const { return glm::all(glm::greaterThanEqual(c, low)) && glm::all(glm::lessThanEqual(c, high)); }
  [[nodiscard]] glm::ivec3 extent() const { return high - low + 1; }
};

struct RoomLimits {
  double volume = 3;    ///< m³ of free space: what has less is a cupboard
  double side = 0.8;    ///< metres, the shortest one
  double fresh = 0.4;   ///< share of the box's free space that no earlier box has
  int rooms = 256;
};

/// How much of a layer beside a box is closed off.
struct Closure {
  double total = 0;  ///< share of all cells
  double top = 0;    ///< share of the cells of the upper part, where furniture seldom reaches and lintels are
};
/// Of the layer one step beyond the face of the box, from the cells of `layer` (along `axis`) to the next ones.
Closure closureOf(const Space& space, const CellRange& box, int axis, int step, int layer);

/// Boxes, largest clearance first; together they hold the free space but for what is too small. The space must be clear()ed.
std::vector<CellRange> growBoxes(const Space& space, const RoomLimits& limits);

}  // namespace burnish::probe
