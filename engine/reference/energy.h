// Directional albedo of the specular rungs by quadrature in double: what the DFG tables hold.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "reference/shading.h"

namespace burnish::reference {

/// (scale, bias) of the specular rung's directional albedo: E(v) = F0 · scale + bias with Schlick's Fresnel. nov, alpha in (0, 1]. Within 1e-5 where `fine`, elsewhere 5e-4 of max(1, E).
glm::dvec2 lobeAlbedo(const shading::Rungs& rungs, double nov, double alpha, bool fine = false);
/// The mean over the hemisphere, 2 ∫ lobeAlbedo c dc.
glm::dvec2 lobeAlbedoMean(const shading::Rungs& rungs, double alpha, bool fine = false);

/// lobeAlbedo over the cosine for one alpha, tabulated densely (error under 2e-5 of linear interpolation in cos^(1/4)).
class LobeEnergy {
 public:
  LobeEnergy(const shading::Rungs& rungs, double alpha, int nodes = 384);
  [[nodiscard]] glm::dvec2 at(double cosine) const;
  [[nodiscard]] glm::dvec2 mean() const { return mean_; }

 private:
  std::vector<glm::dvec2> table_;
  glm::dvec2 mean_{0};
};

}  // namespace burnish::reference
