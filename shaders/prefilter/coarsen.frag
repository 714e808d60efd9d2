// Half as many points along one axis. A point gives its value to the TAPS points of the coarser grid around it by the weights with which Lagrange's polynomial through them interpolates there: the
// adjoint of interpolation. What a sum of (values × smooth function) over the coarser grid errs by is then how far that polynomial is from the function, however rough the values are.
#include "prefilter/cube.glsl"
layout(binding = UNIT_CUBE_FILTER) uniform sampler2D points;
layout(location = 0) uniform ivec3 fine;
layout(location = 1) uniform ivec3 coarse;
layout(location = 2) uniform ivec4 places;  // corners in the atlas: xy of what is read, zw of what is drawn
layout(location = 0) out vec4 outPoint;

// What the point at t (in the coarser grid's points, the face's first at 0) gives to point i.
float weightOf(float t, int i) {
  int first = clamp(int(floor(t)) - (TAPS / 2 - 1), -coarse.y, coarse.x + coarse.y - TAPS);
  if (i < first || i >= first + TAPS) return 0.0;
  float weight = 1.0;
  for (int k = 0; k < TAPS; ++k)
    if (first + k != i) weight *= (t - float(first + k)) / float(i - first - k);
  return weight;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy) - places.zw;
#if ALONG_X
  int face = p.x / coarse.z, i = p.x - face * coarse.z - coarse.y;
#else
  int i = p.y - coarse.y;
#endif
  // Next to the grid's edge stencils lean inwards by one point at most.
  int from = max(2 * i - TAPS - 2, -fine.y), to = min(2 * i + TAPS + 3, fine.x + fine.y - 1);
  vec4 sum = vec4(0.0);
  for (int j = from; j <= to; ++j) {
    float weight = weightOf(0.5 * float(j) - 0.25, i);
#if ALONG_X
    sum += weight * texelFetch(points, places.xy + ivec2(face * fine.z + j + fine.y, p.y), 0);
#else
    sum += weight * texelFetch(points, places.xy + ivec2(p.x, j + fine.y), 0);
#endif
  }
  outPoint = sum;
}
