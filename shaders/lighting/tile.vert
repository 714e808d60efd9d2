// One point a tile of 16 x 16 pixels; the tile's lights travel to its fragments in flat varyings.
// Definitions: TILE_LIGHTS (lights of each tile of this group; 0: none; -1: any number, looped over in the fragment shader).
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_LIGHTS) uniform samplerBuffer lights;
layout(binding = UNIT_LIGHT_LISTS) uniform usamplerBuffer lightLists;

layout(location = 0) in ivec4 tile;  // x, y (tiles, from the viewport's corner), first entry in the lists, number of lights

#if TILE_LIGHTS > 0
layout(location = 0) flat out vec4 lightData[2 * TILE_LIGHTS];
#elif TILE_LIGHTS < 0
layout(location = 0) flat out ivec2 lightRange;
#endif

void main() {
  // The viewport is widened to whole tiles (scissor cuts it back), so that no tile's centre is clipped away.
  vec2 tiles = vec2((frame.viewport.zw + TILE_SIZE - 1) / TILE_SIZE);
  gl_Position = vec4((vec2(tile.xy) + 0.5) / tiles * 2.0 - 1.0, 0.5, 1.0);
  gl_PointSize = float(TILE_SIZE);
#if TILE_LIGHTS > 0
  for (int i = 0; i < TILE_LIGHTS; ++i) {
    // Lists are padded to the group's size with light 0, which is black.
    int light = int(texelFetch(lightLists, tile.z + i).x) * LIGHT_TEXELS;
    lightData[2 * i] = texelFetch(lights, light);
    lightData[2 * i + 1] = texelFetch(lights, light + 1);
  }
#elif TILE_LIGHTS < 0
  lightRange = tile.zw;
#endif
}
