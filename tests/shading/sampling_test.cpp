// Importance sampling against the densities: chi-square over bins of polar angle and azimuth, in float and in double;
// albedos by sampling against quadrature.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

#include "sphere.h"
#include "test_rungs.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
namespace f32 = burnish::shading::f32;
namespace f64 = burnish::shading::f64;

namespace {

/// Probability of a chi-square as large or larger (upper incomplete gamma function: series, or Lentz's continued
/// fraction; Numerical Recipes, section 6.2).
double chiSquareTail(double chi2, int freedom) {
  const double a = 0.5 * freedom, x = 0.5 * chi2, front = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10'000 && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
    return 1 - front * sum;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int i = 1; i < 10'000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return front * h;
}

constexpr int kRings = 32, kSectors = 16;

/// Bins: tan² = width² x/(1 - x) with x in 32 equal steps, azimuth in 16. They know nothing of the sampler.
struct Bins {
  std::vector<double> expected = std::vector<double>(kRings * kSectors), seen = std::vector<double>(kRings * kSectors);
  double width, total = 0;

  /// density: per solid angle, of (sin², azimuth).
  Bins(double w, const std::function<double(double, double)>& density) : width(w) {
    const reference::GaussRule rule(24), turn(12);
    for (int ring = 0; ring < kRings; ++ring)
      for (std::size_t i = 0; i < rule.node.size(); ++i) {
        // Dense toward the upper end: at the horizon the jacobian is infinite.
        const double rest = 1 - rule.node[i], x = (ring + 1 - rest * rest) / kRings, w2 = width * width,
                     d = 1 - x + w2 * x, c = std::sqrt((1 - x) / d);
        const double jacobian = w2 / (2 * c * d * d) * rule.weight[i] * 2 * rest / kRings;  // sin θ dθ
        for (int sector = 0; sector < kSectors; ++sector)
          for (std::size_t j = 0; j < turn.node.size(); ++j)
            expected[std::size_t(ring * kSectors + sector)] +=
                density(w2 * x / d, 2 * kPi * (sector + turn.node[j]) / kSectors) * jacobian * turn.weight[j] * 2 *
                kPi / kSectors;
      }
    for (double e : expected) total += e;
  }
  void add(const dvec3& h) {
    const double t2 = (h.x * h.x + h.y * h.y) / std::max(h.z * h.z, 1e-300),
                 x = t2 > 1e290 ? 1 : t2 / (width * width + t2);
    const double phi = std::atan2(h.y, h.x) / (2 * kPi);
    const int ring = std::min(int(x * kRings), kRings - 1),
              sector = std::min(int((phi < 0 ? phi + 1 : phi) * kSectors), kSectors - 1);
    ++seen[std::size_t(ring * kSectors + sector)];
  }
  /// Bins with few counts share one.
  [[nodiscard]] double pValue(int count) const {
    double chi2 = 0, restExpected = 0, restSeen = 0;
    int bins = 0;
    const auto note = [&](double e, double s) { chi2 += (s - e) * (s - e) / e, ++bins; };
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double e = expected[i] * count;
      if (e >= 10)
        note(e, seen[i]);
      else
        restExpected += e, restSeen += seen[i];
    }
    if (restExpected >= 5)
      note(restExpected, restSeen);
    else if (restSeen > restExpected + 10 * std::sqrt(restExpected) + 10)
      return 0;
    return chiSquareTail(chi2, bins - 1);
  }
};

constexpr int kCount = 200'000;
constexpr int kTests = 80;  // about as many as there are: Bonferroni

double smallest = 1;
unsigned seed = 0;
/// sample(u, w) → direction, as double. Each call has numbers of its own.
template <class Sample>
void checkSampler(Bins& bins, const Sample& sample) {
  CHECK(bins.total == Approx(1).epsilon(2e-4));
  std::mt19937_64 random(31 + seed++);
  std::uniform_real_distribution<double> uniform(0, 1);
  double length = 0;
  for (int i = 0; i < kCount; ++i) {
    const double u = uniform(random), w = uniform(random);
    const dvec3 h = sample(u, w);
    length = std::max(length, std::abs(glm::length(h) - 1));
    bins.add(h);
  }
  const double p = bins.pValue(kCount);
  smallest = std::min(smallest, p);
  CHECK(p > 0.01 / kTests);
  CHECK(length < 1e-6);
}

}  // namespace

