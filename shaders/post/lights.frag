// Debug view: lights per tile, black 0, blue 1, green 8, yellow 16, red 32 and more.
#include "interface/layout.h"
layout(location = 0) flat in int lightCount;
layout(location = 0) out vec4 outColor;
void main() {
  float t = float(lightCount);
  vec3 c = t < 0.5 ? vec3(0.05) : t <= 8.0 ? mix(vec3(0.1, 0.2, 0.9), vec3(0.1, 0.8, 0.2), (t - 1.0) / 7.0)
         : t <= 16.0 ? mix(vec3(0.1, 0.8, 0.2), vec3(0.95, 0.9, 0.1), (t - 8.0) / 8.0) : mix(vec3(0.95, 0.9, 0.1), vec3(0.9, 0.1, 0.1), min((t - 16.0) / 16.0, 1.0));
  outColor = vec4(c, 1.0);
}
