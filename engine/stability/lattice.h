// A lattice looked up on the CPU, through the shading text in double, as shaders/interface/grid.glsl does on the GPU; and lattices made for tests.
#pragma once
#include <burnish/scene.h>

#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace burnish::stability {

struct GridLight {
  glm::dvec3 light{0};  ///< irradiance over π
  double share = 0;     ///< of the lattice; the rest is what is there without one
};

class GridSampler {
 public:
  /// rung: AMBIENT_* of shading/rungs.h.
  explicit GridSampler(const AmbientGrid& grid, int rung = 3);
  [[nodiscard]] GridLight at(const glm::dvec3& p, const glm::dvec3& n) const;

 private:
  /// aim: from the point to where planes are looked up; away: to the place that must lie before them.
  [[nodiscard]] double sees(std::size_t point, const glm::dvec3& aim, const glm::dvec3& away) const;
  const AmbientGrid& grid_;
  int rung_;
  std::vector<std::vector<glm::dvec4>> planes_;
};

/// A box that is full: min, max.
struct Solid {
  glm::dvec3 min, max;
};
/// From a point outside of all solids along a unit vector to the first of them; infinite where there is none.
double distanceTo(const std::vector<Solid>& solids, const glm::dvec3& from, const glm::dvec3& direction);
/// Fills `valid` (false in a solid) and `distances` of every point; light(p) gives the irradiance of the valid ones. frame: columns are the axes of the solids' space in the world.
void fillGrid(AmbientGrid& grid, const std::vector<Solid>& solids, const std::function<std::array<glm::dvec3, 9>(const glm::dvec3&)>& light, const glm::dmat3& frame = glm::dmat3(1));
/// Walls around a box, `thickness` metres.
std::vector<Solid> roomOf(const glm::dvec3& min, const glm::dvec3& max, double thickness);
/// A lattice in a box with n points along each axis, the outer ones `inset` metres from the walls.
AmbientGrid gridIn(const glm::dvec3& min, const glm::dvec3& max, glm::ivec3 n, double inset);

}  // namespace burnish::stability
