// Automatic exposure of one picture: the centre-weighted mean logarithm of luminance on a grid, metered as ISO 2720 does (K = 12.5).
// Writes r: factor from light buffer to display, g: EV100.
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_LIGHT_BUFFER) uniform sampler2D lightBuffer;
layout(location = 0) out vec2 outExposure;
#define COLUMNS 48
#define ROWS 27

void main() {
  float sum = 0.0, total = 0.0;
  for (int y = 0; y < ROWS; ++y)
    for (int x = 0; x < COLUMNS; ++x) {
      vec2 unit = (vec2(x, y) + 0.5) / vec2(COLUMNS, ROWS);
      vec2 at = unit * vec2(frame.viewport.zw) + vec2(frame.viewport.xy);
      // What a picture is of stands mostly in its middle: the corners weigh 5 % of the centre.
      float weight = exp2(-8.6 * dot(unit - 0.5, unit - 0.5));
      vec3 c = texelFetch(lightBuffer, ivec2(at), 0).rgb;
      // What is no number, or infinite, would turn the whole picture black: it is not metered. Nor is what is perfectly black, where there is nothing to see: a lamp before an empty
      // background would be exposed for the background.
      if (any(isnan(c)) || any(isinf(c)) || c == vec3(0.0)) weight = 0.0, c = vec3(0.0);
      total += weight;
      sum += weight * log2(max(dot(c, vec3(0.2126, 0.7152, 0.0722)) * frame.exposure.y, 1e-6));
    }
  // EV100 = log2(L S / K), S = 100, K = 12.5; saturation luminance 1.2 · 2^EV (Lagarde and de Rousiers 2014, section 5.1).
  float ev = clamp(sum / max(total, 1e-6) + 3.0, -16.0, 24.0);
  outExposure = vec2(frame.exposure.y / (1.2 * exp2(ev)), ev);
}
