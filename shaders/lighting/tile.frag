// Shades the tiles: directional lights, the tile's point and spot lights, and the surroundings. Writes pre-exposed radiance.
// Definitions: TILE_LIGHTS, DIRECTIONAL (count), ENVIRONMENT (0 none, 1 lit by cube and SH), OCCLUSION, ORTHOGRAPHIC, RUNG_GEOMETRY, RUNG_LOBE.
#include "shading/bridge.h"
#include "shading/constants.h"
#include "shading/roughness.h"
#include "shading/normals.h"
#include "shading/albedo.h"
#include "shading/substance.h"
#include "shading/fresnel.h"
#include "shading/lobe.h"
#include "shading/distribution.h"
#include "shading/geometry.h"
#include "shading/light.h"
#include "shading/surface.h"
#include "shading/default_path.h"
#include "shading/environment.h"
#include "interface/layout.h"
#include "interface/surface.glsl"
#include "interface/radiance.glsl"

#if ENVIRONMENT
layout(binding = UNIT_ENVIRONMENT) uniform samplerCube environmentCube;
layout(binding = UNIT_DFG) uniform sampler2D dfgTable;
#endif
layout(location = 0) flat in vec4 ray[3];
#if ENVIRONMENT
layout(location = 3) flat in vec4 irradiance[7];
#endif
#if TILE_LIGHTS > 0
layout(location = 10) flat in vec4 lightData[2 * TILE_LIGHTS];
#elif TILE_LIGHTS < 0
layout(location = 10) flat in ivec2 lightRange;
layout(binding = UNIT_LIGHTS) uniform samplerBuffer lights;
layout(binding = UNIT_LIGHT_LISTS) uniform usamplerBuffer lightLists;
#endif

layout(location = 0) out vec4 outRadiance;

// Punctual light: position + 1/range^4, pre-exposed candela + bias (shading/light.h).
vec3 punctual(Surface m, vec3 p, vec4 place, vec4 color) {
  vec3 l = place.xyz - p;
  float d2 = max(dot(l, l), BURNISH_GUARD_DISTANCE2);
  float inverse = inversesqrt(d2);
  float e = distanceAttenuation(d2, inverse * inverse, place.w, color.w);
  return shadeDirection(m, l * inverse, RUNG_GEOMETRY, RUNG_LOBE) * (color.rgb * e);
}

#if ENVIRONMENT
vec3 surroundings(Surface m, float occlusion) {
  float nov = clamp(m.nov, BURNISH_GUARD_NOV, 1.0);
  float roughness = sqrt(m.alpha);
  vec3 r = m.n * (2.0 * m.nov) - m.v;
  vec2 dfg = texture(dfgTable, vec2(nov, roughness)).rg;
  vec3 reflectance = m.f0 * dfg.x + vec3(dfg.y);
  vec3 specular = textureLod(environmentCube, r, environmentLevel(roughness, irradiance[6].a)).rgb * frame.background.w;
  vec3 diffuse = max(irradianceSh(m.n, irradiance[0].rgb, vec3(irradiance[0].a, irradiance[1].rg), vec3(irradiance[1].ba, irradiance[2].r), irradiance[2].gba,
                                  irradiance[3].rgb, vec3(irradiance[3].a, irradiance[4].rg), vec3(irradiance[4].ba, irradiance[5].r), irradiance[5].gba,
                                  irradiance[6].rgb), vec3(0.0));
#if OCCLUSION
  specular *= specularOcclusion(nov, occlusion, m.alpha);
  diffuse *= occlusion;
#endif
  return specular * reflectance + diffuse * m.diffuse * (vec3(1.0) - reflectance);
}
#endif

void main() {
  ivec2 q = ivec2(gl_FragCoord.xy);
  vec4 a = texelFetch(gbufferA, q, 0);
  vec4 b = texelFetch(gbufferB, q, 0);
  float z = texelFetch(gbufferDepth, q, 0).r;
  vec3 toEye;
  vec3 p = positionAt(gl_FragCoord.xy, max(z, 1e-30), ray[0], ray[1], ray[2], toEye);
  Surface m = surfaceAt(a, b, toEye);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < DIRECTIONAL; ++i)
    sum += shadeDirection(m, frame.directional[2 * i].xyz, RUNG_GEOMETRY, RUNG_LOBE) * frame.directional[2 * i + 1].rgb;
#if TILE_LIGHTS > 0
  for (int i = 0; i < TILE_LIGHTS; ++i) sum += punctual(m, p, lightData[2 * i], lightData[2 * i + 1]);
#elif TILE_LIGHTS < 0
  for (int i = 0; i < lightRange.y; ++i) {
    int light = int(texelFetch(lightLists, lightRange.x + i).x) * LIGHT_TEXELS;
    vec4 place = texelFetch(lights, light);
    vec3 one = punctual(m, p, place, texelFetch(lights, light + 1));
#if TILE_LIGHTS == -2
    vec4 axis = texelFetch(lights, light + 2);
    vec3 toPoint = normalize(p - place.xyz + vec3(1e-20));
    one *= spotAttenuation(dot(axis.xyz, toPoint), axis.w, texelFetch(lights, light + 3).x);
#endif
    sum += one;
  }
#endif
#if ENVIRONMENT
#if OCCLUSION
  float occlusion = texelFetch(gbufferC, q, 0).r;
#else
  float occlusion = 1.0;
#endif
  sum += surroundings(m, occlusion);
#endif
  // Nothing was drawn where z is 0: black there, for a background to replace.
  outRadiance = vec4(z > 0.0 ? limitRadiance(sum, ray[2].w) : vec3(0.0), 1.0);
}
