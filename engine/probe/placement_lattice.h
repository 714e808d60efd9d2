// A lattice over several rooms, its planes of points close to as many of their walls as can be.
#pragma once
#include <burnish/scene.h>

#include <vector>

#include "probe/rooms.h"

namespace burnish::probe {

/// Points between two walls: at least kAcross, the outermost ones kInset spacings from the walls. docs/probes.md has what fewer cost.
inline constexpr int kAcross = 5;
inline constexpr double kInset = 0.04;

/// Points along one axis.
struct Row {
  double first = 0, spacing = 1;
  int count = 1;
};
/// An interval of the axis between two walls, and how much it matters.
struct Span {
  double low = 0, high = 0, weight = 1;
};
/// Covers all spans with points that are at most `spacing` apart.
Row rowOver(const std::vector<Span>& spans, double spacing);

/// `spacing`: metres; 0: from the shortest room along each axis. At most `most` points (at least 8). `wanted`: how many it would have had.
AmbientGrid latticeOver(const std::vector<Room>& rooms, const glm::dmat3& axes, double spacing, int most, double& wanted);

}  // namespace burnish::probe
