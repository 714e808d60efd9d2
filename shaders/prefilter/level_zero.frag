// Level 0 of the filtered cube: the mean over solid angle of the source's texels that one of its texels covers.
#include "prefilter/cube.glsl"
layout(binding = UNIT_CUBE_FILTER) uniform sampler2D points;
layout(location = 0) uniform ivec3 target;  // face, texels along its edge, source texels along an edge of one
layout(location = 0) out vec4 outLight;

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * target.z;
  first.x += target.x * target.y * target.z;
  vec4 sum = vec4(0.0);
  for (int y = 0; y < target.z; ++y)
    for (int x = 0; x < target.z; ++x) sum += texelFetch(points, first + ivec2(x, y), 0);
  outLight = vec4(rounded(sum.rgb / sum.a), 1.0);
}
