// The next mip level of the copied picture: (1 3 3 1)/8 each way, as four bilinear taps. Reads level `from` alone; stays inside the view. What is not finite is left out.
#include "interface/layout.h"
#include "interface/radiance.glsl"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_SCENE_COLOR) uniform sampler2D sceneColor;
layout(location = 0) uniform int from;
layout(location = 0) out vec4 outColor;

vec3 tap(vec2 uv) {
  vec2 texel = 1.0 / vec2(textureSize(sceneColor, from)), end = vec2(frame.viewport.zw) / vec2(textureSize(sceneColor, 0));
  vec3 c = textureLod(sceneColor, clamp(uv, 0.5 * texel, max(end - 0.5 * texel, 0.5 * texel)), float(from)).rgb;  // model: the view ends here
  return firmRadiance(c, frame.exposure.w);
}

void main() {
  vec2 uv = gl_FragCoord.xy / vec2(textureSize(sceneColor, from + 1));
  vec2 step = 0.75 / vec2(textureSize(sceneColor, from));
  outColor = vec4(0.25 * (tap(uv + vec2(-step.x, -step.y)) + tap(uv + vec2(step.x, -step.y)) + tap(uv + vec2(-step.x, step.y)) + tap(uv + step)), 1.0);
}
