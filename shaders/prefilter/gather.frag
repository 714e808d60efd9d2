// The finest grid: each texel of the source as a point, (radiance, 1) times its solid angle (in units in which a whole sphere of grid.x² texels a face is 6 grid.x²).
// The firewall: what is no number is black, what is infinite or negative is held.
#include "prefilter/cube.glsl"
layout(binding = UNIT_CUBE_FILTER) uniform samplerCube source;
layout(location = 0) uniform int size;  // texels along the source's edge
layout(location = 0) out vec4 outPoint;

float kept(float c) { return isnan(c) ? 0.0 : clamp(c, 0.0, LARGEST); }
vec3 kept(vec3 c) { return vec3(kept(c.r), kept(c.g), kept(c.b)); }

// ∫ (1 + u² + v²)^(-3/2) over the texel by its value and Laplacian in the middle: within 2e-5 for 16² texels a face, as the fourth power of their size beyond. Differences of corners' arctangents
// (Driscoll 2012), which are exact, would cancel in float.
float solidAngle(vec2 uv) {
  float r2 = 1.0 + dot(uv, uv), h = 1.0 / float(size);
  float inverse = inversesqrt(r2), inverse3 = inverse / r2;
  return inverse3 * (1.0 + h * h * (1.5 - 2.5 / r2) / r2) * (6.0 / 3.14159265);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  int face = p.x / size;
  vec2 uv = (2.0 * vec2(p.x - face * size, p.y) + 1.0) / float(size) - 1.0;
  vec3 light = kept(textureLod(source, kAxis[face] + kRight[face] * uv.x + kDown[face] * uv.y, 0.0).rgb);
  outPoint = vec4(light, 1.0) * solidAngle(uv);
}
