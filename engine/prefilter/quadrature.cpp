#include "prefilter/quadrature.h"

#include <algorithm>
#include <cmath>

namespace burnish::prefilter {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// P_n and its derivative.
std::pair<double, double> legendre(int n, double x) {
  double before = 1, p = x;
  for (int k = 2; k <= n; ++k) {
    const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
    before = p;
    p = next;
  }
  return {p, n * (x * p - before) / (x * x - 1)};
}

}  // namespace

GaussNodes gaussNodes(int n) {
  GaussNodes nodes;
  for (int i = 0; i < n; ++i) {
    double x = n == 1 ? 0 : std::cos(kPi * (i + 0.75) / (n + 0.5));  // Newton from Tricomi's estimate
    double slope = 1;
    for (int step = 0; step < 8; ++step) {
      const auto [p, derivative] = legendre(n, x);
      slope = derivative;
      x -= p / derivative;
      if (std::abs(p / derivative) < 1e-15) break;
    }
    slope = legendre(n, x).second;
    nodes.x.push_back(x);
    nodes.weight.push_back(2 / ((1 - x * x) * slope * slope));
  }
  return nodes;
}

// x = s²/2, so that s is the angle near 0, in panels of 24 nodes that grow from the width of f; each turns P_l by 12 radians at most.
std::vector<double> zonalCoefficients(const std::function<double(double)>& f, double end, double width, int bands, std::span<const double> breaks) {
  static const GaussNodes nodes = gaussNodes(24);
  const double last = std::sqrt(2 * end), longest = 12.0 / std::max(bands, 8);
  std::vector<double> edges{0};
  std::size_t next = 0;
  for (double step = std::min(width, longest); edges.back() < last; step = std::min(step * 1.5, longest)) {
    double to = std::min(last, edges.back() + step);
    if (next < breaks.size() && to >= std::sqrt(2 * breaks[next])) to = std::sqrt(2 * breaks[next++]);
    if (to > edges.back()) edges.push_back(to);
  }
  std::vector<double> b(std::size_t(bands) + 1, 0.0), upper(b.size(), 0.0), lower(b.size(), 0.0);
  for (std::size_t l = 2; l < b.size(); ++l) upper[l] = 2 - 1 / double(l), lower[l] = 1 - 1 / double(l);
  constexpr std::size_t kNodes = 24;
  for (std::size_t panel = 0; panel + 1 < edges.size(); ++panel) {
    double c[kNodes], before[kNodes], p[kNodes], value[kNodes];
    for (std::size_t i = 0; i < kNodes; ++i) {
      const double half = (edges[panel + 1] - edges[panel]) / 2, s = edges[panel] + half * (nodes.x[i] + 1), x = s * s / 2;
      value[i] = 2 * kPi * f(x) * s * half * nodes.weight[i];
      c[i] = p[i] = 1 - x;
      before[i] = 1;
      b[0] += value[i];
    }
    for (std::size_t l = 1; l < b.size(); ++l) {
      double sums[4] = {};
      for (std::size_t i = 0; i < kNodes; i += 4)
        for (std::size_t k = 0; k < 4; ++k) sums[k] += value[i + k] * p[i + k];
      b[l] += (sums[0] + sums[1]) + (sums[2] + sums[3]);
      if (l + 1 == b.size()) break;
      for (std::size_t i = 0; i < kNodes; ++i) {
        const double after = upper[l + 1] * c[i] * p[i] - lower[l + 1] * before[i];
        before[i] = p[i];
        p[i] = after;
      }
    }
  }
  return b;
}

}  // namespace burnish::prefilter
