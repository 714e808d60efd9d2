#include "cost/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace burnish::cost {
namespace {

using Values = std::array<double, 3>;

/// A pixel whose standard error is over this share of its value and the picture's mean says nothing: one that a single bright path decides has a standard error of its own size.
constexpr double kUncertain = 0.5;

Values pixel(const Image& image, std::size_t i) {
  const float* p = image.f32() + std::size_t(image.channels) * i;
  return {p[0], p[1], p[2]};
}
bool finite(const Values& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }
double luminance(const Values& v) { return 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2]; }

/// The mean luminance of pixels that are finite in both.
double meanOf(const Image& picture, const Image& other) {
  double sum = 0;
  long long count = 0;
  for (std::size_t i = 0; i < other.pixelCount(); ++i)
    if (const Values o = pixel(other, i); finite(o) && finite(pixel(picture, i))) sum += luminance(o), ++count;
  return count > 0 ? sum / double(count) : 0;
}

/// Sums over pixels. Noise n of variance v in the other makes E[d^2] = delta^2 + v, and E[other^2] = truth^2 + v: v is taken off both. d^2 - v scatters by 4 delta^2 v + 2 v^2 (n normal), of which
/// 4 d^2 v - 2 v^2 is an estimate without bias. The channels of a pixel share their paths: their deviations add up, not their variances.
struct Sums {
  double square = 0, power = 0, scatter = 0, picture = 0, other = 0;

  void add(const Values& p, const Values& o, const Values& v) {
    double deviation = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = p[c] - o[c];
      square += d * d - v[c], power += o[c] * o[c] - v[c];
      deviation += std::sqrt(std::max(4 * d * d * v[c] - 2 * v[c] * v[c], 2 * v[c] * v[c]));
      picture += p[c], other += o[c];
    }
    scatter += deviation * deviation;
  }
};

}  // namespace

PictureError errorOf(const Developed& picture, const Developed& other, const Image* variance) {
  PictureError e;
  const bool noisy = variance && !variance->empty();
  const double mean = meanOf(picture.linear, other.linear);
  Sums sums;
  std::vector<double> shares;
  shares.reserve(other.linear.pixelCount());
  for (std::size_t i = 0; i < other.linear.pixelCount(); ++i) {
    const Values p = pixel(picture.linear, i), o = pixel(other.linear, i), v = noisy ? pixel(*variance, i) : Values{};
    if (!finite(p) || !finite(o) || !finite(v)) {
      ++e.skipped;
      continue;
    }
    const double l = luminance(o), scale = l + mean;
    shares.push_back(scale > 0 ? std::abs(luminance(p) - l) / scale : 0);
    if (noisy && luminance({std::sqrt(std::max(v[0], 0.0)), std::sqrt(std::max(v[1], 0.0)), std::sqrt(std::max(v[2], 0.0))}) > kUncertain * scale) ++e.uncertain;
    else sums.add(p, o, v);
  }
  if (sums.power > 0) {
    e.rms = std::sqrt(std::max(sums.square, 0.0) / sums.power);
    // Of sqrt(x): half of x's deviation over sqrt(x), held where x itself drowns in it.
    const double deviation = std::sqrt(sums.scatter) / sums.power;
    e.rmsSpread = deviation > 0 ? std::min(deviation / (2 * std::max(e.rms, 1e-300)), std::sqrt(deviation)) : 0;
  }
  if (sums.other != 0) e.energy = sums.picture / sums.other - 1;
  if (!shares.empty()) {
    const auto at = shares.begin() + std::ptrdiff_t(std::min(shares.size() - 1, std::size_t(0.999 * double(shares.size()))));
    std::nth_element(shares.begin(), at, shares.end());
    e.p999 = *at;
  }
  if (!picture.display.empty() && !other.display.empty()) {
    e.psnr = psnr(picture.display, other.display);
    e.perceptual = butteraugli(picture.display, other.display);
  }
  return e;
}

double psnr(const Image& picture, const Image& other) {
  double square = 0;
  for (std::size_t i = 0; i < picture.data.size(); ++i) {
    const double d = double(picture.u8()[i]) - double(other.u8()[i]);
    square += d * d;
  }
  if (square == 0) return std::numeric_limits<double>::infinity();
  return 10 * std::log10(255.0 * 255.0 * double(picture.data.size()) / square);
}

Image differenceOf(const Image& picture, const Image& other, double white) {
  Image difference = makeImage(other.width, other.height, 1, PixelType::F32);
  for (std::size_t i = 0; i < other.pixelCount(); ++i) {
    const Values p = pixel(picture, i), o = pixel(other, i);
    if (finite(p) && finite(o)) difference.f32()[i] = float(luminance({std::abs(p[0] - o[0]), std::abs(p[1] - o[1]), std::abs(p[2] - o[2])}) / white);
  }
  return difference;
}

}  // namespace burnish::cost
