// Rungs as the tests name them.
#pragma once
#include <burnish/quality.h>

#include "plan/rungs.h"
#include "reference/oracle.h"

namespace burnish::test {

/// The default path's rungs, or with void geometry in place of Kelemen's, or with another evaluation of the lobe.
inline shading::Rungs defaultRungs(int geometry = GEOMETRY_KELEMEN, int lobe = LOBE_STABLE) {
  shading::Rungs k = plan::rungsOf(Quality{});
  k.geometry = geometry;
  k.lobe = lobe;
  return k;
}

/// Every specular rung that is a lobe of its own: the models, each distribution with each geometry, each normalization
/// of void geometry.
inline std::vector<shading::Rungs> specularRungs() {
  std::vector<shading::Rungs> all;
  for (int model = 1; model <= SPECULAR_GGX_SMITH; ++model) {
    shading::Rungs k = defaultRungs();
    k.specular = model;
    all.push_back(k);
  }
  for (int distribution = 0; distribution <= DISTRIBUTION_GGX; ++distribution)
    for (int geometry = 0; geometry <= GEOMETRY_V_CAVITY; ++geometry) {
      shading::Rungs k = defaultRungs(geometry);
      k.distribution = distribution;
      all.push_back(k);
    }
  for (int normalization = 0; normalization < NORMALIZATION_EXACT; ++normalization) {
    shading::Rungs k = defaultRungs(GEOMETRY_VOID);
    k.normalization = normalization;
    all.push_back(k);
  }
  return all;
}

/// "ggx, smith" or "ward": for messages.
inline std::string nameOf(const shading::Rungs& k) {
  const auto rung = [](std::size_t term, int i) { return std::string(terms()[term].rungs[std::size_t(i)].name); };
  if (k.specular != SPECULAR_MICROFACET) return rung(0, k.specular);
  std::string name = rung(1, k.distribution) + ", " + rung(2, k.geometry);
  if (k.geometry == GEOMETRY_VOID && k.distribution == DISTRIBUTION_BLINN_PHONG)
    name += ", " + rung(3, k.normalization);
  return name;
}

}  // namespace burnish::test
