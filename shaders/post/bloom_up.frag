// The level below, doubled (Chaikin's weights 1/4 and 3/4: one bilinear lookup) and mixed into this one by the blend colour.
#include "interface/layout.h"
layout(binding = UNIT_BLOOM) uniform sampler2D bloom;  // the level below is its base level
layout(location = 0) uniform vec2 last;                // the middle of the view's last texel there
layout(location = 0) out vec4 outLight;

void main() { outLight = vec4(textureLod(bloom, clamp(gl_FragCoord.xy * 0.5, vec2(0.5), last) / vec2(textureSize(bloom, 0)), 0.0).rgb, 1.0); }
