// shaders/stability/case_functions.h as C++, beside the shading text.
#pragma once
#include "reference/shading.h"

// NOLINTBEGIN
namespace burnish::shading::f32 {
#include "stability/case_functions.h"
}
namespace burnish::shading::f64 {
#include "stability/case_functions.h"
}
// NOLINTEND
