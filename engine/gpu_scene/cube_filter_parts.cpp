#include "gpu_scene/cube_filter_parts.h"

#include <algorithm>
#include <cmath>

namespace burnish::gpu_scene {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kTerms = 7;
using Polynomial = std::array<double, kTerms>;

/// The polynomial of x that equals log2 of (1 - x/2)^(power/2) at Chebyshev's nodes of [0, end], by Newton's divided differences.
Polynomial exponentOf(double power, double end) {
  std::array<double, kTerms> node{}, divided{};
  for (std::size_t i = 0; i < kTerms; ++i) {
    node[i] = end * (1 + std::cos(kPi * (double(i) + 0.5) / kTerms)) / 2;
    divided[i] = power / 2 * std::log1p(-node[i] / 2) / std::log(2.0);
  }
  for (std::size_t k = 1; k < kTerms; ++k)
    for (std::size_t i = kTerms - 1; i >= k; --i) divided[i] = (divided[i] - divided[i - 1]) / (node[i] - node[i - k]);
  Polynomial c{};
  for (std::size_t i = kTerms; i-- > 0;) {
    for (std::size_t k = kTerms; k-- > 0;) c[k] = (k ? c[k - 1] : 0) - node[i] * c[k];
    c[0] += divided[i];
  }
  return c;
}

/// Taylor's polynomial of (1 - x)/(1 + slope x)² about `end`, by x - end.
Polynomial taylorOf(double slope, double end) {
  const double d = 1 + slope * end;
  const auto inverse = [&](int n) { return n < 0 ? 0.0 : (n % 2 ? -1 : 1) * (n + 1) * std::pow(slope / d, n) / (d * d); };
  Polynomial c{};
  for (int n = 0; n < kTerms; ++n) c[std::size_t(n)] = (1 - end) * inverse(n) - inverse(n - 1);
  return c;
}

std::array<float, 8> packed(const Polynomial& c) {
  std::array<float, 8> out{};
  std::copy(c.begin(), c.end(), out.begin());
  return out;
}

double spacing(const CubeGrid& grid) { return 2.0 / grid.size; }  // in the middle of a face, where it is widest

// Six points' interpolation errs by (225/64)/6! · spacing⁶ · the sixth derivative, which for GGX's tail (width/angle)⁴ is 9!/3! · width⁴/angle¹⁰; along two axes, and
// with the Taylor polynomial within the angle, it came to eight times that where a sun stands between four points in the middle of a face.
double reachOf(double spacing, double width, double error) {
  return std::max(3 * spacing, std::pow(8 * 225.0 / 64 / 720 * 60480 * std::pow(spacing, 6) * std::pow(width, 4) / error, 0.1));
}

CubeLobePart partOn(const CubeGrid& grid, double end) {
  CubeLobePart part;
  // No lobe is so narrow that it falls between the points.
  end = std::min(1.0, std::max(end, 1 - std::cos(std::min(1.5 * spacing(grid), 1.5))));
  const double cosine = 1 - end;
  part.grid = {grid.size, grid.beyond, grid.side, grid.x};
  part.support = {float(end), float(cosine * cosine), float(std::sqrt(1 - cosine * cosine)), float(grid.y)};
  return part;
}

}  // namespace

std::vector<CubeLobePart> cubeLobeParts(const prefilter::Lobe& lobe, const std::vector<CubeGrid>& grids, const CubeFilterEffort& effort) {
  const bool ggx = lobe.shape == ReflectionLobe::Ggx;
  const double alpha = std::sqrt(lobe.alpha2);
  // The sixth derivative at the peak, which decides how well the grid's interpolation follows, is that of a Gaussian of this deviation.
  const double width = alpha * (ggx ? 2 * std::pow(15.0 / 2880, 1.0 / 6) : std::sqrt(2.0));
  // What is left of the lobe's power at the horizon.
  const double cut = ggx ? 1 / std::pow(1 + (1 / lobe.alpha2 - 1) / 2, 2) : std::exp2(-lobe.power / 2);
  const auto coarsest = [&](double spacingAtMost) {
    std::size_t m = 0;
    while (m + 1 < grids.size() && spacing(grids[m + 1]) <= spacingAtMost) ++m;
    return m;
  };
  std::size_t m = coarsest(width / effort.fineness);
  std::size_t last = grids.size() - 1;  // that carries the horizon's kink
  while (last > 0 && cut > 0.002 && grids[last].size < (cut > 0.25 ? effort.horizon : effort.horizon / 2)) --last;
  std::vector<CubeLobePart> parts;
  if (!ggx) {
    // Past x = end there is e^-k of the integral.
    const double end = lobe.power > 0 ? std::min(1.0, 4 / lobe.power * std::log(1 / effort.tail)) : 1;
    if (end >= 1) m = std::min(m, last);
    parts.push_back(partOn(grids[m], end));
    parts.back().inner = packed(exponentOf(lobe.power, double(parts.back().support.x)));
    return parts;
  }
  const double slope = (1 / lobe.alpha2 - 1) / 2;
  double inner = 0;
  for (m = std::min(m, last); int(parts.size()) < kMostCubeParts; ++m) {
    const double angle = m < last ? reachOf(spacing(grids[m + 1]), 2 * alpha, effort.far) : 4;
    const bool whole = angle > 1 || int(parts.size()) + 1 == kMostCubeParts;
    double end = whole ? 1.0 : 1 - std::cos(angle);
    CubeLobePart part = partOn(grids[m], end);
    part.shape = {float(slope), float(inner), whole ? 0.0f : float(end), 0};
    if (inner > 0) part.inner = packed(taylorOf(slope, double(part.shape.y)));
    if (!whole) part.outer = packed(taylorOf(slope, double(part.shape.z)));
    parts.push_back(part);
    if (whole) break;
    inner = end;
  }
  return parts;
}

double pointsSummed(const std::vector<CubeLobePart>& parts) {
  double sum = 0;
  for (const CubeLobePart& p : parts) sum += 6.0 * (p.support.x < 1 ? p.grid.x * p.grid.x : p.grid.z * p.grid.z) * double(p.support.x) / 2;
  return sum;
}

}  // namespace burnish::gpu_scene
