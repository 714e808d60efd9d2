// Background where nothing was drawn (depth test: equal to the far plane). Definitions: ORTHOGRAPHIC, SKY_MAP (0 colour, 1 lat-long picture, 2 nothing: the fog
// alone shows), SUN (1: with the sun's disc), FOG (1: as far as it reaches; DIRECTIONAL and FOG_AMBIENT, interface/fog.glsl), IN_PLACE (1: writes what the
// display takes into a framebuffer that has no depth: what is drawn over is found in the depth texture; TONEMAP).
#include "shading/bridge.h"
#include "shading/constants.h"
#include "interface/layout.h"
#include "interface/radiance.glsl"
#if IN_PLACE
#include "shading/tonemap.h"
#include "interface/develop.glsl"
layout(binding = UNIT_DEPTH) uniform sampler2D gbufferDepth;
#endif
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
#if FOG
#include "shading/fog.h"
#include "interface/fog.glsl"
#endif
#if SKY_MAP == 1
layout(binding = UNIT_ENVIRONMENT) uniform sampler2D skyMap;
#endif
layout(location = 0) out vec4 outRadiance;

#if SUN
// A disc with an edge one pixel wide. One smaller than a pixel is drawn as wide as that and dimmer, so that its light stays the same wherever it stands.
vec3 sunDisc(vec3 d) {
  float pixel = sqrt(length(frame.rayX.xyz) * length(frame.rayY.xyz) * pow(dot(d, frame.forward.xyz), 3.0));  // radians: the root of its solid angle
  // An edge that falls over one pixel adds pixel^2/12 to the square of the radius.
  float edge = pixel * pixel / 12.0, own = frame.sun[0].w * frame.sun[0].w, drawn = max(own - edge, pixel * pixel);
  float share = clamp(0.5 + (sqrt(drawn) - distance(d, frame.sun[0].xyz)) / pixel, 0.0, 1.0) * clamp(0.5 + (d.y - frame.sun[1].w) / pixel, 0.0, 1.0);
  return frame.sun[1].rgb * (share * own / (drawn + edge));
}
#endif

void main() {
#if IN_PLACE
  if (texelFetch(gbufferDepth, ivec2(gl_FragCoord.xy), 0).r > 0.0) discard;
#endif
#if SKY_MAP == 1 || FOG || SUN
  vec2 pixel = gl_FragCoord.xy - vec2(frame.viewport.xy);
  vec3 ray = frame.rayOrigin.xyz + frame.rayX.xyz * pixel.x + frame.rayY.xyz * pixel.y;
#if ORTHOGRAPHIC
  vec3 d = frame.forward.xyz;
#else
  vec3 d = normalize(ray);
#endif
#endif
#if SKY_MAP == 1
  // u = 1/2 looks along -Z, u grows toward +X; the picture's first row is the zenith.
  vec2 uv = vec2(0.5 + atan(d.x, -d.z) / (2.0 * BURNISH_PI), acos(clamp(d.y, -1.0, 1.0)) / BURNISH_PI);
  vec3 c = textureLod(skyMap, uv, 0.0).rgb * frame.background.w;
#elif SKY_MAP == 0
  vec3 c = frame.background.rgb;
#else
  vec3 c = vec3(0.0);
#endif
#if SUN
  c += sunDisc(d);
#endif
#if FOG
#if ORTHOGRAPHIC
  c = fogged(c, ray + d * BURNISH_FOG_FAR, -d);
#else
  c = fogged(c, d * BURNISH_FOG_FAR, -d);
#endif
#endif
  c = limitRadiance(c, frame.exposure.w);
#if IN_PLACE
  c = developed(c * frame.exposure.z);
#endif
  outRadiance = vec4(c, 1.0);
}
