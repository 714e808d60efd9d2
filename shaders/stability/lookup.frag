// A prefiltered cube as lighting/shade.glsl looks the surroundings up, one direction and alpha a texel (engine/stability/reflected_disc.cpp). Definitions: LAST_LEVEL.
#include "shading/bridge.h"
#include "shading/all.h"
#include "interface/cube_level.glsl"
layout(binding = 0) uniform sampler2D lookups;
layout(binding = 1) uniform samplerCube environmentCube;
layout(location = 0) out vec4 result;

void main() {
  vec4 q = texelFetch(lookups, ivec2(gl_FragCoord.xy), 0);
  result = textureLod(environmentCube, q.xyz, cubeLevel(sqrt(q.w), LAST_LEVEL));
}
