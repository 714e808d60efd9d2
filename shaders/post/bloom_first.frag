// Level 0 of the bloom: half of the light buffer, by [1 3 3 1]/8 an axis. The firewall: what is no number scatters nothing, what is infinite or negative is held, texel by texel.
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_LIGHT_BUFFER) uniform sampler2D lightBuffer;
layout(location = 0) out vec4 outLight;
#define LARGEST 65000.0  // of a half float, with room for rounding

vec3 kept(vec3 c) { return any(isnan(c)) ? vec3(0.0) : clamp(c, vec3(0.0), vec3(LARGEST)); }

void main() {
  ivec2 last = frame.viewport.zw - 1, first = ivec2(gl_FragCoord.xy) * 2 - 1;
  vec3 sum = vec3(0.0);
  for (int y = 0; y < 4; ++y) {
    vec3 row = vec3(0.0);
    for (int x = 0; x < 4; ++x) {
      vec3 c = kept(texelFetch(lightBuffer, frame.viewport.xy + clamp(first + ivec2(x, y), ivec2(0), last), 0).rgb);
      row += x == 0 || x == 3 ? c : c * 3.0;
    }
    sum += y == 0 || y == 3 ? row : row * 3.0;
  }
  outLight = vec4(sum * (1.0 / 64.0), 1.0);
}
