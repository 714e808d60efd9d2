// Antialiasing over time: this frame's sample of each pixel, taken somewhere in it, joins the mean of those before (docs/antialiasing.md).
// Writes the picture (a: samples in the mean, and a half more where they are not all of this very picture) and 1/distance of what the pixel shows, for the next frame.
// The firewall: what is no number is left out, what is infinite is held; neither gets into the mean.
// Definitions: STILL (1: nothing has changed since the frame before; the mean is exact), GEOMETRY (0: nothing was drawn, there is no depth), MOTION (1: there are motion vectors),
// ORTHOGRAPHIC, WEIGHTED (1: bright samples weigh as the display shows them; 0: light as it is).
#include "shading/bridge.h"
#include "shading/constants.h"
#include "shading/history.h"
#include "interface/layout.h"
#include "interface/previous.glsl"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };
layout(binding = UNIT_LIGHT_BUFFER) uniform sampler2D lightBuffer;
layout(binding = UNIT_HISTORY) uniform sampler2D history;
layout(binding = UNIT_HISTORY_DISTANCE) uniform sampler2D historyDistance;
#if GEOMETRY
layout(binding = UNIT_DEPTH) uniform sampler2D gbufferDepth;
#endif
#if MOTION
layout(binding = UNIT_VELOCITY) uniform sampler2D velocity;
#endif
layout(location = 0) uniform mat4 toPrevious;  // camera-relative world now to the clip space of the frame before, without jitter
layout(location = 4) uniform vec4 past;        // xy jitter of this frame (pixels), zw depthParams of the frame before
layout(location = 5) uniform vec4 kept;        // x 1 when there is a frame before, y its light times this is this frame's, z most samples in the mean of a picture that changes
layout(location = 0) out vec4 outPicture;
layout(location = 1) out float outInverse;

#if WEIGHTED
#define LARGEST 65000.0  // of a half float, with room for rounding
#define MOST_STILL 64.0  // more samples change the mean by less than half floats hold: it would drift. From then on the picture is what it is
vec3 inwards(vec3 c) { return compressLight(c); }
vec3 outwards(vec3 t) { return expandLight(t); }
#else
#define LARGEST 1e30
#define MOST_STILL 1024.0
vec3 inwards(vec3 c) { return c; }
vec3 outwards(vec3 t) { return t; }
#endif

ivec2 inView(ivec2 q) { return clamp(q, frame.viewport.xy, frame.viewport.xy + frame.viewport.zw - 1); }
vec3 held(vec3 c) { return clamp(c, vec3(0.0), vec3(LARGEST)); }
bool number(vec3 c) { return !any(isnan(c)); }

float depthAt(ivec2 q) {
#if GEOMETRY
  return texelFetch(gbufferDepth, q, 0).r;
#else
  return 0.0;
#endif
}
// 0 where nothing was drawn.
float inverseOf(float z) {
#if ORTHOGRAPHIC
  return z > 0.0 ? min(1.0 / (frame.depthParams.x - z * frame.depthParams.y), NEAREST_INVERSE) : 0.0;
#else
  return z > 0.0 ? min((z + frame.depthParams.y) / frame.depthParams.x, NEAREST_INVERSE) : 0.0;
#endif
}

#if !STILL
// Where the point at pixel q stood in the frame before, as a motion in pixels; inverse: its distance then.
vec2 motionOf(ivec2 q, float z, out float inverse) {
#if MOTION
  vec4 moved = texelFetch(velocity, q, 0);
  if (moved.w > 0.5) {
    inverse = moved.z;
    return moved.xy;
  }
#endif
  vec2 pixel = vec2(q - frame.viewport.xy) + 0.5;
  vec3 ray = frame.rayOrigin.xyz + frame.rayX.xyz * pixel.x + frame.rayY.xyz * pixel.y;
#if ORTHOGRAPHIC
  vec4 point = vec4(ray + frame.forward.xyz * (frame.depthParams.x - z * frame.depthParams.y), 1.0);
#else
  vec4 point = z > 0.0 ? vec4(ray * (frame.depthParams.x / (z + frame.depthParams.y)), 1.0) : vec4(ray, 0.0);
#endif
  vec4 clip = toPrevious * point;
  inverse = z > 0.0 ? inverseDistanceThen(clip, past.zw) : 0.0;
  return pixelThen(clip, vec2(frame.viewport.zw)) - (pixel + past.xy);
}

vec3 oldAt(vec2 place) {
  vec2 low = vec2(frame.viewport.xy) + 0.5, high = vec2(frame.viewport.xy + frame.viewport.zw) - 0.5;
  return inwards(held(textureLod(history, clamp(place, low, high) / vec2(textureSize(history, 0)), 0.0).rgb * kept.y));
}

