#include "prefilter/sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "prefilter/atmosphere.h"
#include "reference/shading.h"

namespace burnish::prefilter {
namespace {

using glm::dvec3;

constexpr double kPi = 3.14159265358979323846;
constexpr int kElevations = 96, kAzimuths = 33;  ///< rows from nadir to zenith, dense at the horizon; columns from the sun's azimuth to the opposite one

/// Half rows are below the horizon; e = ±(pi/2) q² (Hillaire 2020, section 5.3).
double elevationOf(double row) {
  const double q = 2 * row / (kElevations - 1) - 1;
  return 0.5 * kPi * q * std::abs(q);
}
double rowOf(double elevation) {
  const double q = std::sqrt(std::abs(elevation) / (0.5 * kPi));
  return 0.5 * (1 + (elevation < 0 ? -q : q)) * (kElevations - 1);
}

/// The three kinds of light of RayLight in Rec.709, cd/m² once the first two have met their phase functions.
struct Kinds {
  dvec3 air{0}, haze{0}, multiple{0};
};
Spectrum times(const Spectrum& a, const Spectrum& b) {
  Spectrum s;
  for (std::size_t i = 0; i < kBands; ++i) s[i] = a[i] * b[i];
  return s;
}

double airPhase(double c) { return 3 / (16 * kPi) * (1 + c * c); }  // Rayleigh's
dvec3 shown(const Kinds& k, double cosSun) { return k.air * airPhase(cosSun) + k.haze * shading::f64::phaseHenyeyGreenstein(cosSun, Atmosphere::kHazeMeanCosine) + k.multiple; }

class Table {
 public:
  explicit Table(const SkyModel& m) : model_(m), sine_(std::clamp(double(m.toSun.y), -1.0, 1.0)), air_(m.turbidity, glm::dot(dvec3(m.ground), dvec3(0.2126, 0.7152, 0.0722))), above_(sunlightAbove()) {
    for (int j = kElevations / 2; j < kElevations; ++j) fillRow(j);
    sumSky();
    for (int j = 0; j < kElevations / 2; ++j) fillRow(j);
  }
  [[nodiscard]] Kinds at(double elevation, double azimuth) const {
    const double y = std::clamp(rowOf(elevation), 0.0, kElevations - 1.0), x = std::clamp(azimuth / kPi * (kAzimuths - 1), 0.0, kAzimuths - 1.0);
    // Rows of one side of the horizon alone: the ground begins there.
    const int first = elevation < 0 ? 0 : kElevations / 2, last = elevation < 0 ? kElevations / 2 - 1 : kElevations - 1;
    const int y0 = std::clamp(int(y), first, last), y1 = std::min(y0 + 1, last), x0 = std::min(int(x), kAzimuths - 2);
    const double v = std::clamp(y - y0, 0.0, 1.0), u = x - x0;
    const auto mix = [&](auto member) {
      const auto one = [&](int j, int i) { return kinds_[std::size_t(j * kAzimuths + i)].*member; };
      return (one(y0, x0) * (1 - u) + one(y0, x0 + 1) * u) * (1 - v) + (one(y1, x0) * (1 - u) + one(y1, x0 + 1) * u) * v;
    };
    return {mix(&Kinds::air), mix(&Kinds::haze), mix(&Kinds::multiple)};
  }
  [[nodiscard]] double cosSun(double elevation, double azimuth) const {
    return std::clamp(std::sin(elevation) * sine_ + std::cos(elevation) * std::sqrt(1 - sine_ * sine_) * std::cos(azimuth), -1.0, 1.0);
  }
  [[nodiscard]] const dvec3& skyIlluminance() const { return sky_; }
  [[nodiscard]] dvec3 sunIlluminance() const { return glm::max(rgbOf(times(air_.sunThrough(model_.altitude, sine_), above_)), dvec3(0)); }

 private:
  void fillRow(int j) {
    const double elevation = elevationOf(j);
    for (int i = 0; i < kAzimuths; ++i) {
      const double c = cosSun(elevation, kPi * i / (kAzimuths - 1));
      const RayLight ray = air_.alongRay(model_.altitude, std::sin(elevation), c, sine_);
      Kinds& k = kinds_[std::size_t(j * kAzimuths + i)];
      k = {rgbOf(times(ray.air, above_)), rgbOf(times(ray.haze, above_)), rgbOf(times(ray.multiple, above_))};
      if (!ray.ground) continue;
      // The ground, level and dull, under sun and sky, through the air before it.
      Spectrum lit = times(times(air_.sunThrough(0, sine_), above_), ray.through);
      const dvec3 sun = rgbOf(lit) * std::max(sine_, 0.0), veil = rgbOf(times(above_, ray.through)) / glm::max(rgbOf(above_), dvec3(1e-9));
      k.multiple += dvec3(model_.ground) / kPi * (sun + sky_ * veil);
    }
  }
  // Illuminance of the upper half on level ground.
  void sumSky() {
    constexpr int kRings = 90, kSteps = 64;
    for (int j = 0; j < kRings; ++j)
      for (int i = 0; i < kSteps; ++i) {
        const double e = 0.5 * kPi * (j + 0.5) / kRings, a = kPi * (i + 0.5) / kSteps;
        sky_ += glm::max(shown(at(e, a), cosSun(e, a)), dvec3(0)) * (std::sin(e) * std::cos(e) * (0.5 * kPi / kRings) * (2 * kPi / kSteps));
      }
  }

  SkyModel model_;
  double sine_;
  Atmosphere air_;
  Spectrum above_;
  dvec3 sky_{0};
  std::vector<Kinds> kinds_ = std::vector<Kinds>(std::size_t(kElevations * kAzimuths));
};

}  // namespace

SkyPicture skyPicture(const SkyModel& model, int width) {
  const Table table(model);
  const int height = width / 2;
  SkyPicture out;
  out.map = makeImage(width, height, 3, PixelType::F32);
  const double sunAzimuth = std::atan2(double(model.toSun.x), -double(model.toSun.z));
  float* to = out.map.f32();
  for (int y = 0; y < height; ++y) {
    const double elevation = kPi * (0.5 - (y + 0.5) / height);
    for (int x = 0; x < width; ++x) {
      // The centre column looks along -Z, columns grow toward +X.
      double azimuth = std::abs(std::remainder(2 * kPi * ((x + 0.5) / width - 0.5) - sunAzimuth, 2 * kPi));
      const dvec3 c = glm::max(shown(table.at(elevation, azimuth), table.cosSun(elevation, azimuth)), dvec3(0));
      for (int k = 0; k < 3; ++k) *to++ = float(c[k]);
    }
  }
  out.sunIlluminance = table.sunIlluminance();
  const double shown = Atmosphere::discAbove(model.altitude, double(model.toSun.y));
  if (shown > 0) out.sunRadiance = out.sunIlluminance / (discSolidAngle(kSunRadius) * shown);
  out.horizon = Atmosphere::horizonSine(model.altitude);
  out.skyIlluminance = table.skyIlluminance();
  return out;
}

}  // namespace burnish::prefilter
