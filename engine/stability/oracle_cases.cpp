// The hard cases of tables and of the oracle itself.
#include <fmt/format.h>

#include <cmath>

#include "plan/rungs.h"
#include "prefilter/dfg.h"
#include "reference/energy.h"
#include "reference/oracle.h"
#include "stability/cases.h"

namespace burnish::stability {
namespace {

// H13: albedo 1, every substance from gem to metal, every roughness and angle.
Finding furnace(const char* preset) {
  Quality quality;
  (void)setPreset(quality, preset);
  const shading::Rungs k = plan::rungsOf(quality);
  Finding worst;
  for (const double substance : {0.0, 1.0 / 3, 0.4, 0.45, 0.55, 0.7, 0.85, 1.0})
    for (const double r : {0.02, 0.1, 0.3, 0.6, 1.0})
      for (const double nov : {0.02, 0.1, 0.3, 0.6, 1.0}) {
        reference::OracleSurface s;
        s.albedo = glm::dvec3(1);
        s.substance = substance;
        s.alpha = r * r;
        s.v = reference::directionAt(nov);
        const reference::DirectionalAlbedo e = reference::directionalAlbedo(s, k, {32, 24});
        if (const double sum = e.diffuse.x + e.specular.x; !(sum <= worst.value)) worst = {sum, fmt::format("substance {:.2f}, roughness {:g}, n.v {:g}", substance, r, nov)};
      }
  return worst;
}

// H14. The lobes without a cosine or bound (Phong's, Blinn's and Ward's as their papers have them) reach albedos of 6 and are left to the tests, with bounds of their own.
Finding dfgTables() {
  Finding worst;
  for (int table = 0; table < prefilter::kDfgTables; ++table) {
    const shading::Rungs k = prefilter::dfgRungs(table);
    if (k.specular == SPECULAR_PHONG || k.specular == SPECULAR_BLINN_PHONG || k.specular == SPECULAR_WARD) continue;
    // A grid that shares no point with the table's texels; its ends are the table's edges.
    for (int i = 0; i <= 10; ++i)
      for (int j = 0; j <= 7; ++j) {
        const double nov = std::pow(10.0, -4 * (1 - i / 10.0)), alpha = 4e-4 * std::pow(2500.0, j / 7.0);
        const glm::dvec2 error = glm::abs(prefilter::lookUpDfg(k, nov, alpha) - reference::lobeAlbedo(k, nov, alpha, true));
        if (const double e = std::max(error.x, error.y); !(e <= worst.value)) worst = {e, fmt::format("table {}, n.v {:.2g}, alpha {:.2g}", table, nov, alpha)};
      }
  }
  return worst;
}

// H29: what compensation and coupled diffuse give back is all that single scattering loses.
Finding whole() {
  Quality quality;
  quality.compensation = Compensation::MultipleScattering;
  quality.diffuse = Diffuse::Coupled;
  const shading::Rungs k = plan::rungsOf(quality);
  Finding worst;
  for (const double r : {0.05, 0.2, 0.5, 1.0}) {
    const reference::LobeEnergy energy(k, r * r, 192);
    for (const double substance : {0.0, 1.0 / 3, 1.0})
      for (const double nov : {0.05, 0.2, 0.6, 1.0}) {
        reference::OracleSurface s;
        s.albedo = glm::dvec3(1);
        s.substance = substance;
        s.alpha = r * r;
        s.v = reference::directionAt(nov);
        const reference::DirectionalAlbedo e = reference::directionalAlbedo(s, k, {32, 24}, &energy);
        worst.worse(std::abs(e.diffuse.x + e.specular.x - 1), fmt::format("substance {:.2f}, roughness {:g}, n.v {:g}", substance, r, nov));
      }
  }
  return worst;
}

}  // namespace

std::vector<OracleCase> oracleCases() {
  return {{"H13", "white furnace over substance x roughness x angle, default rungs: largest albedo", 1.001, [] { return furnace("default"); }},
          // What diffuse gets is reckoned with Schlick's albedo, which misses Fresnel's by up to 0.060 (water at 83.8 degrees).
          {"H13", "white furnace over substance x roughness x angle, exact rungs: largest albedo", 1.06, [] { return furnace("exact"); }},
          {"H14", "DFG tables against quadrature, edges included: largest error", 1.5e-3, dfgTables},
          {"H29", "white furnace with compensation and coupled diffuse, by quadrature: off 1", 0.02, whole}};
}

}  // namespace burnish::stability
