// Emission into the light buffer: a depth-equal, additive draw of the emissive objects, so that the G-buffer need not widen.
// Definitions: GENERAL, ALPHA_TEST, FOG (1: it lies before the surface; DIRECTIONAL, FOG_AMBIENT, ORTHOGRAPHIC: interface/fog.glsl).
#include "interface/layout.h"
#include "interface/radiance.glsl"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
#if FOG
#include "shading/bridge.h"
#include "shading/constants.h"
#include "shading/fog.h"
#include "interface/fog.glsl"
#endif
#include "gbuffer/material.glsl"

layout(binding = UNIT_MAP_A) uniform sampler2D mapA;
layout(binding = UNIT_EMISSIVE) uniform sampler2D mapEmissive;
#if ALPHA_TEST
layout(binding = UNIT_MAP_C) uniform sampler2D mapC;
#endif

layout(location = 0) out vec4 outRadiance;

#if FOG
// What it gives off through the fog. What the fog itself shows is in the picture already, except under what is unlit, which replaces it.
vec3 emittedThroughFog(vec3 radiance, float alone) {
  vec3 ray = frame.rayOrigin.xyz + frame.rayX.xyz * (gl_FragCoord.x - float(frame.viewport.x)) + frame.rayY.xyz * (gl_FragCoord.y - float(frame.viewport.y));
#if ORTHOGRAPHIC
  vec3 p = ray + frame.forward.xyz * (frame.depthParams.x - gl_FragCoord.z * frame.depthParams.y), d = frame.forward.xyz;
#else
  vec3 p = ray * (frame.depthParams.x / (gl_FragCoord.z + frame.depthParams.y)), d = normalize(ray);
#endif
  float depth = fogDepthTo(p);
  return radiance * fogThrough(depth) + fogSource(d) * (alone * fogTaken(depth));
}
#endif

void main() {
  vec3 unlit = texture(mapA, mapUv(0)).rgb * material.albedo.rgb * material.more.y;
#if GENERAL
  if (material.more.z > 0.5) unlit *= vertexColor.rgb;
#endif
#if ALPHA_TEST
  float opacity = texture(mapC, mapUv(2)).g * material.albedo.a;
#if GENERAL
  if (material.more.z > 0.5) opacity *= vertexColor.a;
#endif
  if (opacity < material.emission.w) discard;
#endif
  vec3 radiance = (texture(mapEmissive, mapUv(4)).rgb * material.emission.rgb + unlit) * frame.exposure.x;
#if FOG
  radiance = emittedThroughFog(radiance, material.more.y > 0.5 ? 1.0 : 0.0);
#endif
  outRadiance = vec4(limitRadiance(radiance, frame.exposure.w), 0.0);
}
