// Faces of a cube (OpenGL 4.5 specification, table 8.19) and the grids that the cube filter sums over: engine/gpu_scene/cube_filter.h.
#include "interface/layout.h"

// The direction of (u, v) on a face is axis(face) + u · right(face) + v · down(face); on the face itself u and v are in [-1, 1].
const vec3 kAxis[6] = vec3[](vec3(1.0, 0.0, 0.0), vec3(-1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, -1.0, 0.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0));
const vec3 kRight[6] = vec3[](vec3(0.0, 0.0, -1.0), vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(-1.0, 0.0, 0.0));
const vec3 kDown[6] = vec3[](vec3(0.0, -1.0, 0.0), vec3(0.0, -1.0, 0.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0), vec3(0.0, -1.0, 0.0), vec3(0.0, -1.0, 0.0));

// The centre of the texel of a size² face that is being drawn, a unit vector.
vec3 texelDirection(int face, int size) {
  vec2 uv = gl_FragCoord.xy * (2.0 / float(size)) - 1.0;
  return normalize(kAxis[face] + kRight[face] * uv.x + kDown[face] * uv.y);
}

// A direction's coordinates along right, down and axis of a face.
vec3 inFace(vec3 d, int face) { return vec3(dot(d, kRight[face]), dot(d, kDown[face]), dot(d, kAxis[face])); }

// A grid: x texels along a face's edge, y points beyond each edge, z points along a side with them (x + 2 y). The six faces lie side by side in the atlas.
float gridCoordinate(int i, ivec3 grid) { return (2.0 * float(i - grid.y) + 1.0) / float(grid.x) - 1.0; }

#define LARGEST 65024.0  // of what half floats hold, with room for rounding
// The nearest half floats, ties to even; under 2^-14 they are multiples of 2^-24. What is drawn and packHalf2x16 may cut off what is over (NVIDIA does).
float rounded(float c) {
  uint bits = floatBitsToUint(c);
  return abs(c) < 1.0 / 16384.0 ? roundEven(c * 16777216.0) / 16777216.0 : uintBitsToFloat((bits + 0xfffu + ((bits >> 13) & 1u)) & 0xffffe000u);
}
vec3 rounded(vec3 c) { return vec3(rounded(c.r), rounded(c.g), rounded(c.b)); }
