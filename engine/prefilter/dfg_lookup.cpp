// The DFG tables as GL samples them.
#include <algorithm>
#include <cmath>

#include "prefilter/dfg.h"

namespace burnish::prefilter {
namespace {

namespace f64 = shading::f64;

// Linear filtering at texture coordinates in [0, 1], edges clamped (OpenGL 4.5 core, section 8.14.2).
glm::dvec2 filtered(const DfgTable& t, const glm::dvec2& at) {
  const auto split = [](double x, int size, int& low, int& high) {
    const double p = std::clamp(x * size - 0.5, 0.0, double(size - 1));
    low = std::min(int(p), size - 1);
    high = std::min(low + 1, size - 1);
    return p - low;
  };
  int x0, x1, y0, y1;
  const double fx = split(at.x, t.width, x0, x1), fy = split(at.y, t.height, y0, y1);
  const auto texel = [&](int x, int y) {
    const std::size_t i = 2 * (std::size_t(y) * std::size_t(t.width) + std::size_t(x));
    return glm::dvec2(t.texels[i], t.texels[i + 1]) * (double(t.scale) / 65535);
  };
  return glm::mix(glm::mix(texel(x0, y0), texel(x1, y0), fx), glm::mix(texel(x0, y1), texel(x1, y1), fx), fy);
}

}  // namespace

glm::dvec2 lookUpDfg(const shading::Rungs& rungs, double cosine, double alpha) {
  const DfgTable t = dfgTable(dfgIndex(rungs));
  return filtered(t, f64::dfgCoordinate(cosine, f64::dfgRow(alpha), {t.width, t.height})) * f64::dfgScale(f64::powerFromAlpha(alpha), rungs);
}

glm::dvec2 lookUpDfgMean(const shading::Rungs& rungs, double alpha) {
  const DfgTable t = dfgTable(dfgIndex(rungs));
  return filtered(t, f64::dfgMeanCoordinate(f64::dfgRow(alpha), {t.width, t.height})) * f64::dfgScale(f64::powerFromAlpha(alpha), rungs);
}

}  // namespace burnish::prefilter
