// Diffuse light of an environment.
#pragma once
#include <burnish/image.h>

#include <array>
#include <glm/glm.hpp>

#include "prefilter/source.h"

namespace burnish::prefilter {

/// Irradiance / π as nine coefficients without their basis' constants (irradianceSh of shaders/shading/environment.h). Exact sums over the texels in double.
using IrradianceSh = std::array<glm::dvec3, 9>;
IrradianceSh irradianceOf(const CubeLevel& cube, int threads = 1);
IrradianceSh irradianceOf(const Image& latLong, int threads = 1);
/// At a unit vector.
glm::dvec3 irradianceAt(const IrradianceSh& sh, const glm::dvec3& n);

/// Two bands ring: a lone sun's irradiance is below zero on the far side. Scales bands 1 and 2 by 1/(1 + λ l² (l + 1)²) with the least λ that leaves no direction negative (Sloan 2008,
/// "Stupid Spherical Harmonics (SH) Tricks", windowing; for all channels together, so that hues stay). Nothing changes where nothing is negative. Returns λ.
double deRing(IrradianceSh& sh);

/// Irradiance / π on a small cube: what a cosine lobe makes of the source, error as in filterLevels().
CubeLevel irradianceCube(const Source& source, int size, double error = 1e-4, int threads = 1);

}  // namespace burnish::prefilter
