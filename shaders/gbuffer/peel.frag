// One layer of transparent surfaces: keeps what lies nearer than the layer before (or than what is opaque). The depth test keeps the farthest of it. Definitions: GENERAL, ALPHA_TEST.
#include "interface/layout.h"
layout(binding = UNIT_SCENE_DEPTH) uniform sampler2D depthBefore;
#include "gbuffer/material.glsl"
#if ALPHA_TEST
layout(binding = UNIT_MAP_C) uniform sampler2D mapC;
#endif

void main() {
#if ALPHA_TEST
  float opacity = texture(mapC, mapUv(2)).g * material.albedo.a;
#if GENERAL
  if (material.more.z > 0.5) opacity *= vertexColor.a;
#endif
  if (opacity < material.emission.w) discard;
#endif
  if (gl_FragCoord.z <= texelFetch(depthBefore, ivec2(gl_FragCoord.xy), 0).r) discard;
}
