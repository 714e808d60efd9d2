// The shading text (shaders/shading) as C++: namespaces burnish::shading::f32 and f64 hold the same functions in float and in double.
#pragma once
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "shading/bridge.h"

// NOLINTBEGIN
#define NO_LIMIT std::numeric_limits<real>::max()  // bridge.h has GLSL's
namespace burnish::shading {
#include "shading/rungs.h"  // the numbers and Rungs, once for all precisions
}
// The generator of the DFG tables takes the specular models alone, so that no other term rebuilds them.
#ifndef BURNISH_SHADING_TERMS
#define BURNISH_SHADING_TERMS "reference/shading_terms.inl"
#endif
namespace burnish::shading {
// For u > 0: 2^-e with u 2^-e in [sqrt(1/2), sqrt(2)), and e (bridge.h has GLSL's).
template <class T>
T scaleToOne(T u, T& e) {
  int k = 0;
  const T m = std::frexp(u, &k);  // in [1/2, 1)
  if (m < T(0.70710678118654752)) --k;
  e = T(k);
  return std::ldexp(T(1), -k);
}
}  // namespace burnish::shading
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
