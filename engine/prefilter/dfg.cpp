// Which table a rung has, and what its rows and columns stand for.
#include <algorithm>
#include <cmath>

#include "prefilter/dfg.h"

namespace burnish::prefilter {

namespace f64 = shading::f64;

int dfgIndex(const shading::Rungs& k) {
  switch (k.specular) {
    case SPECULAR_MICROFACET: return k.distribution * 5 + k.geometry;
    case SPECULAR_NORMALIZED_BLINN_PHONG: return DISTRIBUTION_BLINN_PHONG * 5 + GEOMETRY_VOID;
    case SPECULAR_COOK_TORRANCE: return DISTRIBUTION_BECKMANN * 5 + GEOMETRY_V_CAVITY;
    case SPECULAR_WARD_BOUNDED: return DISTRIBUTION_BECKMANN * 5 + GEOMETRY_KELEMEN;
    case SPECULAR_GGX_SMITH: return DISTRIBUTION_GGX * 5 + GEOMETRY_SMITH;
    case SPECULAR_PHONG: return 15;
    case SPECULAR_BLINN_PHONG: return 16;
    case SPECULAR_MODIFIED_PHONG: return 17;
    case SPECULAR_MAX_PHONG: return 18;
    default: return 19;  // both of Ward's with the unbounded albedo; the anisotropic one as if its widths were equal
  }
}

shading::Rungs dfgRungs(int index) {
  shading::Rungs k{SPECULAR_MICROFACET, 0, 0, NORMALIZATION_EXACT, LOBE_STABLE, FRESNEL_SCHLICK, DIFFUSE_LAMBERT, COMPENSATION_NONE, 0};
  constexpr int kModels[] = {SPECULAR_PHONG, SPECULAR_BLINN_PHONG, SPECULAR_MODIFIED_PHONG, SPECULAR_MAX_PHONG, SPECULAR_WARD};
  if (index >= 15) {
    k.specular = kModels[index - 15];
  } else {
    k.distribution = index / 5;
    k.geometry = index % 5;
  }
  return k;
}

double cosineOfColumn(double column) { return std::clamp(std::pow(0.1 + 0.9 * column, 4), 1e-4, 1.0); }

double alphaOfRow(double row) {
  double low = 4e-4, high = 1;
  for (int i = 0; i < 100; ++i) {
    const double middle = std::sqrt(low * high);
    (f64::dfgRow(middle) < row ? low : high) = middle;
  }
  return row <= 0 ? 4e-4 : row >= 1 ? 1 : low;
}

}  // namespace burnish::prefilter
