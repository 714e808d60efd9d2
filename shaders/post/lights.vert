// One point a tile, coloured by its number of lights.
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(location = 0) in ivec4 tile;
layout(location = 0) flat out int lightCount;
void main() {
  vec2 tiles = vec2((frame.viewport.zw + TILE_SIZE - 1) / TILE_SIZE);
  gl_Position = vec4((vec2(tile.xy) + 0.5) / tiles * 2.0 - 1.0, 0.5, 1.0);
  gl_PointSize = float(TILE_SIZE);
  lightCount = tile.w & 0xffff;
}
