// The median of a few values and how far a repeat's median may lie from it.
#include <algorithm>
#include <array>
#include <cmath>

#include "cost/bench.h"

namespace burnish::cost {
namespace {

double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * double(sorted.size() - 1);
  const std::size_t i = std::size_t(at);
  return i + 1 < sorted.size() ? sorted[i] + (sorted[i + 1] - sorted[i]) * (at - double(i)) : sorted.back();
}

// Of n normal values: 95 of 100 repeats have their median within this many interquartile ranges of the first one's, the range taken from the first n alone. By simulation (a test repeats it).
constexpr std::array<double, 17> kWidths{0, 0, 0, 4.03, 2.61, 3.12, 1.92, 1.56, 1.38, 1.35, 1.15, 1.06, 0.99, 0.97, 0.87, 0.83, 0.80};

/// For many values the median scatters by 1.2533 sigma / sqrt(n) (Cramer 1946, section 28.5), two of them by sqrt(2) of that, and the interquartile range is 1.349 sigma; the rest is the fit of what
/// the range itself scatters by.
double width(std::size_t n) { return n < kWidths.size() ? kWidths[n] : 2.575 * (1 + 3.3 / double(n - 2)) / std::sqrt(double(n)); }

}  // namespace

Spread spreadOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  Spread s;
  s.median = quantile(values, 0.5);
  s.count = int(values.size());
  const double reach = values.size() < 3 ? values.back() - values.front() : width(values.size()) * (quantile(values, 0.75) - quantile(values, 0.25));
  s.low = std::max(s.median - reach, 0.0);
  s.high = s.median + reach;
  return s;
}

Spread times(const Spread& a, const Spread& b) {
  if (a.count == 0 || b.count == 0) return {};
  Spread s;
  s.median = a.median * b.median;
  s.count = std::min(a.count, b.count);
  const auto share = [](double edge, double median) { return median > 0 ? std::abs(edge / median - 1) : 0; };
  s.low = s.median * std::max(1 - std::hypot(share(a.low, a.median), share(b.low, b.median)), 0.0);
  s.high = s.median * (1 + std::hypot(share(a.high, a.median), share(b.high, b.median)));
  return s;
}

}  // namespace burnish::cost
