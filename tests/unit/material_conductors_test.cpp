// The library's conductors against their optical constants: F0, and eta and k over the angle.
#include <burnish/material.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "optical_constants.h"

using namespace burnish;

namespace {

// CIE standard illuminant D65, 380 to 700 nm in steps of 10.
constexpr std::array kD65 = {49.98,  54.65,  82.75,  91.49,  93.43,  86.68,  104.86, 117.01, 117.81, 114.86, 115.92,
                             108.81, 109.35, 107.80, 104.79, 107.69, 104.41, 104.05, 100.00, 96.33,  95.79,  88.69,
                             90.01,  89.60,  87.70,  83.29,  83.70,  80.03,  80.21,  82.28,  78.28,  69.72,  71.61};
constexpr int kFirst = 380, kLast = 700, kStep = 2, kAngles = 90;  // nm; degrees from the normal, 0 to 89

double lobe(double x, double mean, double below, double above) {
  const double t = (x - mean) * (x < mean ? below : above);
  return std::exp(-0.5 * t * t);
}
// Wyman, Sloan, Shirley 2013, equation 4.
glm::dvec3 observer(double nm) {
  return {0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
              0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
          0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
          1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
}

/// What a wavelength adds to linear Rec.709 red, green and blue, light included; the sums are 1.
const std::vector<glm::dvec3>& sensitivity() {
  static const std::vector<glm::dvec3> weights = [] {
    const glm::dmat3 fromXyz(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560,
                             1.0572252);
    std::vector<glm::dvec3> w;
    glm::dvec3 white(0);
    for (int nm = kFirst; nm <= kLast; nm += kStep) {
      const std::size_t at = std::size_t(nm - kFirst) / 10;
      const double light =
          at + 1 < kD65.size() ? kD65[at] + (kD65[at + 1] - kD65[at]) * double((nm - kFirst) % 10) / 10 : kD65[at];
      w.push_back(fromXyz * (light * observer(nm)));
      white += w.back();
    }
    for (glm::dvec3& one : w) one /= white;
    return w;
  }();
  return weights;
}

OpticalConstants at(const std::vector<OpticalConstants>& table, double nm) {
  const auto above =
      std::find_if(table.begin() + 1, table.end() - 1, [nm](const OpticalConstants& o) { return o.nm >= nm; });
  const OpticalConstants &a = *(above - 1), &b = *above;
  const double t = std::clamp((nm - a.nm) / (b.nm - a.nm), 0.0, 1.0);
  return {nm, a.n + t * (b.n - a.n), a.k + t * (b.k - a.k)};
}

/// Fresnel's equations for n - ik in air, unpolarised.
double fresnel(double n, double k, int degrees) {
  const std::complex<double> index(n, -k);
  const double cosine = std::cos(degrees * M_PI / 180);
  const std::complex<double> inside = std::sqrt(index * index - (1 - cosine * cosine));
  return (std::norm((cosine - inside) / (cosine + inside)) +
          std::norm((index * index * cosine - inside) / (index * index * cosine + inside))) /
         2;
}
double schlick(double f0, int degrees) { return f0 + (1 - f0) * std::pow(1 - std::cos(degrees * M_PI / 180), 5); }
/// ((n-1)² + k²) / ((n+1)² + k²) = F0, held at 0.999, solved for k.
double extinction(double n, double f0) {
  const double f = std::min(f0, 0.999);
  return std::sqrt(std::max(f * (n + 1) * (n + 1) - (n - 1) * (n - 1), 0.0) / (1 - f));
}

/// The reflectance of a channel over the angle.
using Curve = std::array<double, kAngles>;

std::array<Curve, 3> spectralCurves(const Metal& metal) {
  std::array<Curve, 3> curves{};
  for (int degrees = 0; degrees < kAngles; ++degrees) {
    glm::dvec3 color(0);
    for (std::size_t i = 0; i < sensitivity().size(); ++i) {
      const OpticalConstants o = at(metal.constants, kFirst + kStep * double(i));
      color += sensitivity()[i] * fresnel(o.n, o.k, degrees);
    }
    for (int c = 0; c < 3; ++c) curves[std::size_t(c)][std::size_t(degrees)] = std::clamp(color[c], 0.0, 1.0);
  }
  return curves;
}

template <class F>
double largestError(const Curve& curve, F&& reflectance) {
  double worst = 0;
  for (int i = 0; i < kAngles; ++i) worst = std::max(worst, std::abs(reflectance(i) - curve[std::size_t(i)]));
  return worst;
}
double errorOf(const Curve& curve, double n, double f0) {
  const double k = extinction(n, f0);
  return largestError(curve, [&](int degrees) { return fresnel(n, k, degrees); });
}

/// The n whose curve, with the spectrum's own F0, errs least. The error has one minimum (golden section).
double fit(const Curve& curve) {
  const double f0 = std::min(curve[0], 0.999), kPart = (3 - std::sqrt(5.0)) / 2;
  double low = (1 - f0) / (1 + f0), high = std::min((1 + std::sqrt(f0)) / (1 - std::sqrt(f0)), 6.0);
  while (high - low > 1e-5) {
    const double a = low + (high - low) * kPart, b = high - (high - low) * kPart;
    (errorOf(curve, a, f0) < errorOf(curve, b, f0) ? high : low) =
        errorOf(curve, a, f0) < errorOf(curve, b, f0) ? b : a;
  }
  return (low + high) / 2;
}

/// The mean of n over what a channel is sensitive to: the simpler reduction, for comparison.
double meanIndex(const Metal& metal, int channel) {
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < sensitivity().size(); ++i) {
    const double w = std::max(sensitivity()[i][channel], 0.0);
    sum += w * at(metal.constants, kFirst + kStep * double(i)).n;
    weight += w;
  }
  return sum / weight;
}

}  // namespace

