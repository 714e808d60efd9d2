// The directional albedo of each specular lobe as scale and bias of F0 (DFG), integrated in double and tabulated when the project is built.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "reference/shading.h"

namespace burnish::prefilter {

/// (scale, bias) as 16-bit unsigned normalized times `scale`: E(v) = F0 · scale + bias with Schlick's Fresnel. Rows of `width` texels; shading/dfg.h says which texel stands for
/// what. Bilinear filtering errs by at most 1e-3 of max(1, E); Ward's unbounded lobe by 4e-3 and Phong's without a
/// cosine by 2e-2 (tests/shading/dfg_test).
struct DfgTable {
  int width = 0, height = 0;
  float scale = 1;
  std::span<const std::uint16_t> texels;  ///< 2 · width · height
};

/// How many different lobes there are; several rungs share one (Cook-Torrance is Beckmann's distribution with V-cavities).
inline constexpr int kDfgTables = 20;
/// The table of the lobe in force, below kDfgTables. Normalizations other than the exact one scale it (dfgScale of shading/dfg.h).
int dfgIndex(const shading::Rungs& rungs);
/// Rungs whose table has that index.
shading::Rungs dfgRungs(int index);
/// index < kDfgTables.
DfgTable dfgTable(int index);

/// The table of the lobe in force as a renderer reads it: filtered linearly, scaled for the normalization. cosine, alpha: any number.
glm::dvec2 lookUpDfg(const shading::Rungs& rungs, double cosine, double alpha);
/// Its mean over the hemisphere.
glm::dvec2 lookUpDfgMean(const shading::Rungs& rungs, double alpha);
/// What dfgColumn and dfgRow of shading/dfg.h take to a coordinate in [0, 1].
double cosineOfColumn(double column);
double alphaOfRow(double row);

}  // namespace burnish::prefilter
