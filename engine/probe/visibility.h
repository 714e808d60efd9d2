// What points see of a scene's surfaces (probe/geometry.h).
#pragma once
#include <functional>

#include "probe/geometry.h"

namespace burnish::probe {

/// A surface nearer than this is touched: a picture from there shows little else. metres; and of a lattice's points a share of its closest spacing.
inline constexpr double kTouch = 0.05, kTouchShare = 0.02;
/// Metres: what lies in a narrower crack is no free point.
inline constexpr double kCrack = 0.05;

/// What a ray met (geometry.rays.nearest) says of where it comes from: free space, the inside of something, or nothing: a two-sided surface, or two sheets on each other, back to back, as walls
/// without thickness have them, and a body that stands on a floor.
enum class Side : std::uint8_t { Front, Back, Unknown };
Side sideOf(const Geometry& geometry, const reference::Ray& ray, const reference::Hit& hit);

/// Whether a point is free: not inside something nor in a crack (kCrack), and nothing opaque is nearer than `touch`. It is inside something where most of the rays from it that tell see a back; or a fifth of them do,
/// and in all of many directions one and the same instance is left more often than entered: bodies that stick in each other show fronts inside.
bool isFree(const Geometry& geometry, glm::dvec3 point, double touch = kTouch);

/// The share of directions, 0 to 1, in which nothing opaque or transparent is.
double skyShare(const Geometry& geometry, glm::dvec3 point);

/// A lattice point's `valid` and `distances` (AmbientGrid::Point; shaders/shading/grid.h has the mapping and the length at which distances are held). A point that is not valid has distances too.
AmbientGrid::Point lookAround(const Geometry& geometry, glm::dvec3 point, glm::dvec3 spacing);

/// Fills the points of a lattice that has none; their irradiance is zero. Errors: no lattice (counts or spacing that are not above 0 or not finite), more than kMaxLatticePoints.
/// `threads`: 0 is one for each core; the result does not depend on it. `progress`: called from the calling thread with the share that is done, 0 to 1.
inline constexpr long kMaxLatticePoints = 1 << 20;
Result<void> fillPoints(const Geometry& geometry, AmbientGrid& grid, int threads, const std::function<void(double)>& progress = {});

/// The instances that a picture of six views with size² pixels shows from a point: those that a ray through the middle of a pixel passes, up to the first opaque surface. Backs of one-sided
/// surfaces do not count. In order of the scene's table.
std::vector<Id<Instance>> visibleInstances(const Geometry& geometry, glm::dvec3 point, int size);

}  // namespace burnish::probe
