#include "prefilter/rings.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "prefilter/parallel.h"
#include "prefilter/quadrature.h"

namespace burnish::prefilter {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// The modified Bessel function of the first kind, order 0, by its series.
double besselI0(double x) {
  const double q = x * x / 4;
  double sum = 1, term = 1;
  for (int i = 1; i < 500 && term > sum * 1e-17; ++i) {
    term *= q / (double(i) * i);
    sum += term;
  }
  return sum;
}

/// Kaiser and Bessel's window I0(β sqrt(u)), u = 1 - (distance/reach)², less its value at the end, over its peak, as a polynomial of u: interpolated at Chebyshev's nodes after a factor u is
/// taken out. β as for non-uniform Fourier transforms (Fourmont 2003), 5 % steeper: measured best for a zonal kernel.
void fitKernel(KernelPolynomial& kernel, double beta, int degree) {
  const double peak = besselI0(beta) - 1;
  const auto quotient = [&](double u) { return (besselI0(beta * std::sqrt(u)) - 1) / (peak * u); };
  const std::size_t n = std::size_t(degree);
  std::vector<double> sum(n + 1, 0.0), before(n + 1, 0.0), now(n + 1, 0.0);
  before[0] = 1;
  now[0] = -1;
  now[1] = 2;  // T_1(2u - 1)
  for (std::size_t j = 0; j < n; ++j) {
    double c = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = kPi * (double(i) + 0.5) / double(n);
      c += quotient((std::cos(angle) + 1) / 2) * std::cos(double(j) * angle);
    }
    c *= (j == 0 ? 1.0 : 2.0) / double(n);
    const std::vector<double>& t = j == 0 ? before : now;
    for (std::size_t i = 0; i <= n; ++i) sum[i] += c * t[i];
    if (j == 0) continue;
    std::vector<double> next(n + 1, 0.0);
    for (std::size_t i = 0; i <= n; ++i) next[i] = -2 * now[i] - before[i] + (i ? 4 * now[i - 1] : 0);
    before = std::move(now);
    now = std::move(next);
  }
  kernel.degree = degree;
  for (std::size_t i = 0; i < n; ++i) kernel.c[i + 1] = sum[i];
}

double betaFor(double width, double oversampling) { return 1.05 * kPi * width * (1 - 1 / (2 * oversampling)); }

std::shared_ptr<const RingGrid> makeGrid(int bands, const GridChoice& choice) {
  auto grid = std::make_shared<RingGrid>();
  RingGrid& g = *grid;
  g.bands = bands;
  g.choice = choice;
  // A multiple of 16, so that half of them fill groups.
  const int count = (int(std::ceil(choice.oversampling * (bands + 1))) + 15) / 16 * 16;
  g.reach = choice.width / 2 * kPi / (count + 0.5);
  g.kernel.scale = 1 / (2 * std::pow(std::sin(g.reach / 2), 2));
  fitKernel(g.kernel, betaFor(choice.width, double(count) / (bands + 1)), choice.degree);
  g.kernelBands = zonalCoefficients(
      [&](double x) {
        const double u = 1 - x * g.kernel.scale;
        double sum = 0;
        for (int i = g.kernel.degree; i >= 1; --i) sum = (sum + g.kernel.c[i]) * u;
        return sum;
      },
      1 / g.kernel.scale, g.reach / 4, bands);
  const GaussNodes nodes = gaussNodes(count);
  std::vector<std::size_t> first;
  int longest = 0;
  std::vector<int> sizes, taps;
  for (int r = 0; r < count; ++r) {
    const double z = nodes.x[std::size_t(r)], s = std::sqrt((1 - z) * (1 + z));
    // As dense along the ring as rings are; near the poles room for orders that fade there.
    const int size = smoothSize(int(std::ceil(std::min(2.0 * count * s + 12 * std::sqrt(1 - s), 2.0 * count))));
    const double reach = std::sin(g.reach) / s;
    taps.push_back(reach >= 1 ? size : std::min(size, int(std::floor(std::asin(reach) * size / kPi)) + 1));
    sizes.push_back(size);
    longest = std::max(longest, size);
    g.z.push_back(z);
    g.sine.push_back(s);
    g.polar.push_back(std::acos(z));
    g.weight.push_back(nodes.weight[std::size_t(r)] * 2 * kPi / size);
    g.fft.try_emplace(size, std::size_t(size), false);
    first.push_back(g.table.size());
    std::vector<double> cosine(std::size_t(size) + 2 * kRingPad), sine(cosine.size());
    for (int k = 0; k < size + 2 * kRingPad; ++k) {
      const double angle = 2 * kPi * (k - kRingPad) / size;
      cosine[std::size_t(k)] = g.kernel.scale * s * std::cos(angle);
      sine[std::size_t(k)] = g.kernel.scale * s * std::sin(angle);
    }
    g.table.insert(g.table.end(), cosine.begin(), cosine.end());
    g.table.insert(g.table.end(), sine.begin(), sine.end());
  }
  for (std::size_t r = 0; r < std::size_t(count); ++r) {
    const double* cosine = g.table.data() + first[r] + kRingPad;
    g.rings.push_back({cosine, cosine + sizes[r] + 2 * kRingPad, g.z[r], sizes[r], taps[r]});
  }
  g.stride = std::size_t((longest + 2 * kRingPad + 15) / 8 * 8);
  return grid;
}

}  // namespace

