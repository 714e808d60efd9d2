// Ambient occlusion from depth and the stored normal (shading/occlusion.h): SLICES slices, STEPS samples to either side of each. Slices turn and samples move in a pattern of 4 x 4
// pixels, which the denoise pass averages: 16 times as many directions. Writes visible over seeable, and the weight (what is seeable) that it has in a mean.
// Definitions: NORMAL_STORAGE, ORTHOGRAPHIC, SLICES, STEPS.
#include "shading/bridge.h"
#include "shading/constants.h"
#include "shading/normals.h"
#include "shading/occlusion.h"
#include "interface/layout.h"
#include "interface/stored_normal.glsl"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_GBUFFER_B) uniform sampler2D gbufferB;
layout(binding = UNIT_DEPTH) uniform sampler2D gbufferDepth;
layout(location = 0) flat in vec4 viewAxes[3];
layout(location = 3) flat in vec4 viewRay;
layout(location = 0) out vec2 outOcclusion;

const float kThin = 0.1 / float(STEPS);  // share of a horizon that a lower sample behind it gives back

// In the view's axes, metres.
vec3 placeOf(vec2 pixel, float z) {
  vec2 ray = viewRay.xy + viewRay.z * pixel;
#if ORTHOGRAPHIC
  return vec3(ray, z * viewAxes[1].w - viewAxes[0].w);
#else
  float w = viewAxes[0].w / (z + viewAxes[1].w);
  return vec3(ray * w, -w);
#endif
}

void main() {
  ivec2 q = ivec2(gl_FragCoord.xy), own = q - frame.viewport.xy;
  float z = texelFetch(gbufferDepth, q, 0).r;
  vec4 b = texelFetch(gbufferB, q, 0);
  // Sky, and the host's own pixels: nothing to see, no weight.
  if (z <= 0.0 || isHostPixel(b)) {
    outOcclusion = vec2(1.0, 0.0);
    return;
  }
  vec3 p = placeOf(gl_FragCoord.xy, z);
#if ORTHOGRAPHIC
  vec3 v = vec3(0.0, 0.0, 1.0);
  float footprint = viewRay.z;
#else
  vec3 v = p * -inversesqrt(dot(p, p));
  float footprint = viewRay.z * -p.z;
#endif
  vec3 world = storedNormal(b);
  vec3 n = vec3(dot(world, viewAxes[0].xyz), dot(world, viewAxes[1].xyz), dot(world, viewAxes[2].xyz));
  // As makeSurface: a normal that looks away is bent until it is perpendicular.
  float nov = dot(n, v);
  if (nov < 0.0) n = normalize(n - v * nov);
  float reach = min(viewAxes[2].w / footprint, viewRay.w);  // model: the bound on the screen
  float inverseRadius = 1.0 / (reach * footprint);
  int turn = ((own.x + own.y) & 3) * 4 + (own.x & 3);
  float offset = (float((turn * 7) & 15) + 0.5) / 16.0;
  float seen = 0.0, seeable = 0.0;
  for (int i = 0; i < SLICES; ++i) {
    float angle = BURNISH_PI * (float(i) + (float(turn) + 0.5) / 16.0) / float(SLICES);
    vec2 direction = vec2(cos(angle), sin(angle));
    OcclusionSlice s = occlusionSlice(n, v, vec3(direction, 0.0));
    float lost = 0.0;
    for (float side = -1.0; side < 2.0; side += 2.0) {
      OcclusionSide o = occlusionSide(s, side);
      for (int k = 0; k < STEPS; ++k) {
        float share = (float(k) + offset) / float(STEPS);
        ivec2 at = own + ivec2(round(direction * (side * (1.0 + share * share * reach))));
        bool inside = at.x >= 0 && at.y >= 0 && at.x < frame.viewport.z && at.y < frame.viewport.w;
        float there = texelFetch(gbufferDepth, inside ? at + frame.viewport.xy : q, 0).r;
        vec3 d = placeOf(gl_FragCoord.xy + vec2(at - own), there) - p;
        // Past the view's edge nothing is known, and nothing is behind the sky: what lies straight behind takes nothing.
        addOccluder(o, s, inside && there > 0.0 ? d : v * (-2.0 / inverseRadius), side, inverseRadius * inverseRadius, kThin);
      }
      lost += o.lost;
    }
    float all = occlusionSeeable(s);
    seeable += s.weight * all;
    seen += s.weight * (all - lost);
  }
  // A slice sees pi/2 at most: where the normal lies in it and looks sideways.
  outOcclusion = vec2(unitClamp(seen / max(seeable, BURNISH_GUARD_VISIBILITY)), seeable * (2.0 / (BURNISH_PI * float(SLICES))) + 1.0 / 255.0);
}
