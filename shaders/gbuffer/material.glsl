// Material inputs of the geometry passes: uv mapping and map lookups.
layout(std140, binding = BINDING_MATERIAL) uniform Material { MaterialData material; };

layout(location = 0) in vec3 worldNormal;
layout(location = 1) in vec4 worldTangent;
layout(location = 2) in vec2 textureUv0;
#if GENERAL
layout(location = 3) in vec2 textureUv1;
layout(location = 4) in vec4 vertexColor;
#endif

// slot: 0 A, 1 B, 2 C, 3 metal-rough, 4 emissive
vec2 mapUv(int slot) {
#if GENERAL
  vec4 u = material.uv[2 * slot], v = material.uv[2 * slot + 1];
  vec3 uv = vec3(u.w > 0.5 ? textureUv1 : textureUv0, 1.0);
  return vec2(dot(u.xyz, uv), dot(v.xyz, uv));
#else
  return textureUv0;
#endif
}
