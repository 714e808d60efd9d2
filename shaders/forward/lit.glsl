// What the forward programs share: the surface at this fragment and its light from every light of the scene.
// Definitions: DIRECTIONAL (count), FOG, LOCAL (1: point and spot lights), ORTHOGRAPHIC, those of interface/shadow.glsl (SHADOW 0: none), of gbuffer/fetch.glsl and of lighting/shade.glsl.
#define ENVIRONMENT_UNIT UNIT_FORWARD_ENVIRONMENT
#include "shading/bridge.h"
#include "shading/all.h"
#include "interface/layout.h"
#include "interface/radiance.glsl"
#include "gbuffer/fetch.glsl"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
#if LOCAL
layout(binding = UNIT_LIGHTS) uniform samplerBuffer lights;
#endif
#if ENVIRONMENT
vec3 skyAmbientAt(vec3 n) {
  return irradianceSh(n, frame.irradiance[0].rgb, frame.irradiance[1].rgb, frame.irradiance[2].rgb, frame.irradiance[3].rgb, frame.irradiance[4].rgb, frame.irradiance[5].rgb,
                      frame.irradiance[6].rgb, frame.irradiance[7].rgb, frame.irradiance[8].rgb, RUNG_AMBIENT);
}
float lastLevel() { return frame.environment.x; }
#endif
#if PROBES
int probesNear(vec3 p, out ivec4 list);
#endif
#include "lighting/shade.glsl"
#if PROBES
// Of all that are in view: the boxes that p lies in, or those within whose margins it lies. What tiles do to the boxes that meet them.
int probesNear(vec3 p, out ivec4 list) {
  list = ivec4(0);
  int count = 0;
  bool inside = false;
  float slack = frame.probes.z * sqrt(dot(p, p)) + frame.probes.w;
  for (int i = 0; i < int(frame.probes.x); ++i) {
    vec4 extent = texelFetch(probeRecords, i * PROBE_TEXELS + 3);
    float away = probeDistance(inBox(i * PROBE_TEXELS, p), extent.xyz + slack);
    bool first = away <= 0.0 && !inside;
    if (first) count = 0;
    inside = inside || first;
    if (count == MAX_TILE_PROBES || (inside ? away > 0.0 : away >= extent.w)) continue;
    list[count] = i;
    ++count;
  }
  return count;
}
#endif
#if FOG
#include "interface/fog.glsl"
#endif
#if SHADOW
#include "interface/shadow.glsl"
#endif

Surface surfaceHere(Fetched f, vec3 toEye) {
  float n2 = dot(f.normal, f.normal);
  vec3 n = n2 > BURNISH_GUARD_LENGTH ? f.normal * inversesqrt(n2) : vec3(0.0, 0.0, 1.0);
  Surface m = makeSurface(n, toEye, vec3(unitClamp(f.albedo.r), unitClamp(f.albedo.g), unitClamp(f.albedo.b)), unitClamp(f.code), f.alpha);
  m.eta = material.conductorEta.rgb;
  m.k = material.conductorK.rgb;
#if ANISOTROPIC
  setWidth(m, brushedTangent(), brushedAlphaX(m.alpha));
#endif
#if ROUGH_DIFFUSE
  m.sigma = material.attenuation.w;
#endif
  return m;
}

// Camera-relative world position (m) of this fragment, and the unit vector to the eye.
vec3 positionHere(out vec3 toEye) {
  vec3 ray = frame.rayOrigin.xyz + frame.rayX.xyz * (gl_FragCoord.x - float(frame.viewport.x)) + frame.rayY.xyz * (gl_FragCoord.y - float(frame.viewport.y));
#if ORTHOGRAPHIC
  toEye = -frame.forward.xyz;
  return ray + frame.forward.xyz * (frame.depthParams.x - gl_FragCoord.z * frame.depthParams.y);
#else
  toEye = ray * -inversesqrt(dot(ray, ray));
  return ray * (frame.depthParams.x / (gl_FragCoord.z + frame.depthParams.y));
#endif
}

// Radiance toward the eye from directional, point and spot lights. row: findEnergy's.
vec3 litByLights(Surface m, vec3 p, float row, float occlusion) {
  vec3 sum = vec3(0.0);
#if SHADOW_SUNS > 0
  for (int i = 0; i < SHADOW_SUNS; ++i) sum += shadeLight(m, frame.directional[2 * i].xyz, row, occlusion) * (frame.directional[2 * i + 1].rgb * sunVisible(i, p, m.n));
#endif
  for (int i = SHADOW_SUNS; i < DIRECTIONAL; ++i) sum += shadeLight(m, frame.directional[2 * i].xyz, row, occlusion) * frame.directional[2 * i + 1].rgb;
#if LOCAL
  int count = int(frame.environment.y), first = 1;
#if SHADOW_LOCALS
  for (; first <= int(shadows.params.z); ++first) {
    vec4 place = texelFetch(lights, first * LIGHT_TEXELS), more = texelFetch(lights, first * LIGHT_TEXELS + 3);
    vec3 one = punctual(m, p, place, texelFetch(lights, first * LIGHT_TEXELS + 1), row, occlusion) * inCone(p, place, texelFetch(lights, first * LIGHT_TEXELS + 2), more.x);
    sum += one * localVisible(place.xyz, more, p, m.n);
  }
#endif
  for (int i = first; i <= count; ++i) {
    vec4 place = texelFetch(lights, i * LIGHT_TEXELS);
    vec3 one = punctual(m, p, place, texelFetch(lights, i * LIGHT_TEXELS + 1), row, occlusion);
    sum += one * inCone(p, place, texelFetch(lights, i * LIGHT_TEXELS + 2), texelFetch(lights, i * LIGHT_TEXELS + 3).x);
  }
#endif
  return sum;
}
