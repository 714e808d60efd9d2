// Depth alone. Definitions: ALPHA_TEST 1 = what is under the cutoff casts nothing; GENERAL.
#if ALPHA_TEST
#include "interface/layout.h"
layout(std140, binding = BINDING_MATERIAL) uniform Material { MaterialData material; };
layout(binding = UNIT_MAP_C) uniform sampler2D mapC;
layout(location = 0) in vec2 mapUv;
#if GENERAL
layout(location = 1) in float vertexAlpha;
#endif
#endif

void main() {
#if ALPHA_TEST
  float opacity = texture(mapC, mapUv).g * material.albedo.a;
#if GENERAL
  opacity *= vertexAlpha;
#endif
  if (opacity < material.emission.w) discard;
#endif
}
