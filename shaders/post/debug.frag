// Debug views of the G-buffer. Definitions: NORMAL_STORAGE, VIEW (1 albedo, 2 substance, 3 normal, 4 roughness, 5 depth, 6 position, 7 occlusion, 9 nonfinite, 10 anisotropy, 11 diffuse roughness), ORTHOGRAPHIC, DETAIL, OCCLUSION, GEOMETRY (0: nothing was drawn).
#include "shading/bridge.h"
#include "shading/constants.h"
#include "shading/roughness.h"
#include "shading/normals.h"
#include "shading/albedo.h"
#include "shading/substance.h"
#include "shading/anisotropy.h"
#include "shading/surface.h"
#include "shading/detail.h"
#include "shading/tonemap.h"
#include "interface/layout.h"
#include "interface/surface.glsl"
#if VIEW == 9
layout(binding = UNIT_LIGHT_BUFFER) uniform sampler2D lightBuffer;
#endif
layout(location = 0) out vec4 outColor;

void main() {
  ivec2 q = ivec2(gl_FragCoord.xy);
  vec4 a = texelFetch(gbufferA, q, 0);
  vec4 b = texelFetch(gbufferB, q, 0);
  float z = texelFetch(gbufferDepth, q, 0).r;
  vec3 toEye;
  vec3 p = positionAt(gl_FragCoord.xy - vec2(frame.viewport.xy), max(z, 1e-30), vec4(frame.rayOrigin.xyz, frame.depthParams.x),
                      vec4(frame.rayX.xyz, frame.depthParams.y), frame.rayY, toEye);
  vec3 c = vec3(0.0);
  if (GEOMETRY == 1 && z > 0.0) {
#if VIEW == 1
    c = decodeAlbedo(a.rgb);
#elif VIEW == 2
    c = substanceF0(a.a, decodeAlbedo(a.rgb));
#elif VIEW == 3
    vec3 n = storedNormal(b);
    c = vec3(linearFromSrgb(n.x * 0.5 + 0.5), linearFromSrgb(n.y * 0.5 + 0.5), linearFromSrgb(n.z * 0.5 + 0.5));
#elif VIEW == 4
    c = vec3(linearFromSrgb(sqrt(decodeAlpha(b.a))));
#elif VIEW == 5
    // 0.5 at 10 m, white near, black far: 10 / (10 + distance)
    c = vec3(linearFromSrgb(10.0 / (10.0 + dot(p, frame.forward.xyz))));
#elif VIEW == 6
    c = fract(p + frame.eye.xyz);
#elif VIEW == 7
#if OCCLUSION
    c = vec3(linearFromSrgb(texelFetch(gbufferC, q, 0).r));
#else
    c = vec3(1.0);
#endif
#elif VIEW == 10 && DETAIL
    // The direction that it is brushed along, as a line has it (no sign), as bright as the lobe is long; black: a round one.
    Surface m = surfaceAt(a, b, texelFetch(gbufferD, q, 0), vec3(0.0, 0.0, 1.0));
    vec3 along = abs(unpackTangent(storedNormal(b), texelFetch(gbufferD, q, 0))) * sqrt(1.0 - m.alphaY / m.alphaX);
    c = vec3(linearFromSrgb(along.x), linearFromSrgb(along.y), linearFromSrgb(along.z));
#elif VIEW == 11 && DETAIL
    c = vec3(linearFromSrgb(texelFetch(gbufferD, q, 0).a));
#endif
  }
#if VIEW == 9
  vec3 r = texelFetch(lightBuffer, q, 0).rgb;
  bool bad = any(isnan(r)) || any(isinf(r));
  c = bad ? vec3(1.0, 0.0, 0.0) : vec3(0.02);
#endif
  outColor = vec4(srgbFromLinear(c.r), srgbFromLinear(c.g), srgbFromLinear(c.b), 1.0);
}
