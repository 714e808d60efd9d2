// The model of Bruneton and Neyret 2008, "Precomputed Atmospheric Scattering", with ozone (Bruneton 2017) and the estimate of multiple scattering of Hillaire 2020, "A Scalable and
// Production Ready Sky and Atmosphere Rendering Technique", section 5.5, summed up on the CPU at kBands wavelengths.
#include "prefilter/atmosphere.h"

#include <algorithm>
#include <cmath>

namespace burnish::prefilter {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kOzoneColumn = 8.07e22;  ///< molecules/m²: 300 Dobson units
constexpr int kColumnHeights = 48, kColumnDirections = 96, kMultipleHeights = 12, kMultipleSuns = 24;
constexpr int kColumnSteps = 96, kMultipleSteps = 20, kRaySteps = 40;

/// Of molecules and haze, by their densities at the ground; ozone, molecules/m³: a tent from 10 to 40 km (Bruneton 2017).
Columns densityAt(double radius) {
  const double h = std::max(radius - Atmosphere::kGround, 0.0);
  return {std::exp(-h / Atmosphere::kAirHeight), std::exp(-h / Atmosphere::kHazeHeight), kOzoneColumn / 15e3 * std::max(1 - std::abs(h - 25e3) / 15e3, 0.0)};
}

double toTop(double r, double cosine) { return std::max(-r * cosine + std::sqrt(std::max(r * r * (cosine * cosine - 1) + Atmosphere::kTop * Atmosphere::kTop, 0.0)), 0.0); }
/// -1: the ground is not met.
double toGround(double r, double cosine) {
  const double d = r * r * (cosine * cosine - 1) + Atmosphere::kGround * Atmosphere::kGround;
  return cosine < 0 && d >= 0 ? std::max(-r * cosine - std::sqrt(d), 0.0) : -1;
}
double horizonCosine(double r) { return -std::sqrt(std::max(1 - Atmosphere::kGround * Atmosphere::kGround / (r * r), 0.0)); }

/// Bilinear in a table of [rows][columns] at positions in [0, rows - 1] and [0, columns - 1]: four indices and weights.
struct Cell {
  std::size_t at[4];
  double weight[4];
};
Cell cellAt(double row, double column, int rows, int columns) {
  const double y = std::clamp(row, 0.0, rows - 1.0), x = std::clamp(column, 0.0, columns - 1.0);
  const int y0 = std::min(int(y), rows - 2), x0 = std::min(int(x), columns - 2);
  const double v = y - y0, u = x - x0;
  const auto index = [&](int j, int i) { return std::size_t(j) * std::size_t(columns) + std::size_t(i); };
  return {{index(y0, x0), index(y0, x0 + 1), index(y0 + 1, x0), index(y0 + 1, x0 + 1)}, {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
}

constexpr double kReach = 1.13331e6;  ///< m: sqrt(kTop² - kGround²), a ray's way from the ground's horizon to space

}  // namespace

Atmosphere::Atmosphere(double turbidity, double groundAlbedo) : air_(rayleighScattering()), haze_(hazeDepth(turbidity)), ozone_(ozoneCrossSection()) {
  for (double& h : haze_) h /= kHazeHeight;
  fillColumns();
  fillMultiple(groundAlbedo);
}

// Rays that miss the ground, laid out as Bruneton and Neyret 2008, section 4: by the distance to the horizon and by the way to space between its least and its most.
void Atmosphere::fillColumns() {
  columns_.resize(std::size_t(kColumnHeights * kColumnDirections));
  for (int j = 0; j < kColumnHeights; ++j)
    for (int i = 0; i < kColumnDirections; ++i) {
      const double rho = kReach * j / (kColumnHeights - 1), r = std::sqrt(rho * rho + kGround * kGround);
      const double least = kTop - r, way = least + (rho + kReach - least) * i / (kColumnDirections - 1);
      const double cosine = way > 0 ? std::clamp((kReach * kReach - rho * rho - way * way) / (2 * r * way), -1.0, 1.0) : 1;
      Columns sum;
      // Dense steps where the ray is low: around its lowest point, which lies ahead where it points down.
      const double lowest = std::clamp(-r * cosine, 0.0, way);
      const auto side = [&](double length, double sign) {
        for (int k = 0; k < kColumnSteps; ++k) {
          const double a = double(k) / kColumnSteps, b = double(k + 1) / kColumnSteps, t = lowest + sign * length * (a * a + b * b) / 2, step = length * (b * b - a * a);
          const Columns d = densityAt(std::sqrt(r * r + t * t + 2 * r * t * cosine));
          sum.air += d.air * step, sum.haze += d.haze * step, sum.ozone += d.ozone * step;
        }
      };
      side(lowest, -1);
      side(way - lowest, 1);
      columns_[std::size_t(j * kColumnDirections + i)] = sum;
    }
}

Columns Atmosphere::columnsToSpace(double r, double cosine) const {
  const double rho = std::sqrt(std::max(r * r - kGround * kGround, 0.0)), least = kTop - r;
  const double way = toTop(r, std::max(cosine, horizonCosine(r)));
  const Cell c = cellAt(rho / kReach * (kColumnHeights - 1), (way - least) / std::max(rho + kReach - least, 1.0) * (kColumnDirections - 1), kColumnHeights, kColumnDirections);
  Columns sum;
  for (int k = 0; k < 4; ++k) {
    const Columns& d = columns_[c.at[k]];
    sum.air += d.air * c.weight[k], sum.haze += d.haze * c.weight[k], sum.ozone += d.ozone * c.weight[k];
  }
  return sum;
}

// A circle cut by a line.
double Atmosphere::discAbove(double height, double sunSine) {
  const double x = std::clamp((std::asin(std::clamp(sunSine, -1.0, 1.0)) - std::asin(horizonSine(height))) / kSunRadius, -1.0, 1.0);
  return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / kPi;
}
double Atmosphere::horizonSine(double height) { return horizonCosine(kGround + height); }

Spectrum Atmosphere::sunAt(double r, double cosine) const {
  Spectrum s{};
  const double above = discAbove(r - kGround, cosine);
  if (above <= 0) return s;
  const Columns c = columnsToSpace(r, cosine);
  for (std::size_t i = 0; i < kBands; ++i) s[i] = above * std::exp(-(air_[i] * c.air + haze_[i] * c.haze + ozone_[i] * c.ozone));
  return s;
}

// more(radius, cosine of the sun): light of further scatterings, from all around, that arrives there.
template <class More>
RayLight Atmosphere::integrate(double radius, double up, double cosSun, double sunCosine, int steps, More&& more) const {
  RayLight out;
  out.through.fill(1);
  const double ground = toGround(radius, up), length = ground >= 0 ? ground : toTop(radius, up);
  out.ground = ground >= 0;
  for (int k = 0; k < steps; ++k) {
    const double a = double(k) / steps, b = double(k + 1) / steps, t = length * (a * a + b * b) / 2, step = length * (b * b - a * a);
    const double r = std::clamp(std::sqrt(radius * radius + t * t + 2 * radius * t * up), kGround, kTop), sun = std::clamp((radius * sunCosine + t * cosSun) / r, -1.0, 1.0);
    const Columns d = densityAt(r);
    const Spectrum light = sunAt(r, sun), further = more(r, sun);
    for (std::size_t i = 0; i < kBands; ++i) {
      const double air = air_[i] * d.air, haze = haze_[i] * d.haze, taken = air + haze + ozone_[i] * d.ozone;
      // The step's source over its own extinction (Hillaire 2020, section 5.4).
      const double left = std::exp(-taken * step), weight = taken > 1e-30 ? out.through[i] * (1 - left) / taken : out.through[i] * step;
      out.air[i] += weight * air * light[i];
      out.haze[i] += weight * haze * kHazeAlbedo * light[i];
      out.multiple[i] += weight * (air + haze * kHazeAlbedo) * further[i];
      out.through[i] *= left;
    }
  }
  return out;
}

// Hillaire 2020, eqs. 5 to 9: second-order light from all around over one less the share that is scattered again.
void Atmosphere::fillMultiple(double groundAlbedo) {
  constexpr double kCosines[] = {-0.9324695142, -0.6612093865, -0.2386191861, 0.2386191861, 0.6612093865, 0.9324695142};  // Gauss and Legendre, 6 nodes
  constexpr double kWeights[] = {0.1713244924, 0.3607615730, 0.4679139346, 0.4679139346, 0.3607615730, 0.1713244924};
  constexpr int kAzimuths = 4;
  multiple_.resize(std::size_t(kMultipleHeights * kMultipleSuns));
  Spectrum one;
  one.fill(1);
  for (int j = 0; j < kMultipleHeights; ++j)
    for (int i = 0; i < kMultipleSuns; ++i) {
      const double q = double(j) / (kMultipleHeights - 1), r = kGround + (kTop - kGround) * q * q, x = -0.5 + 1.5 * i / (kMultipleSuns - 1), sun = x * std::abs(x);
      Spectrum second{}, again{};
      for (int p = 0; p < 6; ++p)
        for (int a = 0; a < kAzimuths; ++a) {
          const double up = kCosines[p], away = std::sqrt((1 - up * up) * (1 - sun * sun)) * std::cos(kPi * (a + 0.5) / kAzimuths), weight = kWeights[p] / 2 / kAzimuths, cosSun = up * sun + away;
          const RayLight ray = integrate(r, up, cosSun, sun, kMultipleSteps, [&](double, double) { return one; });
          Spectrum floor{};
          if (ray.ground) {
            const double ground = std::clamp((r * sun + toGround(r, up) * cosSun) / kGround, 0.0, 1.0);
            floor = sunAt(kGround, ground);
            for (double& f : floor) f *= groundAlbedo * ground / kPi;
          }
          for (std::size_t k = 0; k < kBands; ++k) {
            second[k] += weight * ((ray.air[k] + ray.haze[k]) / (4 * kPi) + ray.through[k] * floor[k]);
            again[k] += weight * ray.multiple[k];
          }
        }
      Spectrum& s = multiple_[std::size_t(j * kMultipleSuns + i)];
      for (std::size_t k = 0; k < kBands; ++k) s[k] = second[k] / (1 - again[k]);
    }
}

Spectrum Atmosphere::multipleAt(double r, double cosine) const {
  const double x = cosine < 0 ? -std::sqrt(-cosine) : std::sqrt(cosine);
  const Cell c = cellAt(std::sqrt(std::max((r - kGround) / (kTop - kGround), 0.0)) * (kMultipleHeights - 1), (x + 0.5) / 1.5 * (kMultipleSuns - 1), kMultipleHeights, kMultipleSuns);
  Spectrum s{};
  for (int k = 0; k < 4; ++k)
    for (std::size_t i = 0; i < kBands; ++i) s[i] += multiple_[c.at[k]][i] * c.weight[k];
  return s;
}

RayLight Atmosphere::alongRay(double height, double up, double cosSun, double sunSine) const {
  return integrate(kGround + height, up, cosSun, sunSine, kRaySteps, [this](double r, double sun) { return multipleAt(r, sun); });
}

}  // namespace burnish::prefilter
