// One point a tile of 16 x 16 pixels; the tile's lights travel to its fragments in flat varyings.
// So do the pixel rays and the coefficients of irradiance: a software renderer reads a flat varying for less than a uniform (27 of them cost it 7 ms at 1280x720).
// Definitions: ENVIRONMENT, PROBES, TILE_LIGHTS (lights of each tile of this group; 0: none; -1: any number, looped over in the fragment shader; -2: with spots
// among them; -3: with lights among them that cast shadows, which come first).
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_LIGHTS) uniform samplerBuffer lights;
layout(binding = UNIT_LIGHT_LISTS) uniform usamplerBuffer lightLists;

layout(location = 0) in ivec4 tile;  // x, y (tiles, from the viewport's corner), first entry in the lists, number of lights
#if PROBES != 0
layout(location = 1) in ivec4 probes;  // records that may light it, smaller boxes before larger ones; -1 where the list ends
layout(location = 30) flat out ivec4 tileProbes;
#endif

layout(location = 0) flat out vec4 ray[3];  // origin (of the window's pixel 0), x, y; w: depthParams.x, depthParams.y, the light buffer's limit
#if ENVIRONMENT
layout(location = 3) flat out vec4 irradiance[7];  // nine RGB coefficients in a row, then the cube's last level
#endif
#if TILE_LIGHTS > 0
layout(location = 10) flat out vec4 lightData[2 * TILE_LIGHTS];
#elif TILE_LIGHTS < 0
layout(location = 10) flat out ivec3 lightRange;  // first entry, number, how many of them cast shadows
#endif

void main() {
  // The viewport is widened to whole tiles (scissor cuts it back), so that no tile's centre is clipped away.
  vec2 tiles = vec2((frame.viewport.zw + TILE_SIZE - 1) / TILE_SIZE);
  gl_Position = vec4((vec2(tile.xy) + 0.5) / tiles * 2.0 - 1.0, 0.5, 1.0);
  gl_PointSize = float(TILE_SIZE);
  vec3 corner = frame.rayOrigin.xyz - frame.rayX.xyz * float(frame.viewport.x) - frame.rayY.xyz * float(frame.viewport.y);
  ray[0] = vec4(corner, frame.depthParams.x);
  ray[1] = vec4(frame.rayX.xyz, frame.depthParams.y);
  ray[2] = vec4(frame.rayY.xyz, frame.exposure.w);
#if ENVIRONMENT
  irradiance[0] = vec4(frame.irradiance[0].rgb, frame.irradiance[1].r);
  irradiance[1] = vec4(frame.irradiance[1].gb, frame.irradiance[2].rg);
  irradiance[2] = vec4(frame.irradiance[2].b, frame.irradiance[3].rgb);
  irradiance[3] = vec4(frame.irradiance[4].rgb, frame.irradiance[5].r);
  irradiance[4] = vec4(frame.irradiance[5].gb, frame.irradiance[6].rg);
  irradiance[5] = vec4(frame.irradiance[6].b, frame.irradiance[7].rgb);
  irradiance[6] = vec4(frame.irradiance[8].rgb, frame.environment.x);
#endif
#if PROBES
  tileProbes = probes;
#endif
#if TILE_LIGHTS > 0
  for (int i = 0; i < TILE_LIGHTS; ++i) {
    // Lists are padded to the group's size with light 0, which is black.
    int light = int(texelFetch(lightLists, tile.z + i).x) * LIGHT_TEXELS;
    lightData[2 * i] = texelFetch(lights, light);
    lightData[2 * i + 1] = texelFetch(lights, light + 1);
  }
#elif TILE_LIGHTS < 0
  lightRange = ivec3(tile.z, tile.w & 0xffff, tile.w >> 16);
#endif
}
