// Edge antialiasing of the developed picture, from luma alone (in alpha, see tonemap.frag). After Lottes 2009, "FXAA" (white paper, NVIDIA): a local contrast test, the
// edge's direction from second differences, a search along the edge for its two ends; the share of the neighbour follows from where the pixel stands between them, as in Reshetov
// 2009, "Morphological Antialiasing": a step of the edge is read as a straight line from end to end. What is narrower than a pixel gets a little of its neighbour.
// Pixels are mixed in linear light (as squares of display values), since the display shows light. Definitions: HOST_DEPTH (pixels with alpha 0 are the host's and left alone).
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_DISPLAY) uniform sampler2D display;
layout(location = 0) out vec4 outColor;

// Contrast under an eighth of the brightest neighbour, or under 1/32, is no edge (Lottes's "quality" settings).
#define CONTRAST 0.125
#define CONTRAST_DARK 0.03125
#define SUBPIXEL 0.4
#define STEPS 10

vec2 scale;

float lumaAt(vec2 at) {
  vec4 edge = vec4(frame.target.xy, frame.target.xy + frame.target.zw) + vec4(0.5, 0.5, -0.5, -0.5);
  return textureLod(display, clamp(at, edge.xy, edge.zw) * scale, 0.0).a;
}
float own(float luma, float middle) {
#if HOST_DEPTH
  return luma == 0.0 ? middle : luma;
#else
  return luma;
#endif
}

// Pixels from `at`, on the border of two rows, to where their edge ends along `along`. end: luma beyond it, less the edge's; small when no end was met.
float reach(vec2 at, vec2 along, float edge, float threshold, out float end, out float beyond) {
  float distance = 0.0, stride = 1.0;
  for (int i = 0; i < STEPS; ++i) {
    stride = i < 4 ? 1.0 : 2.0;
    distance += stride;
    end = lumaAt(at + along * distance) - edge;
    if (abs(end) >= threshold) break;
  }
  beyond = distance;
  return distance - 0.5 * stride;
}

void main() {
  scale = 1.0 / vec2(textureSize(display, 0));
  vec2 p = gl_FragCoord.xy;
  vec4 here = texelFetch(display, ivec2(p), 0);
  float m = here.a;
#if HOST_DEPTH
  if (m == 0.0) discard;
#endif
  outColor = vec4(here.rgb, 1.0);
  float n = own(lumaAt(p + vec2(0.0, 1.0)), m), s = own(lumaAt(p - vec2(0.0, 1.0)), m), e = own(lumaAt(p + vec2(1.0, 0.0)), m), w = own(lumaAt(p - vec2(1.0, 0.0)), m);
  float highest = max(m, max(max(n, s), max(e, w))), lowest = min(m, min(min(n, s), min(e, w))), range = highest - lowest;
  if (range < max(CONTRAST_DARK, highest * CONTRAST)) return;
  float ne = own(lumaAt(p + vec2(1.0, 1.0)), m), nw = own(lumaAt(p + vec2(-1.0, 1.0)), m), se = own(lumaAt(p + vec2(1.0, -1.0)), m), sw = own(lumaAt(p - vec2(1.0, 1.0)), m);

  // A share for what is thinner than a pixel, and for corners of staircases: how far the pixel stands out from its surroundings, more than it does on a straight edge (1/3).
  float stands = abs((2.0 * (n + s + e + w) + ne + nw + se + sw) / 12.0 - m) / range;
  float share = clamp(1.5 * stands - 0.5, 0.0, 1.0) * SUBPIXEL;

  float across = abs(nw + sw - 2.0 * w) + 2.0 * abs(n + s - 2.0 * m) + abs(ne + se - 2.0 * e);
  float along = abs(nw + ne - 2.0 * n) + 2.0 * abs(w + e - 2.0 * m) + abs(sw + se - 2.0 * s);
  bool horizontal = across >= along;
  float up = horizontal ? n : e, down = horizontal ? s : w;
  bool upward = abs(up - m) >= abs(down - m);
  float other = upward ? up : down, contrast = abs(other - m);
  vec2 toOther = (horizontal ? vec2(0.0, 1.0) : vec2(1.0, 0.0)) * (upward ? 1.0 : -1.0), direction = horizontal ? vec2(1.0, 0.0) : vec2(0.0, 1.0);

  // On the border of the two pixels bilinear lookups see the mean of both sides; it leaves the edge's where one side ends.
  float edge = 0.5 * (m + other), threshold = 0.25 * contrast, endA, endB, beyondA, beyondB;
  vec2 border = p + toOther * 0.5;
  float a = reach(border, direction, edge, threshold, endA, beyondA), b = reach(border, -direction, edge, threshold, endB, beyondB);
  bool first = a < b;
  float end = first ? endA : endB;
  // The line from end to end covers this pixel only where, beyond the nearer end, the other side's luma takes over from this one's; and not when it takes over the next row as
  // well: that is a corner, which stays.
  float next = lumaAt(p - toOther + direction * (first ? beyondA : -beyondB)) - edge;
  bool covers = (end < 0.0) != (m < edge) && abs(end) >= threshold && !((next < 0.0) == (end < 0.0) && abs(next) >= threshold);
  if (covers) share = max(share, 0.5 - min(a, b) / (a + b));

  vec3 there = texelFetch(display, clamp(ivec2(p + toOther), frame.target.xy, frame.target.xy + frame.target.zw - 1), 0).rgb;
  outColor.rgb = sqrt(mix(here.rgb * here.rgb, there * there, share));
}
