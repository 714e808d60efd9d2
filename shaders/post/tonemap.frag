// Develops the light buffer: exposure, tone curve, sRGB. Definitions: TONEMAP (0 none, 1 Neutral, 2 AgX, 3 ACES), AUTO_EXPOSURE, LINEAR (1: radiance as it is, in cd/m²),
// HOST_DEPTH (1: pixels that the host's own geometry covers are left alone).
#include "shading/bridge.h"
#include "shading/constants.h"
#include "shading/tonemap.h"
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_LIGHT_BUFFER) uniform sampler2D lightBuffer;
#if AUTO_EXPOSURE
layout(binding = UNIT_EXPOSURE) uniform sampler2D exposureValue;
#endif
#if HOST_DEPTH
layout(binding = UNIT_GBUFFER_B) uniform sampler2D gbufferB;
layout(binding = UNIT_DEPTH) uniform sampler2D gbufferDepth;
#endif
layout(location = 0) out vec4 outColor;

void main() {
#if HOST_DEPTH
  // The G-buffer is cleared to ones, which is no normal: drawn depth without a normal is the host's.
  ivec2 q = ivec2(gl_FragCoord.xy);
  if (texelFetch(gbufferDepth, q, 0).r > 0.0 && texelFetch(gbufferB, q, 0).rgb == vec3(1.0)) discard;
#endif
  vec3 c = texelFetch(lightBuffer, ivec2(gl_FragCoord.xy), 0).rgb;
#if LINEAR
  outColor = vec4(c * frame.exposure.y, 1.0);
#else
#if AUTO_EXPOSURE
  c *= texelFetch(exposureValue, ivec2(0), 0).r;
#else
  c *= frame.exposure.z;
#endif
#if TONEMAP == 1
  c = tonemapNeutral(c);
#elif TONEMAP == 2
  c = tonemapAgx(c);
#elif TONEMAP == 3
  c = tonemapAces(c);
#else
  c = tonemapNone(c);
#endif
  outColor = vec4(srgbFromLinearFast(c.r), srgbFromLinearFast(c.g), srgbFromLinearFast(c.b), 1.0);
#endif
}
