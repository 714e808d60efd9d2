// Quality as the shading text takes it.
#pragma once
#include <burnish/quality.h>

#include "reference/shading.h"

namespace burnish::plan {

/// The rungs of the lighting equation; `anisotropic` and `roughDiffuse` are 0: they are the surface's.
shading::Rungs rungsOf(const Quality& quality);
/// Brushed surfaces have two widths: they are asked for, and the specular model has them.
bool drawsBrushed(const Quality& quality);
/// LOBE_FAMILY_* of the specular model in force.
int familyOf(const Quality& quality);

}  // namespace burnish::plan