TEST_CASE("sampling: the chi-square test itself") {
  // Abramowitz and Stegun, table 26.8.
  CHECK(chiSquareTail(18.307, 10) == Approx(0.05).epsilon(1e-3));
  CHECK(chiSquareTail(149.449, 100) == Approx(0.001).epsilon(1e-2));
  CHECK(chiSquareTail(3.9403, 10) == Approx(0.95).epsilon(1e-3));
  // It tells a lobe 2 % wider from the right one.
  Bins bins(0.1, [](double sin2, double) { return f64::lobeDensity(sin2, 0.102, LOBE_FAMILY_GGX); });
  std::mt19937_64 random(32);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < kCount; ++i) {
    const double u = uniform(random);
    bins.add(f64::sampleLobe(u, uniform(random), 0.1, LOBE_FAMILY_GGX));
  }
  CHECK(bins.pValue(kCount) < 0.01 / kTests);
}

TEST_CASE("sampling: each family of lobes against its density") {
  smallest = 1, seed = 0;
  for (int family = LOBE_FAMILY_BLINN_PHONG; family <= LOBE_FAMILY_PHONG; ++family)
    for (const double alpha : {4e-4, 0.01, 0.1, 0.3, 0.7, 1.0}) {
      CAPTURE(family, alpha);
      // Phong's angle is the mirrored direction's: twice the half vector's.
      const double width = alpha * (family == LOBE_FAMILY_PHONG ? 2 : 1);
      Bins inDouble(width, [&](double sin2, double) { return f64::lobeDensity(sin2, alpha, family); });
      checkSampler(inDouble, [&](double u, double w) { return f64::sampleLobe(u, w, alpha, family); });
      Bins inFloat(width,
                   [&](double sin2, double) { return double(f32::lobeDensity(float(sin2), float(alpha), family)); });
      checkSampler(inFloat, [&](double u, double w) {
        return dvec3(f32::sampleLobe(float(u), float(w), float(alpha), family));
      });
    }
  WARN("sampling, lobes: smallest p-value " << smallest << " of 48");
}

TEST_CASE("sampling: two widths, and the diffuse lobe") {
  smallest = 1, seed = 1000;
  for (const double ax : {0.001, 0.1, 0.5, 1.0})
    for (const double ratio : {0.25, 0.8}) {
      const double ay = ax * ratio;
      CAPTURE(ax, ay);
      for (int family = LOBE_FAMILY_BLINN_PHONG; family < LOBE_FAMILY_PHONG; ++family) {
        CAPTURE(family);
        const auto density = [&](double sin2, double phi) {
          const double s = std::sqrt(sin2);
          return f64::twoWidthsDensity({s * std::cos(phi), s * std::sin(phi), std::sqrt(1 - sin2)}, ax, ay, family);
        };
        Bins inDouble(std::sqrt(ax * ay), density), inFloat = inDouble;
        checkSampler(inDouble, [&](double u, double w) { return f64::sampleTwoWidths(u, w, ax, ay, family); });
        checkSampler(inFloat, [&](double u, double w) {
          return dvec3(f32::sampleTwoWidths(float(u), float(w), float(ax), float(ay), family));
        });
      }
    }
  Bins cosine(1, [](double sin2, double) { return f64::cosineDensity(std::sqrt(1 - sin2)); }), cosineFloat = cosine;
  checkSampler(cosine, [](double u, double w) { return f64::sampleCosine(u, w); });
  checkSampler(cosineFloat, [](double u, double w) { return dvec3(f32::sampleCosine(float(u), float(w))); });
  WARN("sampling, two widths and cosine: smallest p-value " << smallest << " of 50");
}

