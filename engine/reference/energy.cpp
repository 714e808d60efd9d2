#include "reference/energy.h"

#include "reference/quadrature.h"

namespace burnish::reference {

namespace f64 = shading::f64;

// F = F0 + (1 - F0) (1 - l·h)^5 splits the integral of f (n·l) into scale and bias (Karis 2013, "Real Shading in Unreal Engine 4", eq. 8).
glm::dvec2 lobeAlbedo(const shading::Rungs& rungs, double nov, double alpha, bool fine) {
  const f64::Surface m = f64::makeSurface({0, 0, 1}, directionAt(nov), glm::dvec3(1), 1, alpha);
  static const Rules kFine(Resolution{96, 96}), kUsual(Resolution{40, 32});
  const Rules& rules = fine ? kFine : kUsual;
  const auto integrand = [&](const glm::dvec3& l) {
    const f64::Angles a = f64::anglesOf(m, l);
    const double w = f64::schlickWeight(a.loh);
    return glm::dvec2(1 - w, w) * f64::specularRung(m, a, rungs);
  };
  return lobeFamily(rungs) == LOBE_FAMILY_PHONG ? integrateMirror<glm::dvec2>(nov, alpha, integrand, rules) : integrateHalf<glm::dvec2>(nov, alpha, integrand, rules);
}

glm::dvec2 lobeAlbedoMean(const shading::Rungs& rungs, double alpha, bool fine) {
  return hemisphereMean<glm::dvec2>([&](double c) { return lobeAlbedo(rungs, std::max(c, 1e-7), alpha, fine); }, fine ? 64 : 32);
}

LobeEnergy::LobeEnergy(const shading::Rungs& rungs, double alpha, int nodes) {
  for (int i = 0; i < nodes; ++i) table_.push_back(lobeAlbedo(rungs, std::max(std::pow(double(i) / (nodes - 1), 4), 1e-9), alpha));
  mean_ = lobeAlbedoMean(rungs, alpha);
}

glm::dvec2 LobeEnergy::at(double cosine) const {
  const double x = std::pow(std::clamp(cosine, 0.0, 1.0), 0.25) * double(table_.size() - 1);
  const std::size_t i = std::min(std::size_t(x), table_.size() - 2);
  return glm::mix(table_[i], table_[i + 1], x - double(i));
}

}  // namespace burnish::reference
