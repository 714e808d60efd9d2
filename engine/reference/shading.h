// The shading text (shaders/shading) as C++: namespaces burnish::shading::f32 and f64 hold the same functions in float and in double.
#pragma once
#include <glm/glm.hpp>

#include "shading/bridge.h"

// NOLINTBEGIN
#define BURNISH_SHADING_TERMS "reference/shading_terms.inl"
namespace burnish::shading::f32 {
using real = float;
using glm::vec2;
using glm::vec3;
using glm::vec4;
#include BURNISH_SHADING_TERMS
}  // namespace burnish::shading::f32
namespace burnish::shading::f64 {
using real = double;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
#include BURNISH_SHADING_TERMS
}  // namespace burnish::shading::f64
// NOLINTEND
