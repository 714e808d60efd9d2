// How far, in pixels, this surface's point stands from where it stood in the frame before. Definitions: ORTHOGRAPHIC.
#include "interface/layout.h"
#include "interface/previous.glsl"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(location = 4) uniform vec4 past;  // xy jitter of this frame (pixels), zw depthParams of the frame before
layout(location = 0) in vec4 was;
layout(location = 0) out vec4 outVelocity;  // xy pixels, z inverse distance then (1/m), w 1: it moved

void main() {
  vec2 here = gl_FragCoord.xy - vec2(frame.viewport.xy) + past.xy;
  outVelocity = vec4(pixelThen(was, vec2(frame.viewport.zw)) - here, inverseDistanceThen(was, past.zw), 1.0);
}
