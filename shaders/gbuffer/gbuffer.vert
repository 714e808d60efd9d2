// Geometry into the G-buffer, the emissive pass and the pick pass: object space to clip space, directions to camera-relative world.
// Definitions: GENERAL 1 = second uv set, uv transforms, vertex colour.
#include "interface/layout.h"

layout(std140, binding = BINDING_DRAW) uniform Draw { DrawData draw; };

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
  gl_Position = draw.clip * p;
  // Unit length at the vertices, interpolated as they are: the frame that normal maps are baked for (Mikkelsen 2008, section 4).
  worldNormal = unit(vec3(dot(draw.normal[0].xyz, normal.xyz), dot(draw.normal[1].xyz, normal.xyz), dot(draw.normal[2].xyz, normal.xyz)));
  worldTangent = vec4(unit(vec3(dot(draw.model[0].xyz, tangent.xyz), dot(draw.model[1].xyz, tangent.xyz), dot(draw.model[2].xyz, tangent.xyz))), tangent.w);
  textureUv0 = uv0;
#if GENERAL
  textureUv1 = uv1;
  vertexColor = draw.ids.y != 0 ? color : vec4(1.0);
#endif
}
