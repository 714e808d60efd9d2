// Shades the tiles: directional lights, the tile's point and spot lights, and the surroundings. Writes pre-exposed radiance.
// Definitions: NORMAL_STORAGE, FOG (1: it lies before the surface: interface/fog.glsl), TILE_LIGHTS, DIRECTIONAL (count), ORTHOGRAPHIC, those of interface/shadow.glsl (SHADOW 0: none), DETAIL (1: the tile may show brushed or rough surfaces, which the target
// for them describes), IN_PLACE (1: writes what the display takes, not radiance; TONEMAP) and those of lighting/shade.glsl.
#define ENVIRONMENT_UNIT UNIT_ENVIRONMENT
#include "shading/bridge.h"
#include "shading/all.h"
#include "interface/layout.h"
#include "interface/surface.glsl"
#include "interface/radiance.glsl"
#if IN_PLACE
#include "shading/tonemap.h"
#include "interface/develop.glsl"
#endif

#if FOG
#include "interface/fog.glsl"
#endif

layout(location = 0) flat in vec4 ray[3];
#if ENVIRONMENT
layout(location = 3) flat in vec4 irradiance[7];
vec3 skyAmbientAt(vec3 n) {
  return irradianceSh(n, irradiance[0].rgb, vec3(irradiance[0].a, irradiance[1].rg), vec3(irradiance[1].ba, irradiance[2].r), irradiance[2].gba, irradiance[3].rgb,
                      vec3(irradiance[3].a, irradiance[4].rg), vec3(irradiance[4].ba, irradiance[5].r), irradiance[5].gba, irradiance[6].rgb, RUNG_AMBIENT);
}
float lastLevel() { return irradiance[6].a; }
#endif
#if PROBES
layout(location = 30) flat in ivec4 tileProbes;
int probesNear(vec3 p, out ivec4 list) {
  list = tileProbes;
  return list.x < 0 ? 0 : list.y < 0 ? 1 : list.z < 0 ? 2 : list.w < 0 ? 3 : 4;
}
#endif
#include "lighting/shade.glsl"
#if TILE_LIGHTS > 0
layout(location = 10) flat in vec4 lightData[2 * TILE_LIGHTS];
#elif TILE_LIGHTS < 0
layout(location = 10) flat in ivec3 lightRange;
layout(binding = UNIT_LIGHTS) uniform samplerBuffer lights;
layout(binding = UNIT_LIGHT_LISTS) uniform usamplerBuffer lightLists;
#endif
#if SHADOW
#include "interface/shadow.glsl"
#endif

layout(location = 0) out vec4 outRadiance;

void main() {
  ivec2 q = ivec2(gl_FragCoord.xy);
  vec4 a = texelFetch(gbufferA, q, 0);
  vec4 b = texelFetch(gbufferB, q, 0);
  float z = texelFetch(gbufferDepth, q, 0).r;
#if OCCLUSION
  float occlusion = texelFetch(gbufferC, q, 0).r;
#else
  float occlusion = 1.0;
#endif
  vec3 toEye;
  vec3 p = positionAt(gl_FragCoord.xy, max(z, BURNISH_GUARD_LENGTH), ray[0], ray[1], ray[2], toEye);
#if DETAIL
  Surface m = surfaceAt(a, b, texelFetch(gbufferD, q, 0), toEye);
#else
  Surface m = surfaceAt(a, b, toEye);
#endif
  float row = findEnergy(m);
  vec3 sum = vec3(0.0);
#if SHADOW_SUNS > 0
  for (int i = 0; i < SHADOW_SUNS; ++i) sum += shadeLight(m, frame.directional[2 * i].xyz, row, occlusion) * (frame.directional[2 * i + 1].rgb * sunVisible(i, p, m.n));
#endif
  for (int i = SHADOW_SUNS; i < DIRECTIONAL; ++i) sum += shadeLight(m, frame.directional[2 * i].xyz, row, occlusion) * frame.directional[2 * i + 1].rgb;
#if TILE_LIGHTS > 0
  for (int i = 0; i < TILE_LIGHTS; ++i) sum += punctual(m, p, lightData[2 * i], lightData[2 * i + 1], row, occlusion);
#elif TILE_LIGHTS < 0
  int next = 0;
#if SHADOW_LOCALS
  // Lights with shadows come first.
  for (; next < lightRange.z; ++next) {
    int light = int(texelFetch(lightLists, lightRange.x + next).x) * LIGHT_TEXELS;
    vec4 place = texelFetch(lights, light), more = texelFetch(lights, light + 3);
    vec3 one = punctual(m, p, place, texelFetch(lights, light + 1), row, occlusion) * inCone(p, place, texelFetch(lights, light + 2), more.x);
    sum += one * localVisible(place.xyz, more, p, m.n);
  }
#endif
  for (int i = next; i < lightRange.y; ++i) {
    int light = int(texelFetch(lightLists, lightRange.x + i).x) * LIGHT_TEXELS;
    vec4 place = texelFetch(lights, light);
    vec3 one = punctual(m, p, place, texelFetch(lights, light + 1), row, occlusion);
#if TILE_LIGHTS <= -2
    one *= inCone(p, place, texelFetch(lights, light + 2), texelFetch(lights, light + 3).x);
#endif
    sum += one;
  }
#endif
#if SURROUNDINGS
  sum += surroundings(m, placeAt(p), occlusion);
#endif
#if FOG
  sum = fogged(sum, p, toEye);
#endif
  // Nothing was drawn where z is 0: black there, for a background to replace.
  vec3 radiance = z > 0.0 ? limitRadiance(sum, ray[2].w) : vec3(0.0);
#if IN_PLACE
  radiance = developed(radiance * frame.exposure.z);
#endif
  outRadiance = vec4(radiance, 1.0);
}
