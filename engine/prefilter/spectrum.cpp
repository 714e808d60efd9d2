#include "prefilter/spectrum.h"

#include <algorithm>
#include <cmath>

namespace burnish::prefilter {
namespace {

constexpr double kPi = 3.14159265358979323846;

template <class F>
Spectrum bands(F&& f) {
  Spectrum s;
  for (int i = 0; i < kBands; ++i) s[std::size_t(i)] = f(bandCentre(i));
  return s;
}

/// exp(-t²/2) with another width to either side of the centre.
double bell(double x, double centre, double left, double right) {
  const double t = (x - centre) * (x < centre ? left : right);
  return std::exp(-0.5 * t * t);
}
glm::dvec3 observer(double nm) {
  const double x = 0.362 * bell(nm, 442.0, 0.0624, 0.0374) + 1.056 * bell(nm, 599.8, 0.0264, 0.0323) - 0.065 * bell(nm, 501.1, 0.0490, 0.0382);
  const double y = 0.821 * bell(nm, 568.8, 0.0213, 0.0247) + 0.286 * bell(nm, 530.9, 0.0613, 0.0322);
  const double z = 1.217 * bell(nm, 437.0, 0.0845, 0.0278) + 0.681 * bell(nm, 459.0, 0.0385, 0.0725);
  return {x, y, z};
}

}  // namespace

double discSolidAngle(double radius) { return kPi * std::sin(radius) * std::sin(radius); }

Spectrum sunlightAbove() {
  constexpr double kTemperature = 5772, kPlanck = 6.62607015e-34, kLight = 299792458, kBoltzmann = 1.380649e-23;
  return bands([](double nm) {
    const double l = nm * 1e-9, radiance = 2 * kPlanck * kLight * kLight / (std::pow(l, 5) * std::expm1(kPlanck * kLight / (l * kBoltzmann * kTemperature)));
    return radiance * 1e-9 * discSolidAngle(kSunRadius);
  });
}

Spectrum rayleighScattering() {
  return bands([](double nm) { return 1.2406e-6 * std::pow(nm * 1e-3, -4); });
}
Spectrum ozoneCrossSection() {
  return bands([](double nm) { return 4.9e-25 * bell(nm, 592, 1 / 60.0, 1 / 46.0); });
}
Spectrum hazeDepth(double turbidity) {
  const double b = std::max(0.04608 * turbidity - 0.04586, 0.0);
  return bands([b](double nm) { return b * std::pow(nm * 1e-3, -1.3); });
}

glm::dvec3 rgbOf(const Spectrum& s) {
  glm::dvec3 xyz(0);
  for (int i = 0; i < kBands; ++i) xyz += observer(bandCentre(i)) * s[std::size_t(i)];
  xyz *= 683 * kBandWidth;
  // IEC 61966-2-1.
  return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z, -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z, 0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

}  // namespace burnish::prefilter
