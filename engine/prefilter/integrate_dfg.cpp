// E(v) = ∫ F D V (n·l) dl. With h drawn with density D (n·h) (Walter et al. 2007, section 5.2; for Blinn-Phong n·h = u^(1/(p+2))) and dl = 4 (l·h) dh it is the mean of
// F · 4 V (n·l) (l·h) / (n·h); F = F0 + (1 - F0) (1 - l·h)^5 splits it into scale and bias (Karis 2013, eq. 8).
#include <algorithm>
#include <cmath>

#include "prefilter/dfg.h"
#include "reference/shading.h"

namespace burnish::prefilter {

glm::dvec2 integrateDfg(Geometry geometry, double nov, double roughness, int nu, int nv) {
  using namespace shading::f64;
  const double alpha = alphaFromRoughness(std::max(roughness, 0.02));
  const double p = powerFromAlpha(alpha);
  nov = std::clamp(nov, 1e-4, 1.0);
  const glm::dvec3 view(std::sqrt(1 - nov * nov), 0, nov);
  glm::dvec2 sum(0);
  for (int i = 0; i < nu; ++i) {
    const double noh = std::pow((i + 0.5) / nu, 1 / (p + 2)), sine = std::sqrt(std::max(1 - noh * noh, 0.0));
    for (int j = 0; j < nv; ++j) {
      const double phi = (j + 0.5) / nv * 3.14159265358979323846;  // symmetric in azimuth: half is enough
      const glm::dvec3 h(sine * std::cos(phi), sine * std::sin(phi), noh);
      const double voh = glm::dot(view, h);
      const double nol = 2 * voh * noh - nov;
      if (nol <= 0 || voh <= 0) continue;
      const double s2inverse = 1 / (4 * voh * voh);
      const double weight = geometry == Geometry::Kelemen ? 4 * V_kelemen(s2inverse) * nol * voh / noh
                                                          : 4 * normalizationExact(p) / ((p + 2) / (2 * BURNISH_PI)) * nol * voh / noh;
      const double w = schlickWeight(voh);
      sum += glm::dvec2(1 - w, w) * weight;
    }
  }
  return sum / double(nu * nv);
}

}  // namespace burnish::prefilter
