// Develops the light buffer: exposure, tone curve, sRGB. Definitions: TONEMAP (0 none, 1 Neutral, 2 AgX, 3 ACES), AUTO_EXPOSURE, LINEAR (1: radiance as it is, in cd/m²),
// HOST_DEPTH (1: pixels that the host's own geometry covers are left alone; NORMAL_STORAGE), UPSCALE (1: the picture is smaller than the target's view and enlarged), BLOOM (a share of the light is replaced by what the lens scatters),
// DISPLAY_LUMA (1: for the pass "edge_antialiasing": alpha holds the luma, 0 where the host's geometry is).
#include "shading/bridge.h"
#include "shading/constants.h"
#include "shading/tonemap.h"
#include "interface/develop.glsl"
#include "interface/layout.h"
#include "interface/radiance.glsl"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_LIGHT_BUFFER) uniform sampler2D lightBuffer;
#if AUTO_EXPOSURE
layout(binding = UNIT_EXPOSURE) uniform sampler2D exposureValue;
#endif
#if HOST_DEPTH
#include "shading/normals.h"
#include "interface/stored_normal.glsl"
layout(binding = UNIT_GBUFFER_B) uniform sampler2D gbufferB;
layout(binding = UNIT_DEPTH) uniform sampler2D gbufferDepth;
#endif
#if BLOOM
layout(binding = UNIT_BLOOM) uniform sampler2D bloom;
layout(location = 0) uniform vec3 scattered;  // share; the middles of the view's last texels
#endif
layout(location = 0) out vec4 outColor;

#if UPSCALE
vec3 lightAt(ivec2 q) { return texelFetch(lightBuffer, frame.viewport.xy + clamp(q, ivec2(0), frame.viewport.zw - 1), 0).rgb; }
// Bilinear between the four pixels around `place`, the view's own alone; what is equal stays so to the bit. Where one of them is not finite the nearest is shown as it is, so that it does not spread.
vec3 enlarged(vec2 place) {
  vec2 low = floor(place - 0.5), t = place - 0.5 - low;
  ivec2 q = ivec2(low);
  vec3 a = lightAt(q), b = lightAt(q + ivec2(1, 0)), c = lightAt(q + ivec2(0, 1)), d = lightAt(q + ivec2(1, 1));
  vec3 lower = a + (b - a) * t.x, upper = c + (d - c) * t.x, mean = lower + (upper - lower) * t.y;
  return any(isnan(mean)) || any(isinf(mean)) ? lightAt(ivec2(floor(place))) : mean;
}
#endif

void main() {
#if HOST_DEPTH
  // The G-buffer is cleared to ones, which is no normal: drawn depth without a normal is the host's.
  ivec2 q = ivec2(gl_FragCoord.xy);
  if (texelFetch(gbufferDepth, q, 0).r > 0.0 && isHostPixel(texelFetch(gbufferB, q, 0))) {
#if DISPLAY_LUMA
    outColor = vec4(0.0);
    return;
#else
    discard;
#endif
  }
#endif
#if UPSCALE
  vec2 place = (gl_FragCoord.xy - vec2(frame.target.xy)) * (vec2(frame.viewport.zw) / vec2(frame.target.zw));
  vec3 c = enlarged(place);
#else
  vec2 place = gl_FragCoord.xy - vec2(frame.viewport.xy);
  vec3 c = texelFetch(lightBuffer, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
#if !LINEAR
  // Added emission may have passed the largest half float: infinity would be no number in the curves below.
  c = limitRadiance(c, 65504.0);
#endif
#if BLOOM
  vec2 at = clamp(place * 0.5, vec2(0.5), scattered.yz);
  c = mix(c, textureLod(bloom, at / vec2(textureSize(bloom, 0)), 0.0).rgb, scattered.x);
#endif
#if LINEAR
  outColor = vec4(c * frame.exposure.y, 1.0);
#else
#if AUTO_EXPOSURE
  c *= texelFetch(exposureValue, ivec2(0), 0).r;
#else
  c *= frame.exposure.z;
#endif
  outColor = vec4(developed(c), 1.0);
#if DISPLAY_LUMA
  outColor.a = (1.0 + 254.0 * dot(outColor.rgb, vec3(0.299, 0.587, 0.114))) / 255.0;
#endif
#endif
}
