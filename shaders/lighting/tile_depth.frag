// Depth range of each tile of 16 x 16 pixels, one texel a tile: what TileDepth (engine/lighting/light_tiles.h) holds. Texels of value 0 hold nothing.
// Definitions: ORTHOGRAPHIC.
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_DEPTH) uniform sampler2D gbufferDepth;
layout(location = 0) out vec4 outDepth;

float distanceAt(float z) {
#if ORTHOGRAPHIC
  return frame.depthParams.x - z * frame.depthParams.y;
#else
  return frame.depthParams.x / (z + frame.depthParams.y);
#endif
}

void main() {
  ivec2 corner = ivec2(gl_FragCoord.xy) * TILE_SIZE;
  ivec2 end = min(corner + TILE_SIZE, frame.viewport.zw);
  float near = 0.0, far = 2.0, least = 2.0;
  for (int y = corner.y; y < end.y; ++y)
    for (int x = corner.x; x < end.x; ++x) {
      float z = texelFetch(gbufferDepth, ivec2(x, y) + frame.viewport.xy, 0).r;
      near = max(near, z);
      least = min(least, z);
      far = min(far, z > 0.0 ? z : 2.0);
    }
  float middle = 0.5 * (distanceAt(near) + distanceAt(far));
  float nearEnd = near, farBegin = far;
  for (int y = corner.y; y < end.y; ++y)
    for (int x = corner.x; x < end.x; ++x) {
      float z = texelFetch(gbufferDepth, ivec2(x, y) + frame.viewport.xy, 0).r;
      bool inNear = distanceAt(z) <= middle;
      nearEnd = min(nearEnd, inNear && z > 0.0 ? z : near);
      farBegin = max(farBegin, !inNear && z > 0.0 ? z : far);
    }
  outDepth = near > 0.0 ? vec4(near, least > 0.0 ? nearEnd : -nearEnd, farBegin, far) : vec4(0.0, 0.0, 0.0, -1.0);
}
