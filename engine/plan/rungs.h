// Quality as the shading text takes it.
#pragma once
#include <burnish/quality.h>

#include "reference/shading.h"

namespace burnish::plan {

/// The rungs of the lighting equation; `anisotropic` is 0.
shading::Rungs rungsOf(const Quality& quality);
/// LOBE_FAMILY_* of the specular model in force.
int familyOf(const Quality& quality);

}  // namespace burnish::plan
