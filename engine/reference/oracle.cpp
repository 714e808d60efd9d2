#include "reference/oracle.h"

#include <memory>

namespace burnish::reference {

namespace f64 = shading::f64;

f64::Surface surfaceOf(const OracleSurface& s, const LobeEnergy* energy) {
  f64::Surface m = f64::makeSurface(s.n, s.v, s.albedo, s.substance, s.alpha);
  m.eta = s.eta;
  m.k = s.k;
  if (s.anisotropy > 0) f64::setTangent(m, s.tangent, s.anisotropy);
  m.sigma = s.sigma;
  if (energy) {
    m.dfg = energy->at(m.nov);
    m.dfgMean = energy->mean();
  }
  return m;
}

namespace {
std::unique_ptr<LobeEnergy> energyOf(const shading::Rungs& rungs, double alpha) { return needsAlbedoTable(rungs) ? std::make_unique<LobeEnergy>(rungs, alpha) : nullptr; }
}  // namespace

glm::dvec3 shade(const OracleSurface& surface, std::span<const OracleLight> lights, const shading::Rungs& rungs) {
  const auto energy = energyOf(rungs, surfaceOf(surface, nullptr).alpha);
  const f64::Surface m = surfaceOf(surface, energy.get());
  glm::dvec3 sum(0);
  for (const OracleLight& light : lights)
    sum += f64::shadeDirection(m, light.toLight, energy ? energy->at(glm::dot(m.n, light.toLight)) : glm::dvec2(0), rungs) * light.irradiance;
  return sum;
}

// The lobe takes nodes where its half vectors are, what is smooth takes nodes over the hemisphere. Quadrature is done in the frame of a normal +z and a view in the xz plane.
DirectionalAlbedo directionalAlbedo(const OracleSurface& surface, const shading::Rungs& rungs, const Resolution& resolution, const LobeEnergy* known) {
  const Rules rules(resolution);
  const auto found = known ? nullptr : energyOf(rungs, surfaceOf(surface, nullptr).alpha);
  const LobeEnergy* energy = known && needsAlbedoTable(rungs) ? known : found.get();
  const double nov = std::clamp(glm::dot(surface.n, surface.v), 1e-9, 1.0);
  OracleSurface local = surface;
  local.n = {0, 0, 1};
  local.v = directionAt(nov);
  const f64::Surface m = surfaceOf(local, energy);
  const auto lobe = [&](const glm::dvec3& l) {
    const f64::Angles a = f64::anglesOf(m, l);
    return f64::fresnelRung(m.f0, m.eta, m.k, a.loh, rungs.fresnel) * f64::specularRung(m, a, rungs);
  };
  DirectionalAlbedo sum;
  sum.specular = lobeFamily(rungs) == LOBE_FAMILY_PHONG ? integrateMirror<glm::dvec3>(nov, surface.alpha, lobe, rules) : integrateHalf<glm::dvec3>(nov, surface.alpha, lobe, rules);
  sum.diffuse = integrateCosine<glm::dvec3>(
      [&](const glm::dvec3& l) { return f64::diffuseRung(m, f64::anglesOf(m, l), energy ? energy->at(l.z) : glm::dvec2(0), rungs) * l.z; }, rules);
  if (rungs.compensation != COMPENSATION_NONE) {
    const double again = integrateCosine<double>([&](const glm::dvec3& l) { return f64::multipleScatteringLobe(m.dfg, energy->at(l.z), m.dfgMean) * l.z; }, rules);
    for (int i = 0; i < 3; ++i) sum.specular[i] += f64::scatteredShare(m.f0[i], m.dfgMean, rungs.fresnel) * again;
  }
  return sum;
}

}  // namespace burnish::reference