TEST_CASE("Every conductor has optical constants to be judged by", "[material]") {
  for (const Substance& s : substances())
    if (s.conductor) {
      INFO(s.name);
      CHECK(std::count_if(kMetals.begin(), kMetals.end(), [&](const Metal& m) { return m.name == s.name; }) == 1);
    }
}

TEST_CASE("Conductors follow from their optical constants", "[material]") {
  for (const Metal& metal : kMetals) {
    INFO(metal.name);
    const Substance* s = findSubstance(metal.name);
    REQUIRE(s);
    const double margin =
        metal.name == "platinum" ? 0.007 : 0.001;  // platinum's f0 is from another table than its n, k
    const auto curves = spectralCurves(metal);
    for (int c = 0; c < 3; ++c) CHECK(double(s->f0[c]) == Approx(curves[std::size_t(c)][0]).margin(margin));
  }
}

TEST_CASE("eta and k give F0 at the normal and the spectrum's reflectance over the angle", "[material]") {
  double worst = 0, worstMean = 0, worstSchlick = 0;
  for (const Metal& metal : kMetals) {
    const Substance& s = *findSubstance(metal.name);
    const auto curves = spectralCurves(metal);
    glm::dvec3 exact(0), mean(0), approximate(0);
    for (int c = 0; c < 3; ++c) {
      INFO(metal.name << ", channel " << c);
      const Curve& curve = curves[std::size_t(c)];
      const double f0 = double(s.f0[c]), n = double(s.eta[c]), k = double(s.k[c]);
      CHECK(fresnel(n, k, 0) == Approx(std::min(f0, 0.999)).margin(1e-6));
      CHECK(n == Approx(fit(curve)).margin(0.001));  // entered with three places
      exact[c] = largestError(curve, [&](int degrees) { return fresnel(n, k, degrees); });
      mean[c] = errorOf(curve, meanIndex(metal, c), f0);
      approximate[c] = largestError(curve, [&](int degrees) { return schlick(f0, degrees); });
      CHECK(exact[c] < 0.0075);
      CHECK(exact[c] < approximate[c]);
    }
    WARN(metal.name << ": eta and k off by at most " << exact.x << ", " << exact.y << ", " << exact.z
                    << " (with the mean of n " << mean.x << ", " << mean.y << ", " << mean.z << "; Schlick "
                    << approximate.x << ", " << approximate.y << ", " << approximate.z << ")");
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, exact[c]);
      worstMean = std::max(worstMean, mean[c]);
      worstSchlick = std::max(worstSchlick, approximate[c]);
    }
  }
  WARN("all conductors, 0 to 89 degrees: eta and k off by at most " << worst << ", with the mean of n " << worstMean
                                                                    << ", Schlick " << worstSchlick);
}
