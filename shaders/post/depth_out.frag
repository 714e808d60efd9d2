// Gives the engine's depth to the host's framebuffer. Definitions: GEOMETRY (0: nothing was drawn), UPSCALE (1: the depth buffer is smaller than the target: the nearest pixel's).
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
#include "post/host_depth.glsl"
layout(binding = UNIT_DEPTH) uniform sampler2D gbufferDepth;
layout(location = 0) uniform vec4 host;

void main() {
#if GEOMETRY && UPSCALE
  vec2 place = (gl_FragCoord.xy - vec2(frame.target.xy)) * (vec2(frame.viewport.zw) / vec2(frame.target.zw));
  float z = texelFetch(gbufferDepth, frame.viewport.xy + clamp(ivec2(place), ivec2(0), frame.viewport.zw - 1), 0).r;
#elif GEOMETRY
  float z = texelFetch(gbufferDepth, ivec2(gl_FragCoord.xy), 0).r;
#else
  float z = 0.0;
#endif
  float w = host.w > 0.5 ? frame.depthParams.x - z * frame.depthParams.y : frame.depthParams.x / (z + frame.depthParams.y);
  gl_FragDepth = z > 0.0 ? hostOfDistance(w, host) : (host.z > 0.5 ? 0.0 : 1.0);
}