// One vector of eight doubles holds the taps of a ring up to width 7; measured in docs/prefilter.md.
GridChoice gridChoice(double error) {
  const double digits = -std::log10(error);
  GridChoice c;
  c.width = std::clamp(std::round(3 + digits), 4.0, 10.0);
  c.degree = int(c.width) + 6;
  return c;
}

int RingGrid::lastOrder(int r) const { return std::min(bands, (rings[std::size_t(r)].size - 1) / 2); }

std::shared_ptr<const RingGrid> ringGrid(int bands, const GridChoice& choice, double* made) {
  constexpr std::size_t kKept = 8, kMostBytes = 48u << 20;
  static std::mutex mutex;
  static std::vector<std::shared_ptr<const RingGrid>> kept;  // the latest used last
  const std::lock_guard lock(mutex);
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i]->bands == bands && kept[i]->choice == choice) {
      std::rotate(kept.begin() + std::ptrdiff_t(i), kept.begin() + std::ptrdiff_t(i) + 1, kept.end());
      return kept.back();
    }
  const double before = cpuMilliseconds();
  kept.push_back(makeGrid(bands, choice));
  if (made) *made += cpuMilliseconds() - before;
  const auto bytes = [&] {
    std::size_t sum = 0;
    for (const auto& g : kept) sum += g->table.size() * sizeof(double);
    return sum;
  };
  const std::shared_ptr<const RingGrid> grid = kept.back();
  while (kept.size() > kKept || (kept.size() > 1 && bytes() > kMostBytes)) kept.erase(kept.begin());
  return grid;
}

CircleKernel::CircleKernel(double width) : width_(width), beta_(1.05 * kPi * width * (1 - 1 / 3.0)), norm_(besselI0(beta_)) {}

double CircleKernel::operator()(double distance) const {
  const double t = 2 * distance / width_;
  return std::abs(t) < 1 ? besselI0(beta_ * std::sqrt(1 - t * t)) / norm_ : 0;
}

// width · sinh(sqrt(β² - q²))/(I0(β) sqrt(β² - q²)), q = π m width/size (Fourmont 2003).
double CircleKernel::transform(double m, double size) const {
  const double q = kPi * m * width_ / size, d = beta_ * beta_ - q * q, root = std::sqrt(std::abs(d));
  const double ratio = root < 1e-6 ? 1 : d > 0 ? std::sinh(root) / root : std::sin(root) / root;
  return width_ * ratio / norm_;
}

int smoothSize(int atLeast) {
  for (int n = std::max(atLeast + atLeast % 2, 2);; n += 2) {
    int rest = n;
    for (const int p : {2, 3, 5})
      while (rest % p == 0) rest /= p;
    if (rest == 1) return n;
  }
}

}  // namespace burnish::prefilter