// The picture of the frame before between its pixels, in the space of the mean: Catmull-Rom by five bilinear lookups, the corners left out (Jimenez 2016, "Filmic SMAA").
vec3 oldBetween(vec2 place) {
  vec2 middle = floor(place - 0.5) + 0.5, f = place - middle;
  vec4 x = catmullRom(f.x), y = catmullRom(f.y);
  vec2 inner = vec2(x.y + x.z, y.y + y.z), between = middle + vec2(x.z, y.z) / inner;
  vec4 sum = vec4(oldAt(between), 1.0) * (inner.x * inner.y);
  sum += vec4(oldAt(vec2(middle.x - 1.0, between.y)), 1.0) * (x.x * inner.y);
  sum += vec4(oldAt(vec2(middle.x + 2.0, between.y)), 1.0) * (x.w * inner.y);
  sum += vec4(oldAt(vec2(between.x, middle.y - 1.0)), 1.0) * (inner.x * y.x);
  sum += vec4(oldAt(vec2(between.x, middle.y + 2.0)), 1.0) * (inner.x * y.w);
  return sum.rgb / sum.a;
}
#endif

void main() {
  ivec2 q = ivec2(gl_FragCoord.xy);
  vec3 now = texelFetch(lightBuffer, q, 0).rgb;
  bool good = number(now);
  now = good ? inwards(held(now)) : vec3(0.0);
  outInverse = inverseOf(depthAt(q));
#if STILL
  vec4 before = texelFetch(history, q, 0);
  // What was averaged while the picture changed counts for little now that it is still.
  float samples = kept.x * (fract(before.a) > 0.25 ? min(floor(before.a), 4.0) : before.a);
  vec3 old = samples > 0.0 ? inwards(held(before.rgb * kept.y)) : now;
  good = good && samples < MOST_STILL;
#else
  // Of the pixel and its eight neighbours: the mean and spread of colour, and the nearest point, whose motion counts, so that edges move with what is in front.
  vec3 sum = vec3(0.0), squares = vec3(0.0);
  // Light in the pixel's middle is found between the four samples around it: they lie where the jitter puts them, and what slants smoothly does not flicker.
  vec4 between = vec4(0.0);
  float count = 0.0, nearest = -1.0;
  ivec2 front = q;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = inView(q + ivec2(x, y));
      vec3 c = texelFetch(lightBuffer, at, 0).rgb;
      if (number(c)) {
        c = inwards(held(c));
        vec2 weight = max(1.0 - abs(vec2(x, y) + past.xy), vec2(0.0));
        between += vec4(c, 1.0) * (weight.x * weight.y);
        c = lumaFromRgb(c);
        sum += c;
        squares += c * c;
        count += 1.0;
      }
      float z = depthAt(at);
      if (z > nearest) {
        nearest = z;
        front = at;
      }
    }
  if (between.a > 0.01) now = between.rgb / between.a;
  float inverse;
  vec2 place = gl_FragCoord.xy + motionOf(front, nearest, inverse);
  vec2 inside = place - vec2(frame.viewport.xy);
  ivec2 texel = inView(ivec2(floor(place)));
  // What was nearer than anything here is, by more than the surface itself slants, hid it.
  bool hidden = texelFetch(historyDistance, texel, 0).r > inverse * 1.02 + (inverseOf(nearest) - outInverse) + 1e-7;
  // Between the outermost pixels' middles and the border there is nothing to look up but those pixels, which would smear inward.
  bool there = all(greaterThan(inside, vec2(0.45))) && all(lessThan(inside, vec2(frame.viewport.zw) - 0.45)) && !hidden;
  float samples = there ? kept.x * min(floor(texelFetch(history, texel, 0).a), kept.z - 1.0) : 0.0;
  vec3 old = now;
  if (samples > 0.0) {
    vec3 middle = sum / max(count, 1.0), spread = sqrt(max(squares / max(count, 1.0) - middle * middle, vec3(0.0)));
    // Variance clipping (Salvi 2016, "An Excursion in Temporal Supersampling").
    old = count > 0.0 ? rgbFromLuma(clippedToward(middle, clipBox(middle, spread), lumaFromRgb(oldBetween(place)))) : oldBetween(place);
  }
#endif
  // A sample that is no number leaves the mean as it was.
  samples = good ? samples + 1.0 : samples;
  vec3 mean = good ? mix(old, now, 1.0 / samples) : samples > 0.0 ? old : vec3(0.0);
  outPicture = vec4(held(outwards(mean)), STILL == 1 || samples == 0.0 ? samples : samples + 0.5);
}
