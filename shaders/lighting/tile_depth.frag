// Nearest and farthest depth of each tile of 16 x 16 pixels, one texel a tile: what TileDepth holds. Texels of value 0 hold nothing.
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_DEPTH) uniform sampler2D gbufferDepth;
layout(location = 0) out vec2 outDepth;

void main() {
  ivec2 corner = ivec2(gl_FragCoord.xy) * TILE_SIZE;
  ivec2 end = min(corner + TILE_SIZE, frame.viewport.zw);
  float near = 0.0, far = 2.0;
  for (int y = corner.y; y < end.y; ++y)
    for (int x = corner.x; x < end.x; ++x) {
      float z = texelFetch(gbufferDepth, ivec2(x, y) + frame.viewport.xy, 0).r;
      near = max(near, z);
      far = min(far, z > 0.0 ? z : 2.0);
    }
  outDepth = vec2(near, near > 0.0 ? far : -1.0);
}
