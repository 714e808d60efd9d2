// Radiosity of a unit cube in double: an oracle that shares nothing with the engine. All six walls are diffuse with one albedo; the ceiling (+y) emits radiance 1.
// Walls are rectangles of constant radiance, graded toward the edges, where the light has its kinks. Irradiance at a point from such a rectangle is Lambert's closed form (a sum over the polygon's
// edges), so walls that touch need no care. The equation is solved at the rectangles' middles.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace burnish::test {

class CubeOracle {
 public:
  /// `cells`: rectangles along a side of a wall, even.
  CubeOracle(double albedo, int cells, double emission = 1, bool allEmit = false);

  /// Irradiance over π at a point in the cube or on its walls, on a plane that faces n (unit).
  [[nodiscard]] double irradiance(const glm::dvec3& p, const glm::dvec3& n) const;
  /// Radiance that a wall sends out at a point of it, from the irradiance there. wall: 2 · axis + (1 on the side at 1).
  [[nodiscard]] double radiance(int wall, const glm::dvec3& p) const;
  /// Irradiance over π around a point inside as nine harmonics: the radiance of the walls times the basis, over all directions, with Gaussian points on each rectangle. The basis is x, y, z alone,
  /// without constants, in the order of IrradianceSh.
  [[nodiscard]] std::array<double, 9> harmonics(const glm::dvec3& p) const;
  /// What of the equation is left at the solution, largest.
  [[nodiscard]] double residual() const { return residual_; }

 private:
  struct Cell {
    std::array<glm::dvec3, 4> corner;
    glm::dvec3 normal;  // into the cube
    double radiance;
  };
  std::vector<Cell> cells_;
  double albedo_, emission_, residual_ = 0;
  bool allEmit_;
};

/// The inward normal of a wall, and the wall's point at (u, v) in [0, 1]².
glm::dvec3 wallNormal(int wall);
glm::dvec3 wallPoint(int wall, double u, double v);

}  // namespace burnish::test
