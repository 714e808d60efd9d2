// The instance under a pixel: index + 1 (0 is nothing). Definitions: GENERAL, ALPHA_TEST.
#include "interface/layout.h"
layout(std140, binding = BINDING_DRAW) uniform Draw { DrawData draw; };
#include "gbuffer/material.glsl"
#if ALPHA_TEST
layout(binding = UNIT_MAP_C) uniform sampler2D mapC;
#endif
layout(location = 0) out uint outInstance;

void main() {
#if ALPHA_TEST
  float opacity = texture(mapC, mapUv(2)).g * material.albedo.a;
#if GENERAL
  if (material.more.z > 0.5) opacity *= vertexColor.a;
#endif
  if (opacity < material.emission.w) discard;
#endif
  outInstance = uint(draw.normal[0].w);
}
