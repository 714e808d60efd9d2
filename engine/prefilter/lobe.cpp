#include "prefilter/lobe.h"

#include <algorithm>
#include <cmath>

#include "prefilter/quadrature.h"
#include "reference/shading.h"

namespace burnish::prefilter {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kMostBands = 1024;  ///< sin^m of the recurrence's start stays far above what a double can hold

/// Bands until sqrt(Σ (2l + 1) b_l²) over the rest is at most `share` of that over all: what is left out of the lobe of one point, root mean square. As many as there are if that is never.
int bandsNeeded(const std::vector<double>& b, double share, double all) {
  double rest = 0;
  int l = int(b.size()) - 1;
  for (; l > 0; --l) {
    rest += (2 * l + 1) * b[std::size_t(l)] * b[std::size_t(l)];
    if (rest > share * share * all) break;
  }
  return l;
}

double energy(const std::vector<double>& b) {
  double all = 0;
  for (std::size_t l = 0; l < b.size(); ++l) all += double(2 * l + 1) * b[l] * b[l];
  return all;
}

/// Few sizes, so that tables of a ring grid serve several levels: 2^n and 3/4, 5/8, 7/8 of it.
int rounded(int bands) {
  for (int top = 32;; top *= 2)
    for (const int eighths : {5, 6, 7, 8})
      if (top / 8 * eighths >= bands) return top / 8 * eighths;
}

/// Milliseconds on one core with 512-bit vectors, measured roughly (docs/prefilter.md): they only have to rank.
double transformCost(double bands) { return 2 * (2.1e-7 * bands * bands * bands + 2e-4 * bands * bands); }
double directCost(double texels, double outputs, double end) { return texels * outputs * end / 2 * 5e-7; }

}  // namespace

Lobe Lobe::of(ReflectionLobe shape, double roughness) {
  const double alpha = shading::f64::alphaFromRoughness(roughness);
  return {shape, alpha * alpha, shading::f64::powerFromAlpha(alpha)};
}

double Lobe::operator()(double x) const {
  if (x >= 1) return 0;
  if (shape == ReflectionLobe::BlinnPhong) return std::exp(power / 2 * std::log1p(-x / 2)) * (1 - x);
  const double d = 1 - x / 2 + x / 2 / alpha2;
  return (1 - x) / (d * d);
}

double Lobe::width() const { return std::min(1.0, std::sqrt(alpha2)); }

namespace {

// (1 - x)/(1 + k x)² with k = (1/α² - 1)/2, at x = end: 1/(d + k h)² = Σ (-1)^n (n + 1) k^n/d^(n + 2) h^n.
Split taylorSplit(const Lobe& lobe, double end) {
  Split s;
  s.end = end;
  s.taylor = true;
  const double k = (1 / lobe.alpha2 - 1) / 2, d = 1 + k * end;
  const auto inverse = [&](int n) { return n < 0 ? 0.0 : (n % 2 ? -1 : 1) * (n + 1) * std::pow(k / d, n) / (d * d); };
  for (int n = 0; n <= Split::kDegree; ++n) s.c[std::size_t(n)] = (1 - end) * inverse(n) - inverse(n - 1);
  return s;
}

/// The lobe's 16th root on [0, end] as a polynomial, interpolated at Chebyshev's nodes: it falls to e^-1 there, so degree 6 is good to 1e-9.
std::array<double, Split::kDegree + 1> sixteenthRoot(const Lobe& lobe, double end) {
  constexpr int n = Split::kDegree + 1;
  std::array<double, n> node{}, divided{}, c{};
  for (int i = 0; i < n; ++i) {
    node[std::size_t(i)] = (1 + std::cos(kPi * (i + 0.5) / n)) / 2;
    const double x = node[std::size_t(i)] * end;
    divided[std::size_t(i)] = std::exp((lobe.power / 2 * std::log1p(-x / 2) + std::log1p(-x)) / 16);
  }
  for (int k = 1; k < n; ++k)
    for (int i = n - 1; i >= k; --i) divided[std::size_t(i)] = (divided[std::size_t(i)] - divided[std::size_t(i - 1)]) / (node[std::size_t(i)] - node[std::size_t(i - k)]);
  for (int i = n - 1; i >= 0; --i) {  // c := c (t - node) + divided
    for (int k = n - 1; k >= 0; --k) c[std::size_t(k)] = (k ? c[std::size_t(k - 1)] : 0) - node[std::size_t(i)] * c[std::size_t(k)];
    c[0] += divided[std::size_t(i)];
  }
  double scale = 1;
  for (double& v : c) v *= scale, scale /= end;
  return c;
}

double smoothPart(const Lobe& lobe, const Split& s, double x) {
  if (x >= s.end) return lobe(x);
  double sum = 0;
  for (int n = Split::kDegree; n >= 0; --n) sum = sum * (x - s.end) + s.c[std::size_t(n)];
  return sum;
}

}  // namespace

