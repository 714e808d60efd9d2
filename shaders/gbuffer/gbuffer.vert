// Geometry into the G-buffer, the emissive pass and the pick pass: object space to clip space, directions to camera-relative world.
// Definitions: GENERAL 1 = second uv set, uv transforms, vertex colour; INSTANCED 1 = DrawData comes as attributes that advance by instance (not more to read for each vertex than that:
// a single draw reads it from a block, which costs a software renderer less).
#include "interface/layout.h"

#if INSTANCED
layout(location = ATTRIBUTE_DRAW) in vec4 drawVector[DRAW_VECTORS];
#define DRAW_CLIP mat4(drawVector[0], drawVector[1], drawVector[2], drawVector[3])
#define DRAW_MODEL(r) drawVector[4 + r]
#define DRAW_NORMAL(r) drawVector[7 + r]
#else
layout(std140, binding = BINDING_DRAW) uniform Draw { DrawData draw; };
#define DRAW_CLIP draw.clip
#define DRAW_MODEL(r) draw.model[r]
#define DRAW_NORMAL(r) draw.normal[r]
#endif

layout(location = ATTRIBUTE_POSITION) in vec3 position;
layout(location = ATTRIBUTE_NORMAL) in vec4 normal;
layout(location = ATTRIBUTE_TANGENT) in vec4 tangent;
layout(location = ATTRIBUTE_UV0) in vec2 uv0;

layout(location = 0) out vec3 worldNormal;
layout(location = 1) out vec4 worldTangent;
layout(location = 2) out vec2 textureUv0;
#if GENERAL
layout(location = ATTRIBUTE_UV1) in vec2 uv1;
layout(location = ATTRIBUTE_COLOR) in vec4 color;
layout(location = 3) out vec2 textureUv1;
layout(location = 4) out vec4 vertexColor;
#endif

invariant gl_Position;

// Zero stays zero.
vec3 unit(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-30)); }

void main() {
  vec4 p = vec4(position, 1.0);
  gl_Position = DRAW_CLIP * p;
  // Unit length at the vertices, interpolated as they are: the frame that normal maps are baked for (Mikkelsen 2008, section 4).
  worldNormal = unit(vec3(dot(DRAW_NORMAL(0).xyz, normal.xyz), dot(DRAW_NORMAL(1).xyz, normal.xyz), dot(DRAW_NORMAL(2).xyz, normal.xyz)));
  // The bitangent goes through the transform as it is: where that mirrors, the cross product of the other two is its opposite.
  worldTangent = vec4(unit(vec3(dot(DRAW_MODEL(0).xyz, tangent.xyz), dot(DRAW_MODEL(1).xyz, tangent.xyz), dot(DRAW_MODEL(2).xyz, tangent.xyz))), tangent.w * DRAW_NORMAL(2).w);
  textureUv0 = uv0;
#if GENERAL
  textureUv1 = uv1;
  vertexColor = DRAW_NORMAL(1).w != 0.0 ? color : vec4(1.0);
#endif
}
