// A texel of a filtered level: Σ points × lobe / Σ solid angles × lobe, the lobe split into parts that are each summed over the coarsest grid that carries them (engine/gpu_scene/cube_filter_parts.h).
#include "prefilter/cube.glsl"
layout(binding = UNIT_CUBE_FILTER) uniform sampler2D points;
layout(location = 0) uniform ivec3 target;  // face, texels along its edge, number of parts
struct Part {
  ivec4 grid;      // gridCoordinate's, w column of its corner in the atlas
  vec4 support;    // of x = 1 - l·R: nothing from x on; y cosine², z sine of that angle; w row of the grid's corner
  vec4 shape;      // Ggx: x slope, y x under which the inner polynomial stands for the lobe, z x under which the outer one is subtracted
  vec4 inner[2];   // coefficients; Blinn-Phong: of the exponent of 2
  vec4 outer[2];
};
layout(std140, binding = BINDING_CUBE_FILTER) uniform Parts { Part parts[MOST_PARTS]; };
layout(location = 0) out vec4 outLight;

float polynomial(vec4 a, vec4 b, float x) { return a.x + x * (a.y + x * (a.z + x * (a.w + x * (b.x + x * (b.y + x * b.z))))); }

#if GGX
float lobeAt(Part part, float x) {
  float d = 1.0 + part.shape.x * x;
  float value = x < part.shape.y ? polynomial(part.inner[0], part.inner[1], x - part.shape.y) : (1.0 - x) / (d * d);
  return value - (x < part.shape.z ? polynomial(part.outer[0], part.outer[1], x - part.shape.z) : 0.0);
}
#else
float lobeAt(Part part, float x) { return exp2(polynomial(part.inner[0], part.inner[1], x)) * (1.0 - x); }
#endif

// Coordinates along one axis of a face that a cone reaches, its axis at (r, height) seen along the other one, by angles about that; the first is larger where there are none. beyond: the last coordinate.
vec2 reached(float r, float height, float sine, float beyond) {
  float last = atan(beyond);
  float radius = length(vec2(r, height));
  if (sine >= radius) return vec2(-beyond, beyond);
  float middle = atan(r, height), reach = asin(sine / radius);
  if (middle - reach > last || middle + reach < -last) return vec2(1.0, -1.0);
  return tan(clamp(vec2(middle - reach, middle + reach), -last, last));
}

// Inverse of gridCoordinate.
float pointAt(float coordinate, ivec3 grid) { return (coordinate + 1.0) * (0.5 * float(grid.x)) + float(grid.y) - 0.5; }

vec4 sumOf(Part part, vec3 reflected) {
  ivec3 grid = part.grid.xyz;
  float beyond = 1.0 + 2.0 * float(grid.y) / float(grid.x);
  vec4 sum = vec4(0.0);
  for (int face = 0; face < 6; ++face) {
    vec3 r = inFace(reflected, face);
    // Rows and columns that the cone about r reaches.
    vec2 rows = reached(r.y, r.z, part.support.z, beyond), columns = reached(r.x, r.z, part.support.z, beyond);
    if (rows.x > rows.y || columns.x > columns.y || r.z + (abs(r.x) + abs(r.y)) * beyond <= 0.0) continue;
    int y0 = max(int(floor(pointAt(rows.x, grid))), 0), y1 = min(int(ceil(pointAt(rows.y, grid))), grid.z - 1);
    for (int y = y0; y <= y1; ++y) {
      // Of a row: a quadratic for where the cone meets it, or, where that is no ellipse or nearly none, the half before the plane across r.
      float v = gridCoordinate(y, grid), v2 = 1.0 + v * v, along = r.y * v + r.z, a = part.support.y - r.x * r.x;
      vec2 ends = columns;
      if (a > 0.001) {
        float centre = r.x * along / a, root = centre * centre + (along * along - part.support.y * v2) / a;
        if (root < 0.0) continue;
        ends = clamp(centre + vec2(-1.0, 1.0) * sqrt(root), columns.x, columns.y);
      } else if (r.x > 0.0) {
        ends.x = max(ends.x, -along / r.x);
      } else if (r.x < 0.0) {
        ends.y = min(ends.y, -along / r.x);
      }
      int x0 = int(clamp(floor(pointAt(ends.x, grid)), 0.0, float(grid.z))), x1 = int(clamp(ceil(pointAt(ends.y, grid)), -1.0, float(grid.z - 1)));
      ivec2 texel = ivec2(part.grid.w + face * grid.z, int(part.support.w) + y);
      vec4 rowSum = vec4(0.0);
      for (int x = x0; x <= x1; ++x) {
        // 1 - l·r as |l - r|²/2, which does not cancel.
        vec3 l = vec3(gridCoordinate(x, grid), v, 1.0);
        vec3 apart = l * inversesqrt(dot(l, l)) - r;
        float gap = 0.5 * dot(apart, apart);
        float weight = gap < part.support.x ? lobeAt(part, gap) : 0.0;
        rowSum += weight * texelFetch(points, texel + ivec2(x, 0), 0);
      }
      sum += rowSum;
    }
  }
  return sum;
}

void main() {
  vec3 reflected = texelDirection(target.x, target.y);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < target.z; ++i) sum += sumOf(parts[i], reflected);
  outLight = vec4(rounded(clamp(sum.rgb / sum.a, vec3(0.0), vec3(LARGEST))), 1.0);
}
