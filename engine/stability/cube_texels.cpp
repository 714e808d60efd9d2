#include "stability/cube_texels.h"

#include <vector>

namespace burnish::stability {

using glm::dvec3;

double seamRatio(const CubeLevel& level) {
  const int n = level.size;
  const auto light = [&](const Texel& t) {
    const float* p = level.texels.data() + 3 * t.index(n);
    return dvec3(p[0], p[1], p[2]);
  };
  std::vector<Texel> border;
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        if (x == 0 || y == 0 || x == n - 1 || y == n - 1) border.push_back({face, x, y});
  struct Slope {
    double top = 0, bottom = 0;
  } across, inside;
  const auto add = [&](Slope& s, const Texel& a, const Texel& b) {
    const dvec3 way = centreOf(n, b.face, b.x, b.y) - centreOf(n, a.face, a.x, a.y), step = light(b) - light(a);
    s.top += glm::dot(step, way), s.bottom += glm::dot(way, way);
  };
  for (const Texel& a : border) {
    const dvec3 d = centreOf(n, a.face, a.x, a.y);
    const Texel* nearest = nullptr;
    double best = -2;
    for (const Texel& b : border)
      if (const double c = glm::dot(d, centreOf(n, b.face, b.x, b.y)); b.face != a.face && c > best) best = c, nearest = &b;
    add(across, a, *nearest);
  }
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x + 1 < n; ++x) {
        add(inside, {face, x, y}, {face, x + 1, y});
        add(inside, {face, y, x}, {face, y, x + 1});
      }
  return across.top / across.bottom / (inside.top / inside.bottom);
}

}  // namespace burnish::stability
