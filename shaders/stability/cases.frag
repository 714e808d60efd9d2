// One case of the shading text a texel (engine/stability/shader_cases.h). Definitions: EVALUATE, an expression that makes a vec4 of a, b, c, d, e, f.
#include "shading/bridge.h"
#include "shading/all.h"
#include "shading/tonemap.h"
#include "stability/case_functions.h"
layout(binding = 0) uniform sampler2D cases;  // row k of each six holds the k-th vec4 of every case
layout(location = 0) out vec4 result;

void main() {
  int i = int(gl_FragCoord.x), row = 6 * int(gl_FragCoord.y);
  vec4 a = texelFetch(cases, ivec2(i, row), 0), b = texelFetch(cases, ivec2(i, row + 1), 0), c = texelFetch(cases, ivec2(i, row + 2), 0);
  vec4 d = texelFetch(cases, ivec2(i, row + 3), 0), e = texelFetch(cases, ivec2(i, row + 4), 0), f = texelFetch(cases, ivec2(i, row + 5), 0);
  result = EVALUATE;
}
