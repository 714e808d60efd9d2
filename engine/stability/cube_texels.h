// Where a cube's texels are, written down once more from OpenGL 4.5's table 8.19: shares nothing with engine/prefilter.
#pragma once
#include <burnish/image.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>

namespace burnish::stability {

inline constexpr double kCircle = 6.28318530717958647692;

/// Unit vector to a texel's centre, by OpenGL 4.5's table 8.19 read the other way.
inline glm::dvec3 centreOf(int size, int face, int x, int y) {
  const double u = (x + 0.5) / size * 2 - 1, v = (y + 0.5) / size * 2 - 1;
  const glm::dvec3 all[6] = {{1, -v, -u}, {-1, -v, u}, {u, 1, v}, {u, -1, -v}, {u, -v, 1}, {-u, -v, -1}};
  return glm::normalize(all[face]);
}

struct Texel {
  int face = 0, x = 0, y = 0;
  [[nodiscard]] std::size_t index(int size) const { return (std::size_t(face) * std::size_t(size) + std::size_t(y)) * std::size_t(size) + std::size_t(x); }
};

/// The texel that a direction (of any length) points at: table 8.19 as it is written.
inline Texel texelAt(int size, const glm::dvec3& d) {
  const glm::dvec3 a = glm::abs(d);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  const bool negative = d[axis] < 0;
  const double s[3] = {negative ? d.z : -d.z, d.x, negative ? -d.x : d.x}, t[3] = {-d.y, negative ? -d.z : d.z, -d.y};
  const auto texel = [&](double u) { return std::clamp(int(std::floor((u / a[axis] + 1) / 2 * size)), 0, size - 1); };
  return {2 * axis + (negative ? 1 : 0), texel(s[axis]), texel(t[axis])};
}

/// Texel (x, y) of a face, or, where one of the two is -1 or `size`, the texel across that edge: the faces' plane folded there.
inline Texel acrossEdge(int size, int face, int x, int y) {
  if (x >= 0 && y >= 0 && x < size && y < size) return {face, x, y};
  const double u = (x + 0.5) / size * 2 - 1, v = (y + 0.5) / size * 2 - 1, over = std::max(std::abs(u), std::abs(v)) - 1;
  const glm::dvec3 all[6] = {{1, -v, -u}, {-1, -v, u}, {u, 1, v}, {u, -1, -v}, {u, -v, 1}, {-u, -v, -1}};
  glm::dvec3 p = all[face];
  p[face / 2] *= 1 - over;
  return texelAt(size, glm::clamp(p, -1.0, 1.0));
}

/// Solid angle of a texel: the sum over its corners of atan(uv / sqrt(u² + v² + 1)) (Driscoll 2012).
inline double texelSolidAngle(int size, int x, int y) {
  const auto a = [&](int i, int j) {
    const double u = 2.0 * i / size - 1, v = 2.0 * j / size - 1;
    return std::atan2(u * v, std::sqrt(u * u + v * v + 1));
  };
  return a(x + 1, y + 1) - a(x, y + 1) - a(x + 1, y) + a(x, y);
}

/// Least squares of the steps between neighbours along the way between their directions, across faces' edges over inside faces, all channels: 1 where there are no seams. For levels of a slope,
/// radiance a + b · direction, which every lobe leaves a slope.
double seamRatio(const CubeLevel& level);

}  // namespace burnish::stability
