// The oracle: surfaces shaded in double from the shading text, with directional albedos by quadrature where the renderer reads a table. What every picture and every rung is
// measured against.
#pragma once
#include <span>

#include "reference/energy.h"
#include "reference/quadrature.h"

namespace burnish::reference {

/// A surface as materials describe it; world space, unit vectors.
struct OracleSurface {
  glm::dvec3 n{0, 0, 1}, v{0, 0, 1};
  glm::dvec3 albedo{0.5};
  double substance = 1.0 / 3;       ///< code
  double alpha = 0.25;              ///< (0, 1]
  glm::dvec3 eta{0}, k{0};          ///< named conductors
  glm::dvec3 tangent{0};            ///< with anisotropy
  double anisotropy = 0;
  double sigma = 0;                 ///< of diffuse, radians; 0: by the rung
};
struct OracleLight {
  glm::dvec3 toLight{0, 0, 1};      ///< unit
  glm::dvec3 irradiance{1};         ///< on a plane that faces the light
};

/// The shading text's surface. `energy`: of these rungs and this alpha; needed where needsAlbedoTable(rungs).
shading::f64::Surface surfaceOf(const OracleSurface& surface, const LobeEnergy* energy);
/// Reflected radiance toward v under the lights.
glm::dvec3 shade(const OracleSurface& surface, std::span<const OracleLight> lights, const shading::Rungs& rungs);

/// ∫ of the reflected radiance under unit radiance from everywhere: what a white furnace shows. `known`: the energy of these rungs and this alpha, for callers who ask often.
struct DirectionalAlbedo {
  glm::dvec3 diffuse{0}, specular{0};  ///< specular: multiple scattering included
};
DirectionalAlbedo directionalAlbedo(const OracleSurface& surface, const shading::Rungs& rungs, const Resolution& resolution = {}, const LobeEnergy* known = nullptr);

}  // namespace burnish::reference
