// Mean of the occlusion pass over 4 x 4 pixels, one of each turn of its pattern, over those that lie on the same surface; then the darker of it and of what is baked.
// On the same surface: stored depth (reversed) is linear over the screen on any plane, in both projections; so is its step from one pixel to the next, of which the smaller to either
// side is taken (the larger may cross an edge). Definitions: BAKED, ORTHOGRAPHIC.
#include "shading/bridge.h"
#include "shading/constants.h"
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_OCCLUSION) uniform sampler2D occlusionRaw;
layout(binding = UNIT_DEPTH) uniform sampler2D gbufferDepth;
#if BAKED
layout(binding = UNIT_GBUFFER_C) uniform sampler2D gbufferC;
#endif
layout(location = 0) flat in vec4 viewAxes[3];
layout(location = 3) flat in vec4 viewRay;
layout(location = 0) out float outOcclusion;

float smaller(float a, float b) { return abs(a) < abs(b) ? a : b; }

void main() {
  ivec2 q = ivec2(gl_FragCoord.xy), own = q - frame.viewport.xy;
  vec2 texel = 1.0 / vec2(textureSize(gbufferDepth, 0));
  // The window's four quarters, from the lower left. A gather holds (0, 1), (1, 1), (1, 0), (0, 0): a fraction of what four fetches cost.
  vec4 depth[4], value[4], weight[4];
  for (int i = 0; i < 4; ++i) {
    vec2 at = (vec2(q) + vec2(float(i & 1) * 2.0 - 1.0, float(i >> 1) * 2.0 - 1.0)) * texel;
    depth[i] = textureGather(gbufferDepth, at, 0);
    value[i] = textureGather(occlusionRaw, at, 0);
    weight[i] = textureGather(occlusionRaw, at, 1);
  }
  float z = depth[3].w;
  bool left = own.x > 0, down = own.y > 0, right = own.x < frame.viewport.z - 1, up = own.y < frame.viewport.w - 1;
  // Past the view's edge there is no step to compare.
  float toLeft = z - depth[2].z, toRight = depth[3].z - z, toDown = z - depth[1].x, toUp = depth[3].x - z;
  float stepX = smaller(right ? toRight : toLeft, left ? toLeft : toRight);
  float stepY = smaller(up ? toUp : toDown, down ? toDown : toUp);
  // Two pixels' breadth of distance along the view.
#if ORTHOGRAPHIC
  float tolerance = 2.0 * viewRay.z / viewAxes[1].w;
#else
  float tolerance = 2.0 * viewRay.z * (z + viewAxes[1].w);
#endif
  float inverse = 1.0 / max(tolerance, BURNISH_GUARD_LENGTH);
  float sum = 0.0, weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec4 x = vec4(0.0, 1.0, 1.0, 0.0) + (float(i & 1) * 2.0 - 2.0), y = vec4(1.0, 1.0, 0.0, 0.0) + (float(i >> 1) * 2.0 - 2.0);
    vec4 off = abs(depth[i] - z - stepX * x - stepY * y) * inverse;
    vec4 inside = vec4(greaterThan(depth[i], vec4(0.0))) * vec4(lessThan(abs(x + (float(own.x) + 0.5 - 0.5 * float(frame.viewport.z))), vec4(0.5 * float(frame.viewport.z)))) *
                  vec4(lessThan(abs(y + (float(own.y) + 0.5 - 0.5 * float(frame.viewport.w))), vec4(0.5 * float(frame.viewport.w))));
    vec4 w = weight[i] * inside * clamp(2.0 - off, 0.0, 1.0);  // model: the surface's edge
    sum += dot(w, value[i]);
    weights += dot(w, vec4(1.0));
  }
  float occlusion = weights > 0.0 ? sum / weights : 1.0;
#if BAKED
  occlusion = min(occlusion, texelFetch(gbufferC, q, 0).r);  // model: both hold the same large occluders, which a product would count twice
#endif
  outOcclusion = occlusion;
}
