#include "probe/placement_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burnish::probe {
namespace {

/// Spacings between the outermost points of a row whose points have kInset to both walls.
double spacingsIn(double points) { return points - 1 + 2 * kInset; }

/// What a row leaves between walls and the points next to them, in spacings; a point that touches a wall is no use.
double gaps(const Row& row, const std::vector<Span>& spans) {
  double sum = 0;
  for (const Span& s : spans)
    for (const double offset : {s.low - row.first, row.first - s.high}) {
      const double steps = offset / row.spacing;
      double gap = std::ceil(steps) - steps;
      if (gap < kInset * 0.999) gap += 1;
      sum += s.weight * gap;
    }
  return sum;
}

}  // namespace

Row rowOver(const std::vector<Span>& all, double most) {
  constexpr double kClosest = 0.75;  // of the spacing that is asked for
  constexpr std::size_t kTried = 12, kJudged = 64;
  // The largest walls say where points may go; the rest is covered as it comes.
  std::vector<Span> spans = all;
  std::stable_sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.weight > b.weight; });
  const std::vector<Span> tried(spans.begin(), spans.begin() + std::ptrdiff_t(std::min(kTried, spans.size())));
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::vector<double> spacings{most};
  for (const Span& a : spans) {
    low = std::min(low, a.low);
    high = std::max(high, a.high);
  }
  for (const Span& a : tried)
    for (const Span& b : tried) {
      const double between = b.high - a.low;
      if (!(between > 0)) continue;
      const double points = std::max(2.0, std::ceil(between / most - 2 * kInset - 1e-9) + 1);
      for (const double n : {points, points + 1}) spacings.push_back(between / spacingsIn(n));
    }
  if (spans.size() > kJudged) spans.resize(kJudged);
  Row best;
  double least = std::numeric_limits<double>::infinity();
  for (const double spacing : spacings) {
    if (!(spacing <= most * (1 + 1e-9)) || spacing < most * kClosest) continue;
    for (const Span& s : tried)
      for (const double anchor : {s.low + kInset * spacing, s.high - kInset * spacing}) {
        Row row{anchor, spacing, 1};
        const double cost = gaps(row, spans);
        if (cost > least - 1e-9) continue;
        least = cost;
        best = row;
      }
  }
  // From the first point between the outermost walls to the last one; one more where more than half a cell would be bare.
  const auto steps = [&](double place) { return (place - best.first) / best.spacing; };
  double from = std::ceil(steps(low) - 1e-9), to = std::floor(steps(high) + 1e-9);
  if (from - steps(low) > 0.5) --from;
  if (steps(high) - to > 0.5) ++to;
  best.first += from * best.spacing;
  best.count = int(std::clamp(to - from + 1, 1.0, 1e9));
  return best;
}

AmbientGrid latticeOver(const std::vector<Room>& rooms, const glm::dmat3& axes, double spacing, int most, double& wanted) {
  std::vector<Span> spans[3];
  glm::dvec3 shortest(std::numeric_limits<double>::infinity());
  for (const Room& room : rooms) {
    const glm::dmat3 turn = glm::transpose(axes) * room.axes;
    const glm::dvec3 middle = glm::transpose(axes) * room.center;
    glm::dvec3 half(0);
    for (int k = 0; k < 3; ++k) half += glm::abs(turn[k]) * room.halfSize[k];
    for (int k = 0; k < 3; ++k) {
      spans[k].push_back({middle[k] - half[k], middle[k] + half[k], half[(k + 1) % 3] * half[(k + 2) % 3]});
      shortest[k] = std::min(shortest[k], 2 * half[k]);
    }
  }
  AmbientGrid grid;
  grid.name = "rooms";
  grid.axes = axes;
  wanted = 0;
  for (glm::dvec3 limit = spacing > 0 ? glm::dvec3(spacing) : shortest / spacingsIn(kAcross);;) {
    glm::dvec3 first(0);
    for (int k = 0; k < 3; ++k) {
      const Row row = rowOver(spans[k], limit[k]);
      first[k] = row.first;
      grid.spacing[k] = row.spacing;
      grid.counts[k] = row.count;
    }
    grid.origin = axes * first;
    const double points = double(grid.counts.x) * grid.counts.y * grid.counts.z;
    if (wanted == 0) wanted = points;
    if (points <= std::max(most, 8)) return grid;
    limit *= std::max(1.02, 0.9 * std::cbrt(points / most));
  }
}

}  // namespace burnish::probe
