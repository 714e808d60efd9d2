// Background where nothing was drawn (depth test: equal to the far plane). Definitions: ORTHOGRAPHIC, SKY_MAP (0 colour, 1 lat-long picture).
#include "shading/bridge.h"
#include "shading/constants.h"
#include "interface/layout.h"
#include "interface/radiance.glsl"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
#if SKY_MAP
layout(binding = UNIT_ENVIRONMENT) uniform sampler2D skyMap;
#endif
layout(location = 0) out vec4 outRadiance;

void main() {
#if SKY_MAP
#if ORTHOGRAPHIC
  vec3 d = frame.forward.xyz;
#else
  vec2 pixel = gl_FragCoord.xy - vec2(frame.viewport.xy);
  vec3 d = normalize(frame.rayOrigin.xyz + frame.rayX.xyz * pixel.x + frame.rayY.xyz * pixel.y);
#endif
  // u = 1/2 looks along -Z, u grows toward +X; the picture's first row is the zenith.
  vec2 uv = vec2(0.5 + atan(d.x, -d.z) / (2.0 * BURNISH_PI), acos(clamp(d.y, -1.0, 1.0)) / BURNISH_PI);
  vec3 c = textureLod(skyMap, uv, 0.0).rgb * frame.background.w;
#else
  vec3 c = frame.background.rgb;
#endif
  outRadiance = vec4(limitRadiance(c, frame.exposure.w), 1.0);
}
