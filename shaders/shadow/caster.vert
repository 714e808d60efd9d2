// What casts a shadow, from the light: object space to the map's clip space. Every instance's matrix comes as an attribute, so that one call draws all that share vertices.
// Definitions: ALPHA_TEST 1 = it has holes; GENERAL 1 = second uv set, uv transforms, vertex colour.
#include "interface/layout.h"
layout(location = ATTRIBUTE_POSITION) in vec3 position;
layout(location = ATTRIBUTE_DRAW) in vec4 clip[4];
#if ALPHA_TEST
layout(std140, binding = BINDING_MATERIAL) uniform Material { MaterialData material; };
layout(location = ATTRIBUTE_UV0) in vec2 uv0;
layout(location = 0) out vec2 mapUv;
#if GENERAL
layout(location = ATTRIBUTE_UV1) in vec2 uv1;
layout(location = ATTRIBUTE_COLOR) in vec4 color;
layout(location = 0) uniform float hasColors;
layout(location = 1) out float vertexAlpha;
#endif
#endif

void main() {
  gl_Position = mat4(clip[0], clip[1], clip[2], clip[3]) * vec4(position, 1.0);
#if ALPHA_TEST
#if GENERAL
  vec4 u = material.uv[4], v = material.uv[5];  // map C's
  vec3 uv = vec3(u.w > 0.5 ? uv1 : uv0, 1.0);
  mapUv = vec2(dot(u.xyz, uv), dot(v.xyz, uv));
  vertexAlpha = hasColors > 0.5 && material.more.z > 0.5 ? color.a : 1.0;
#else
  mapUv = uv0;
#endif
#endif
}
