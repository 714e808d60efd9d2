// Brings the host's depth into the engine's depth buffer.
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
#include "post/host_depth.glsl"
layout(binding = UNIT_DEPTH) uniform sampler2D hostDepth;
layout(location = 0) uniform vec4 host;

void main() {
  float d = texelFetch(hostDepth, ivec2(gl_FragCoord.xy), 0).r;
  bool empty = host.z > 0.5 ? d <= 0.0 : d >= 1.0;
  float w = distanceOfHost(d, host);
  float z = host.w > 0.5 ? (frame.depthParams.x - w) / frame.depthParams.y : frame.depthParams.x / w - frame.depthParams.y;
  gl_FragDepth = empty ? 0.0 : clamp(z, 0.0, 1.0);
}
