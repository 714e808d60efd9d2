// The lobes that levels are filtered with, and how their integral is split into spherical-harmonic bands and a sum over texels nearby.
#pragma once
#include <burnish/image.h>

#include <array>
#include <vector>

namespace burnish::prefilter {

/// A lobe about the mirrored direction at n = v = R (docs/shading.md, section 5), over its peak, as a function of x = 1 - l·R.
struct Lobe {
  ReflectionLobe shape = ReflectionLobe::BlinnPhong;
  double alpha2 = 1;  ///< r⁴
  double power = 0;   ///< Blinn-Phong's p of that width

  /// roughness in (0, 1].
  static Lobe of(ReflectionLobe shape, double roughness);
  /// Blinn-Phong: (1 - x/2)^(p/2) (1 - x). GGX: D (n·h) (1 - x) with (n·h)² = 1 - x/2. 1 at x = 0; 0 from x = 1 on.
  [[nodiscard]] double operator()(double x) const;
  /// The angle (radians) over which it falls.
  [[nodiscard]] double width() const;
};

/// A lobe as the sum of a smooth part, b_l in bands, and a rest that is zero beyond x = end, summed directly over texels. The smooth part is the lobe itself from `end` on and, nearer, its
/// Taylor polynomial at `end` (the near-field regularization of Potts and Steidl 2003, "Fast summation at nonequispaced knots by NFFTs", with one point in place of two: on a sphere the
/// pole needs no care).
struct Split {
  static constexpr int kDegree = 6;
  double end = 0;                         ///< 0: nothing is summed directly
  bool taylor = false;                    ///< the rest is the lobe less the polynomial c of x - end; else the lobe itself, which is the polynomial c of x to the power 16, cut where it is negligible
  std::array<double, kDegree + 1> c{};
  std::vector<double> far;                ///< b_0 to b_bands; empty: all is summed directly
  [[nodiscard]] int bands() const { return far.empty() ? 0 : int(far.size()) - 1; }
};

/// The cheapest split whose bands leave out at most a small part of `error` (relative rms). `texels`: of the source; `outputs`: of the level.
Split splitLobe(const Lobe& lobe, double error, double texels, double outputs);

}  // namespace burnish::prefilter
