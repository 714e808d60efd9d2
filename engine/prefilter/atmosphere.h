// Light in the air of a round Earth, by wavelength: molecules, haze and ozone. One scattering along the way is summed up; all further ones are Hillaire's estimate.
#pragma once
#include <vector>

#include "prefilter/spectrum.h"

namespace burnish::prefilter {

/// Metres of air at the ground's density (molecules, haze) that hold as much as lies along a way; molecules of ozone per m².
struct Columns {
  double air = 0, haze = 0, ozone = 0;
};

/// What comes to the eye along a ray, for sunlight of 1 above the air: light that molecules or haze scattered once, for a phase function of 1; light that was scattered more often;
/// and the share that is left of light from the ray's end.
struct RayLight {
  Spectrum air{}, haze{}, multiple{}, through{};
  bool ground = false;  ///< the ray ends on the ground
};

class Atmosphere {
 public:
  /// turbidity: 1 to 10; groundAlbedo: 0 to 1, of the ground that light comes back from.
  Atmosphere(double turbidity, double groundAlbedo);

  static constexpr double kGround = 6360e3, kTop = 6460e3;        ///< m from the Earth's centre
  static constexpr double kAirHeight = 8000, kHazeHeight = 1200;  ///< m in which they thin by e
  static constexpr double kHazeMeanCosine = 0.76, kHazeAlbedo = 0.92;

  /// Share of the sun's light that arrives `height` m above the ground, the sun at an elevation of that sine there. Its disc sets gradually.
  [[nodiscard]] Spectrum sunThrough(double height, double sunSine) const { return sunAt(kGround + height, sunSine); }
  /// Share of the sun's disc above the horizon, and the sine of the horizon's elevation, `height` m above the ground. Rays are straight: the sun is not lifted by refraction.
  static double discAbove(double height, double sunSine);
  static double horizonSine(double height);
  /// From the eye `height` m above the ground. up: sine of the ray's elevation; cosSun: cosine between ray and sun; sunSine: as above.
  [[nodiscard]] RayLight alongRay(double height, double up, double cosSun, double sunSine) const;

 private:
  template <class More>
  RayLight integrate(double radius, double up, double cosSun, double sunCosine, int steps, More&& more) const;
  [[nodiscard]] Columns columnsToSpace(double radius, double cosine) const;
  [[nodiscard]] Spectrum sunAt(double radius, double cosine) const;
  [[nodiscard]] Spectrum multipleAt(double radius, double cosine) const;
  void fillColumns();
  void fillMultiple(double groundAlbedo);

  Spectrum air_{}, haze_{}, ozone_{};  ///< extinction: 1/m at the ground, 1/m at the ground, m²
  std::vector<Columns> columns_;       ///< to space, by height and direction
  std::vector<Spectrum> multiple_;     ///< light of further scatterings that arrives from all around, by height and the sun's cosine
};

}  // namespace burnish::prefilter
