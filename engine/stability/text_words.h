// What the files of cases of the shading text share: its names, and vectors of a case.
#pragma once
#include <cmath>
#include <span>

#include "stability/text_variants.h"

namespace burnish::stability {

namespace f32 = shading::f32;
namespace f64 = shading::f64;
using glm::dvec3;
using glm::dvec4;
using glm::vec3;
using glm::vec4;
using Inputs = std::span<const ShaderCase>;
using Outputs = std::span<const dvec4>;

inline bool finite(const dvec4& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w); }
/// The direction of a case's input, in float and in double.
inline vec3 of(const vec4& v) { return vec3(v); }
inline dvec3 exactly(const vec4& v) { return dvec3(v); }

}  // namespace burnish::stability