Split splitLobe(const Lobe& lobe, double error, double texels, double outputs) {
  // Next to a light the dark is a thousandth of the mean, and is to be right too. A Gaussian's bands end so suddenly that more care costs little.
  const double share = error * (lobe.shape == ReflectionLobe::BlinnPhong ? 0.002 : 0.05);
  // The kink at the horizon: its bands fall like l^-2.5 for ever. Bright texels are summed apart, so what is left of the source has little in high bands, and the point's own measure would ask for
  // far too many (docs/prefilter.md has the errors).
  const int kink = std::clamp(int(160 * std::pow(1e-4 / error, 0.4)), 32, kMostBands);
  const auto allBands = [&](int most) { return zonalCoefficients(lobe, 1, lobe.width() / 2, most); };
  Split whole;
  // What the fall from the peak takes: Gaussian for Blinn-Phong, exponential for GGX.
  const double narrow = lobe.shape == ReflectionLobe::BlinnPhong ? std::sqrt(lobe.power / 2 * std::log(30 / share)) : std::log(30 / share) / (2 * std::sqrt(lobe.alpha2));
  double cost = 1e30;
  if (narrow < kMostBands) {
    std::vector<double> b = allBands(std::max(rounded(int(narrow) + 1), rounded(kink)));
    const int bands = std::min(rounded(std::min(bandsNeeded(b, share, energy(b)), std::max(kink, int(narrow) + 1))), int(b.size()) - 1);
    b.resize(std::size_t(bands) + 1);
    whole.far = std::move(b);
    cost = transformCost(bands);
  }
  if (lobe.shape == ReflectionLobe::BlinnPhong) {
    // Past x = end there is e^-k of the lobe's integral.
    const double end = 4 / lobe.power * std::log(60 / error);
    if (lobe.power < 500 || directCost(texels, outputs, end) > cost) return whole;
    Split s;
    s.end = end;
    s.c = sixteenthRoot(lobe, end);
    return s;
  }
  // GGX's tails do not end: texels nearby, and the rest in bands.
  Split best = std::move(whole);
  if (narrow < 48) return best;
  for (const double angle : {0.05, 0.07, 0.1, 0.14}) {
    const double end = 1 - std::cos(angle), direct = directCost(texels, outputs, end);
    if (direct > cost) break;
    Split s = taylorSplit(lobe, end);
    const int most = std::min(rounded(int(20 * std::pow(share, -1.0 / 7) / angle)), kMostBands);
    const double breaks[1] = {end};
    std::vector<double> b = zonalCoefficients([&](double x) { return smoothPart(lobe, s, x); }, 1, angle / 8, most, breaks);
    // Over the whole lobe's energy, or over its own where the lobe is so narrow that it may fall between texels.
    const double own = energy(b), all = narrow < kMostBands ? std::max(own, energy(best.far)) : own;
    const int bands = std::min(rounded(std::min(bandsNeeded(b, share, all), std::max(kink, int(narrow) + 1))), most);
    const double c = direct + transformCost(bands);
    if (c >= cost) continue;
    cost = c;
    b.resize(std::size_t(bands) + 1);
    s.far = std::move(b);
    best = std::move(s);
  }
  return best;
}

}  // namespace burnish::prefilter
