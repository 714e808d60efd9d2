// Irradiance / π of the surroundings as nine coefficients without their basis' constants (irradianceSh of shading/environment.h): pixel k holds coefficient k. Summed over one grid: the basis is
// smooth.
#include "prefilter/cube.glsl"
layout(binding = UNIT_CUBE_FILTER) uniform sampler2D points;
layout(location = 0) uniform ivec3 grid;
layout(location = 1) uniform ivec2 place;
layout(location = 0) out vec4 outCoefficient;

float basis(int k, vec3 d) {
  switch (k) {
    case 0: return 1.0;
    case 1: return d.y;
    case 2: return d.z;
    case 3: return d.x;
    case 4: return d.x * d.y;
    case 5: return d.y * d.z;
    case 6: return 3.0 * d.z * d.z - 1.0;
    case 7: return d.x * d.z;
    default: return d.x * d.x - d.y * d.y;
  }
}

// Basis constants squared times 4 π times A_l / π = 1, 2/3, 1/4 (Ramamoorthi and Hanrahan 2001, equations 3 and 8), over the mean in place of the integral.
const float kFactor[9] = float[](1.0, 2.0, 2.0, 2.0, 3.75, 3.75, 0.3125, 3.75, 0.9375);

void main() {
  int k = int(gl_FragCoord.x);
  vec3 sum = vec3(0.0);
  float total = 0.0;
  // Row by row, so that few numbers are added up in a row and little is rounded off.
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < grid.z; ++y) {
      vec4 row = vec4(0.0);
      for (int x = 0; x < grid.z; ++x) {
        vec3 d = normalize(kAxis[face] + kRight[face] * gridCoordinate(x, grid) + kDown[face] * gridCoordinate(y, grid));
        vec4 point = texelFetch(points, place + ivec2(face * grid.z + x, y), 0);
        row += vec4(point.rgb * basis(k, d), point.a);
      }
      sum += row.rgb;
      total += row.a;
    }
  outCoefficient = vec4(sum * (kFactor[k] / total), 1.0);
}
