// Free space in cells: a lattice of cubes, which of its neighbours geometry keeps apart, and which of them are in rooms.
#pragma once
#include <functional>

#include "probe/geometry.h"

namespace burnish::probe {

/// Cells in a box that may be turned about +Y.
struct CellBox {
  glm::dmat3 axes{1};     ///< columns unit and orthogonal; the second one is +Y
  glm::dvec3 low{0};      ///< the box's lowest corner, along the axes (transpose(axes) · world)
  double cell = 0.1;      ///< metres, edge of a cell
  glm::ivec3 counts{0};

  [[nodiscard]] std::size_t size() const { return std::size_t(counts.x) * std::size_t(counts.y) * std::size_t(counts.z); }
  [[nodiscard]] std::size_t index(glm::ivec3 c) const { return std::size_t(c.x) + std::size_t(counts.x) * (std::size_t(c.y) + std::size_t(counts.y) * std::size_t(c.z)); }
  [[nodiscard]] bool has(glm::ivec3 c) const { return glm::all(glm::greaterThanEqual(c, glm::ivec3(0))) && glm::all(glm::lessThan(c, counts)); }
  /// A cell's middle, along the axes and in the world.
  [[nodiscard]] glm::dvec3 local(glm::ivec3 c) const { return low + (glm::dvec3(c) + 0.5) * cell; }
  [[nodiscard]] glm::dvec3 world(glm::ivec3 c) const { return axes * local(c); }
};
/// Cells of an edge of at least `least` metres over a box along the axes, at most `most` of them (and a layer around).
CellBox cellsOver(const glm::dmat3& axes, glm::dvec3 low, glm::dvec3 high, double least, double most);

/// Directions of walls: how often surfaces that stand upright were seen at each angle about +Y, modulo a right angle.
class WallAngles {
 public:
  void add(glm::dvec3 normal);
  void add(const WallAngles& other);
  /// The angle, radians in [-pi/4, pi/4), of most of them; 0 without any.
  [[nodiscard]] double most() const;
  /// The share of them within about half a degree of an angle; 0 without any.
  [[nodiscard]] double share(double angle) const;

 private:
  static constexpr int kBins = 360;
  struct Bin {
    double count = 0, sine = 0, cosine = 0;  // of four times the angle
  };
  std::vector<Bin> bins_ = std::vector<Bin>(kBins);
};

/// What is in sight of a point.
struct Sight {
  int sky = 0, fronts = 0, backs = 0, others = 0;
  [[nodiscard]] bool inRoom() const;
};
/// Where the point is in a room, the directions of the walls that it sees are added.
Sight lookFrom(const Geometry& geometry, glm::dvec3 point, WallAngles& walls);

struct Space {
  CellBox cells;
  std::vector<std::uint8_t> inside;   ///< 1: free, under something, and hardly any sky is seen from it
  std::vector<std::uint8_t> blocked;  ///< bit k: something is between the cell's middle and its next neighbour's along axis k
  std::vector<float> clearance;       ///< metres from the cell's middle to what is not inside, or to geometry, along the farthest axis; at least half a cell where inside; found with clear()
  WallAngles walls;                   ///< seen from inside

  [[nodiscard]] bool in(glm::ivec3 c) const { return cells.has(c) && inside[cells.index(c)]; }
  /// Nothing between a cell and its neighbour one step along an axis (step is 1 or -1).
  [[nodiscard]] bool open(glm::ivec3 c, int axis, int step) const {
    glm::ivec3 other = c;
    other[axis] += step;
    if (!cells.has(c) || !cells.has(other)) return false;
    return !(blocked[cells.index(step > 0 ? c : other)] >> axis & 1);
  }
  void clear();
};

/// The share of directions in which the sky may be seen from a room.
inline constexpr double kMostSky = 0.3;

/// Asks rays. `progress`: 0 to 1, from the calling thread.
Space spaceOf(const Geometry& geometry, const CellBox& cells, int threads, const std::function<void(double)>& progress);

}  // namespace burnish::probe
