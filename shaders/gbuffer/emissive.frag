// Emission into the light buffer: a depth-equal, additive draw of the emissive objects, so that the G-buffer need not widen.
// Definitions: GENERAL, ALPHA_TEST.
#include "interface/layout.h"
#include "interface/radiance.glsl"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
#include "gbuffer/material.glsl"

layout(binding = UNIT_MAP_A) uniform sampler2D mapA;
layout(binding = UNIT_EMISSIVE) uniform sampler2D mapEmissive;
#if ALPHA_TEST
layout(binding = UNIT_MAP_C) uniform sampler2D mapC;
#endif

layout(location = 0) out vec4 outRadiance;

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
  outRadiance = vec4(limitRadiance(radiance, frame.exposure.w), 0.0);
}
