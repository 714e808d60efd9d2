// What a specular or a diffuse rung cannot pass for given directions, in closed form: its distribution at its highest, times what its visibility and cosine can be at these l and v.
#pragma once
#include <algorithm>
#include <cmath>

#include "text.h"

namespace burnish::test {

/// Highest value of a distribution over all half vectors.
inline double peakOf(int distribution, double alpha) {
  namespace f64 = shading::f64;
  const double a = std::clamp(alpha, 1e-6, 1.0), a2 = a * a;  // BURNISH_GUARD_ALPHA
  if (distribution == DISTRIBUTION_GGX) return 1 / (kPi * a2);
  // (1 + t) exp(-t/2a²) over t = tan², squared, is highest at t = 2a² - 1.
  if (distribution == DISTRIBUTION_BECKMANN) return a2 <= 0.5 ? 1 / (kPi * a2) : 4 * a2 * std::exp(1 / a2 - 2) / kPi;
  return (f64::powerFromAlpha(a) + 2) / (2 * kPi);
}

/// A case of kShading or kMetal in double, with what float's rounding can make of it.
struct Seen {
  shading::f64::Surface m;
  double nol, leastNol, nov, inverse, loh;  ///< at most and at least n·l, at least n·v, at most 1/|l + v|², at least l·h
  double alpha, held;                        ///< as it came, and as distributions and powers take it (BURNISH_GUARD_ALPHA)
};
inline Seen seen(const Case& in, bool metal) {
  namespace f64 = shading::f64;
  const glm::dvec4 a(in[0]), b(in[1]), c(in[2]), d(in[3]), e(in[4]), f(in[5]);
  Seen s{metal ? f64::metalCase(a, c, d, e, f) : f64::tableCase(a, c, d, e, f), 0, 0, 0, 0, 0, a.w, std::clamp(a.w, 1e-6, 1.0)};
  const f64::Angles angles = f64::anglesOf(s.m, glm::dvec3(b));
  // A normal that is bent away from the eye turns with the rounding of what is left of it.
  const double turned = dot(glm::dvec3(a), glm::dvec3(c)) < 1e-6 ? 1e-6 / std::max(glm::length(glm::cross(glm::dvec3(a), glm::dvec3(c))), 1e-9) : 0;
  s.nol = std::clamp(angles.nol + 1e-6 + turned, 0.0, 1.0);
  s.leastNol = std::clamp(angles.nol - 1e-6 - turned, 0.0, 1.0);
  s.nov = std::max(s.m.nov - 1e-6, 0.0);
  s.inverse = 1 / std::max(2 + 2 * angles.lov - 1e-6, 1e-7);  // BURNISH_GUARD_HALF
  s.loh = 0.5 / std::sqrt(s.inverse);
  return s;
}

/// At most V n·l. G <= 1, and G <= 2 G1(v); denominators are held above 1e-12 (BURNISH_GUARD_VISIBILITY).
inline double visibilityCeiling(const Seen& s, int geometry, int distribution) {
  namespace f64 = shading::f64;
  switch (geometry) {
    case GEOMETRY_VOID: return 0.25 * s.nol;
    case GEOMETRY_KELEMEN: return s.nol * s.inverse;
    case GEOMETRY_SCHLICK_SMITH: return std::min(0.25 / std::max(s.nov, s.alpha * (distribution == DISTRIBUTION_GGX ? 0.5 : 0.797)), 0.25e12);
    case GEOMETRY_SMITH:
      if (distribution == DISTRIBUTION_GGX) return std::min(0.5 / std::max(s.nov, s.alpha), 0.5e12);
      return std::min(0.25 / (s.nov + f64::lambdaBeckmann(s.nov, s.alpha)) * (1 + 1.4e-4), 0.25e12);  // Walter's fit of Lambda dips below 0
    default: return std::min(0.25 / std::max(s.nov, 1e-12), 0.5 / s.loh);
  }
}

/// At most specularRung with two widths: D(h) = D(angle; alpha) alpha²/(ax ay) with alpha between them, whether or not the tangents are a frame of the normal.
inline double twoWidthsCeiling(const shading::Rungs& k, const Seen& s) {
  const double widths = std::max(s.m.alphaX, 1e-6) * std::max(s.m.alphaY, 1e-6);
  // Beckmann's peak over 1/(pi alpha²) is at most 4 alpha⁴ exp(1/alpha² - 2), at alpha 1.
  const double peak = (k.specular == SPECULAR_GGX_SMITH || k.distribution == DISTRIBUTION_GGX ? 1 : 4 / std::exp(1.0)) / (kPi * widths) * (1 + 1e-5);
  switch (k.specular) {
    case SPECULAR_WARD_ANISOTROPIC: return 0.25 / (kPi * widths) * (1 + 1e-5) * std::sqrt(s.nol / std::max(s.nov, 1e-4));
    case SPECULAR_WARD_BOUNDED: return peak * s.inverse * s.nol;
    default: return peak * std::min(0.5e12, k.geometry == GEOMETRY_KELEMEN && k.specular == SPECULAR_MICROFACET ? s.nol * s.inverse : 1 / std::max(s.nov, 1e-12));
  }
}

/// At most specularRung of a round lobe.
inline double roundCeiling(const shading::Rungs& k, const Seen& s) {
  namespace f64 = shading::f64;
  const double p = f64::powerFromAlpha(s.held), q = p / 4;
  switch (k.specular) {
    case SPECULAR_PHONG:
    case SPECULAR_BLINN_PHONG: return 1;
    case SPECULAR_MODIFIED_PHONG: return (q + 2) / (2 * kPi) * s.nol;
    case SPECULAR_MAX_PHONG: return (q + 1) / (2 * kPi);
    case SPECULAR_NORMALIZED_BLINN_PHONG: return (p + 8) / (8 * kPi) * s.nol;
    case SPECULAR_COOK_TORRANCE: return peakOf(DISTRIBUTION_BECKMANN, s.held) * visibilityCeiling(s, GEOMETRY_V_CAVITY, DISTRIBUTION_BECKMANN);
    case SPECULAR_WARD:
    case SPECULAR_WARD_ANISOTROPIC: return 0.25 / (kPi * s.held * s.held) * std::sqrt(s.nol / std::max(s.nov, 1e-4));  // BURNISH_GUARD_NOV
    case SPECULAR_WARD_BOUNDED: return peakOf(DISTRIBUTION_BECKMANN, s.held) * s.inverse * s.nol;
    case SPECULAR_GGX_SMITH: return peakOf(DISTRIBUTION_GGX, s.held) * visibilityCeiling(s, GEOMETRY_SMITH, DISTRIBUTION_GGX);
    default: break;
  }
  if (k.geometry == GEOMETRY_VOID && k.distribution == DISTRIBUTION_BLINN_PHONG) return f64::normalizationRung(p, k.normalization) * s.nol;
  return peakOf(k.distribution, s.held) * visibilityCeiling(s, k.geometry, k.distribution);
}

/// At most specularRung. A tangent that is none to float (its part across the normal underflows) leaves the lobe round and narrow.
inline double specularCeiling(const shading::Rungs& k, const Seen& s) {
  if (k.anisotropic == 0 || !hasTwoWidths(k)) return roundCeiling(k, s);
  Seen narrow = s;
  narrow.held = std::max(s.m.alphaY, 1e-6);
  return std::max(roundCeiling(k, narrow), twoWidthsCeiling(k, s));
}

/// At most the rough diffuse functions, per albedo, for cosines l and v. 0.45, 0.125 and 0.17 are the paper's; B <= 0.45, its denominators are held above 1e-4.
inline double roughDiffuseCeiling(int diffuse, double l, double v) {
  const double larger = std::max(std::max(l, v), 1e-4), tan = std::sqrt(1 - std::min(larger, 1.0) * std::min(larger, 1.0)) / larger;
  switch (diffuse) {
    case DIFFUSE_OREN_NAYAR_QUALITATIVE: return (1 + 0.45 * (1 - l * v) / larger) / kPi;
    case DIFFUSE_OREN_NAYAR: return (1 + 0.45 * tan + 0.125 * 2 / std::max(l + v, 1e-4) + 0.34) / kPi;
    case DIFFUSE_OREN_NAYAR_ENERGY: return (1 + (1 - l * v) / larger + 0.4) / kPi;
    default: return 1 / kPi;
  }
}

/// At most diffuseRung, any channel.
inline double diffuseCeiling(const shading::Rungs& k, const Seen& s) {
  double share = 1;
  // (1 - e(v))(1 - e(l))/(1 - mean e): e is never under F0, mean e at most F0 + (1 - F0)/21.
  if (k.diffuse == DIFFUSE_COUPLED_FIT) share = 1.05;
  if (k.diffuse == DIFFUSE_COUPLED || k.diffuse == DIFFUSE_OREN_NAYAR_ENERGY)
    share = 1 / std::max(1 - shading::f64::specularAlbedo(s.m.dielectric, s.m.dfgMean, s.m.dfgMean, k) - 1e-6, 1e-4);  // BURNISH_GUARD_LOSS
  return share * roughDiffuseCeiling(k.diffuse, s.leastNol, s.nov);
}

/// At most shadeDirection.
inline double shadeCeiling(const shading::Rungs& k, const Seen& s, const Case& in) {
  double most = diffuseCeiling(k, s) * s.nol + specularCeiling(k, s);
  // scatteredShare <= 1
  if (k.compensation == COMPENSATION_MULTIPLE_SCATTERING) most += shading::f64::multipleScatteringLobe(s.m.dfg, glm::dvec2(in[4].z, in[4].w), s.m.dfgMean + 1e-6) * s.nol * (1 + 1e-2);
  return most;
}

}  // namespace burnish::test
