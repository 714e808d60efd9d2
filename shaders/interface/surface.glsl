// From the G-buffer to a Surface: position, view vector and material at the current fragment.
// Definitions: NORMAL_STORAGE, ORTHOGRAPHIC, OCCLUSION, DETAIL (1: there is a target for brushed and rough surfaces).
#include "interface/stored_normal.glsl"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_GBUFFER_A) uniform sampler2D gbufferA;
layout(binding = UNIT_GBUFFER_B) uniform sampler2D gbufferB;
layout(binding = UNIT_DEPTH) uniform sampler2D gbufferDepth;
#if OCCLUSION
layout(binding = UNIT_GBUFFER_C) uniform sampler2D gbufferC;
#endif
#if DETAIL
layout(binding = UNIT_GBUFFER_D) uniform sampler2D gbufferD;
#endif

// Camera-relative world position (m) of a fragment whose depth is z. origin, x, y: FrameData's rays with depthParams.x and .y in the first two's w.
vec3 positionAt(vec2 pixel, float z, vec4 origin, vec4 x, vec4 y, out vec3 toEye) {
  vec3 ray = origin.xyz + x.xyz * pixel.x + y.xyz * pixel.y;
#if ORTHOGRAPHIC
  toEye = -frame.forward.xyz;
  return ray + frame.forward.xyz * (origin.w - z * x.w);
#else
  toEye = ray * -inversesqrt(dot(ray, ray));
  return ray * (origin.w / (z + x.w));
#endif
}

Surface surfaceAt(vec4 a, vec4 b, vec3 toEye) { return makeSurface(storedNormal(b), toEye, decodeAlbedo(a.rgb), a.a, decodeAlpha(b.a)); }

#if DETAIL
Surface surfaceAt(vec4 a, vec4 b, vec4 d, vec3 toEye) {
  vec3 n = storedNormal(b);
  Surface m = makeSurface(n, toEye, decodeAlbedo(a.rgb), a.a, decodeAlpha(b.a));
  setWidth(m, unpackTangent(n, d), decodeAlpha(d.b));
  m.sigma = d.a;
  return m;
}
#endif
