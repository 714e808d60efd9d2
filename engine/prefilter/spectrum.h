// Light by wavelength: the sun above the air, what air does to it, and its colour as the eye sees it.
#pragma once
#include <array>
#include <glm/glm.hpp>

namespace burnish::prefilter {

/// Wavelengths that skies are computed at: 380 to 720 nm in steps of 20.
inline constexpr int kBands = 18;
inline constexpr double kBandWidth = 20;  ///< nm
inline constexpr double bandCentre(int band) { return 380 + kBandWidth * band; }
using Spectrum = std::array<double, kBands>;

/// W/m² and nm from the sun above the air on a plane that faces it: a black body of 5772 K (IAU 2015 resolution B3) over the disc's solid angle (Planck's law).
Spectrum sunlightAbove();
/// Angular radius of the sun at its mean distance, radians: 0.2666 degrees.
inline constexpr double kSunRadius = 0.004652;
/// Solid angle of a disc of that radius.
double discSolidAngle(double radius);

/// Scattering of clean air at sea level, 1/m: 1.2406e-6 · (wavelength in µm)^-4 (Penndorf 1957; Bruneton 2017).
Spectrum rayleighScattering();
/// Absorption of ozone, m² a molecule: the Chappuis band, a two-sided bell at 592 nm (60 and 46 nm wide) of 4.9e-25 m² that follows the measurements (Serdyuchenko and others 2014,
/// figures of Bruneton 2017) within some 15 % from 450 to 660 nm.
Spectrum ozoneCrossSection();
/// Vertical optical depth of haze by turbidity T: b · (wavelength in µm)^-1.3 with b = 0.04608 T - 0.04586 (Preetham, Shirley and Smits 1999, appendix A.1), nothing under T = 1.
Spectrum hazeDepth(double turbidity);

/// Linear Rec.709 in photometric units (cd/m² from W/m² sr nm, lux from W/m² nm) of a spectrum: the CIE 1931 observer as sums of Gaussians (Wyman, Sloan and Shirley 2013, "Simple
/// Analytic Approximations to the CIE XYZ Color Matching Functions", table 1), 683 lm/W. Colours outside the primaries' triangle come out with negative parts.
glm::dvec3 rgbOf(const Spectrum& spectrum);

}  // namespace burnish::prefilter
