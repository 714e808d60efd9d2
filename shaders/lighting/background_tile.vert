// One point a tile of 16 x 16 pixels that shows the background, at depth 0 (the far plane of reversed depth).
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(location = 0) in ivec4 tile;  // x, y (tiles, from the viewport's corner)

void main() {
  vec2 tiles = vec2((frame.viewport.zw + TILE_SIZE - 1) / TILE_SIZE);
  gl_Position = vec4((vec2(tile.xy) + 0.5) / tiles * 2.0 - 1.0, 0.0, 1.0);
  gl_PointSize = float(TILE_SIZE);
}
