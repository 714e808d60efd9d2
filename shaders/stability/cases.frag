// One case of the shading text a texel (engine/stability/shader_cases.h). Definitions: EVALUATE, an expression that makes a vec4 of a, b, c, d, e, f.
#include "shading/bridge.h"
#include "shading/all.h"
#include "shading/tonemap.h"
layout(binding = 0) uniform sampler2D cases;  // row k of each six holds the k-th vec4 of every case
layout(location = 0) out vec4 result;

Surface surfaceCase(vec4 n, vec4 v, vec4 albedo) { return makeSurface(n.xyz, v.xyz, albedo.rgb, albedo.a, n.w); }

vec4 shadeCase(vec4 n, vec4 l, vec4 v, vec4 albedo, vec4 dfg, vec2 mean, Rungs k) {
  Surface m = surfaceCase(n, v, albedo);
  m.dfg = dfg.xy;
  m.dfgMean = mean;
  return vec4(shadeDirection(m, l.xyz, dfg.zw, k), 0.0);
}

void main() {
  int i = int(gl_FragCoord.x), row = 6 * int(gl_FragCoord.y);
  vec4 a = texelFetch(cases, ivec2(i, row), 0), b = texelFetch(cases, ivec2(i, row + 1), 0), c = texelFetch(cases, ivec2(i, row + 2), 0);
  vec4 d = texelFetch(cases, ivec2(i, row + 3), 0), e = texelFetch(cases, ivec2(i, row + 4), 0), f = texelFetch(cases, ivec2(i, row + 5), 0);
  result = EVALUATE;
}