TEST_CASE("sampling: ends of the random numbers give unit vectors in the upper hemisphere") {
  for (const float u : {0.0f, 1e-30f, 2.9802322e-8f, 0.5f, 0.99999994f, 1.0f})
    for (const float w : {0.0f, 0.5f, 0.99999994f})
      for (const float alpha : {0.0f, 4e-4f, 0.3f, 1.0f}) {
        for (int family = LOBE_FAMILY_BLINN_PHONG; family <= LOBE_FAMILY_PHONG; ++family) {
          const glm::vec3 h = f32::sampleLobe(u, w, alpha, family);
          CAPTURE(u, w, alpha, family);
          CHECK(glm::length(h) == Approx(1).epsilon(1e-6));
          CHECK(h.z >= 0);
          CHECK(std::isfinite(f32::lobeDensity(h.x * h.x + h.y * h.y, alpha, family)));
        }
        for (int family = LOBE_FAMILY_BLINN_PHONG; family < LOBE_FAMILY_PHONG; ++family)
          CHECK(glm::length(f32::sampleTwoWidths(u, w, alpha, 1, family)) == Approx(1).epsilon(1e-6));
        CHECK(glm::length(f32::sampleCosine(u, w)) == Approx(1).epsilon(1e-6));
      }
}

TEST_CASE("sampling: frames around a vector, radical inverse") {
  std::mt19937_64 random(33);
  for (int i = 0; i < 2000; ++i) {
    const dvec3 n = i == 0 ? dvec3(0, 0, 1) : i == 1 ? dvec3(0, 0, -1) : randomUnit(random);
    dvec3 t, b;
    f64::basisFrom(n, t, b);
    CHECK(glm::length(cross(t, b) - n) < 1e-12);
    CHECK(std::abs(glm::length(t) - 1) < 1e-12);
    CHECK(std::abs(dot(t, n)) < 1e-12);
  }
  CHECK(f64::radicalInverse(0) == 0);
  CHECK(f64::radicalInverse(1) == 0.5);
  CHECK(f64::radicalInverse(6) == 0.375);  // 110 → .011
  CHECK(f32::radicalInverse(0xffffff) == 1 - std::ldexp(1.0f, -24));
}

TEST_CASE("sampling: albedos by sampling agree with quadrature") {
  double worst = 0;
  for (const shading::Rungs& k : specularRungs())
    for (const double alpha : {0.05, 0.4, 1.0})
      for (const double nov : {0.3, 0.9}) {
        const int family = lobeFamily(k);
        const f64::Surface m = f64::makeSurface({0, 0, 1}, viewAt(nov), dvec3(1), 1, alpha);
        const dvec3 mirrored(-m.v.x, -m.v.y, m.v.z);
        dvec3 t, b;
        f64::basisFrom(mirrored, t, b);
        double sum = 0, sum2 = 0;
        constexpr int kSamples = 20'000;
        std::mt19937_64 random(34);
        std::uniform_real_distribution<double> uniform(0, 1);
        for (int i = 0; i < kSamples; ++i) {
          const double u = uniform(random), w = uniform(random);
          const dvec3 h = f64::sampleLobe(u, w, alpha, family);
          const double density = f64::lobeDensity(h.x * h.x + h.y * h.y, alpha, family);
          const bool phong = family == LOBE_FAMILY_PHONG;
          const dvec3 l = phong ? t * h.x + b * h.y + mirrored * h.z : h * (2 * dot(m.v, h)) - m.v;
          const double pdf = phong ? density : density / (4 * dot(m.v, h));
          const double value = l.z > 0 && pdf > 0 ? f64::specularRung(m, f64::anglesOf(m, l), k) / pdf : 0;
          sum += value / kSamples;
          sum2 += value * value / kSamples;
        }
        const glm::dvec2 truth = reference::lobeAlbedo(k, nov, alpha);
        const double deviation = std::sqrt(std::max(sum2 - sum * sum, 0.0) / kSamples) + 2e-4 * sum,
                     sigmas = std::abs(sum - truth.x - truth.y) / deviation;
        worst = std::max(worst, sigmas);
        CAPTURE(nameOf(k), alpha, nov, sum, truth.x + truth.y);
        CHECK(sigmas < 5);
      }
  WARN("sampling, albedos: at most " << worst << " standard deviations from quadrature");
}
