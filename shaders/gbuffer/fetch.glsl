// What the maps and factors say of the surface at this fragment: the G-buffer writes it, the forward path shades it.
// Definitions: GENERAL, ALPHA_TEST, OCCLUSION (0 none, 1 from map C, 2 none on this material, 3 from the third channel of map B), PACKED (1: that channel is an
// occlusion map's, read or not: the normal's z follows from x and y), COVERAGE (1: blended surfaces cover the share of a pixel that map C and the vertex colours say; 0 where it is not defined).
#ifndef COVERAGE
#define COVERAGE 0
#endif
#include "gbuffer/material.glsl"

layout(binding = UNIT_MAP_A) uniform sampler2D mapA;
layout(binding = UNIT_MAP_B) uniform sampler2D mapB;
#if OCCLUSION == 1 || ALPHA_TEST || COVERAGE
layout(binding = UNIT_MAP_C) uniform sampler2D mapC;
#endif
#if GENERAL
layout(binding = UNIT_METAL_ROUGH) uniform sampler2D mapMetalRough;
#endif

struct Fetched {
  vec3 albedo;
  float code;       // of the substance
  float roughness;  // held at BURNISH_ROUGHNESS_MIN
  vec3 normal;      // camera-relative world space, any length
  float occlusion;
  float coverage;
};

// The normal map's direction in camera-relative world space, from the interpolated frame. Without a tangent (zero) only the normal is left; where even that
// vanishes the octahedral code stands for +z. Back faces see the whole frame reversed.
vec3 shadingNormal(vec3 mapped) {
  vec3 b = cross(worldNormal, worldTangent.xyz) * worldTangent.w;
  vec3 m = worldTangent.xyz * mapped.x + b * mapped.y + worldNormal * mapped.z;
  float m2 = dot(m, m);
  m = m2 > 1e-12 ? m : worldNormal;
  return gl_FrontFacing ? m : -m;
}

Fetched fetchMaterial() {
  Fetched f;
  vec4 a = texture(mapA, mapUv(0));
  vec4 b = texture(mapB, mapUv(1));
  f.albedo = a.rgb * material.albedo.rgb;
  f.code = a.a * material.params.x + material.params.y;
  float roughness = b.a * material.params.z;
#if GENERAL
  if (material.more.z > 0.5) f.albedo *= vertexColor.rgb;
  if (material.more.w > 0.5) {
    vec4 mr = texture(mapMetalRough, mapUv(3));
    // Below 0.01 it is plain plastic, as encodeMetalness has it. Map B's alpha holds only the spread of its normals.
    float m = mr.b * material.more.x;
    f.code = m >= 0.01 ? 0.4 + 0.6 * m : 1.0 / 3.0;
    float rough = mr.g * material.params.z;
    float spread = material.more.w < 1.5 ? b.a : 0.0;
    float alpha2 = rough * rough * rough * rough + spread * spread * spread * spread;
    roughness = sqrt(sqrt(alpha2));
  }
#endif
#if OCCLUSION == 1 || ALPHA_TEST || COVERAGE
  vec2 c = texture(mapC, mapUv(2)).rg;
#endif
#if ALPHA_TEST
  float opacity = c.g * material.albedo.a;
#if GENERAL
  if (material.more.z > 0.5) opacity *= vertexColor.a;
#endif
  if (opacity < material.emission.w) discard;
#endif
  f.coverage = 1.0;
#if COVERAGE
  f.coverage = c.g;
#if GENERAL
  if (material.more.z > 0.5) f.coverage *= vertexColor.a;
#endif
#endif
  // 128 is zero: 8-bit normal maps hold flat as (128, 128, 255).
  vec3 mapped = b.rgb * (255.0 / 127.0) - vec3(128.0 / 127.0);
#if PACKED
  mapped.z = sqrt(max(1.0 - mapped.x * mapped.x - mapped.y * mapped.y, 0.0));
#endif
  f.roughness = clamp(roughness, BURNISH_ROUGHNESS_MIN, 1.0);
  f.normal = shadingNormal(mapped);
#if OCCLUSION == 1
  f.occlusion = 1.0 + material.params.w * (c.r - 1.0);
#elif OCCLUSION == 3
  f.occlusion = 1.0 + material.params.w * (b.b - 1.0);
#else
  f.occlusion = 1.0;
#endif
  return f;
}
