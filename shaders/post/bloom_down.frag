// The next level of the bloom, by [1 3 3 1]/8 an axis in four bilinear lookups: each lies a quarter of a texel from the heavier of its two texels.
#include "interface/layout.h"
layout(binding = UNIT_BLOOM) uniform sampler2D bloom;  // the level above is its base level
layout(location = 0) uniform vec2 last;                // the middle of the view's last texel there
layout(location = 0) out vec4 outLight;

vec3 lightAt(vec2 texel, vec2 scale) { return textureLod(bloom, clamp(texel, vec2(0.5), last) * scale, 0.0).rgb; }

void main() {
  vec2 middle = gl_FragCoord.xy * 2.0, scale = 1.0 / vec2(textureSize(bloom, 0));
  vec3 sum = lightAt(middle + vec2(-0.75, -0.75), scale) + lightAt(middle + vec2(0.75, -0.75), scale) + lightAt(middle + vec2(-0.75, 0.75), scale) + lightAt(middle + vec2(0.75, 0.75), scale);
  outLight = vec4(sum * 0.25, 1.0);
}
