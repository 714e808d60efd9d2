// How much of a light's disc a point sees, from shadow maps. The includer has included shading/bridge.h, shading/all.h and interface/layout.h, and declares `lights` where SHADOW_LOCALS is 1.
// Definitions: SHADOW (1 one lookup, 2 percentage-closer filtering, 3 percentage-closer soft shadows), SHADOW_SUNS (directional lights that have shadows: the first ones), SHADOW_LOCALS.
//
// Bias. A surface must not shadow itself: over the kernel's radius of r texels a plane's depth changes by r texels · cot(angle to the light), which is a shift of r texels along its normal.
// Maps hold surfaces one texel's slope farther (engine/shadow), and the receiver moves along its normal by the rest (normal offset: Holbert 2011, "Saying Goodbye to Shadow Acne"): always in
// full, since the normal at hand is the mapped one, whose angle says nothing of the surface's own.
layout(std140, binding = BINDING_SHADOW) uniform Shadows { ShadowData shadows; };
layout(binding = UNIT_SHADOW) uniform sampler2DArrayShadow shadowMaps;
#if SHADOW == 1
#define SHADOW_OFFSET 1.0
#else
#define SHADOW_OFFSET 2.25
#endif

#if SHADOW == 3
layout(binding = UNIT_SHADOW_DEPTH) uniform sampler2DArray shadowDepths;
#define SEARCH_TAPS 16  // of four texels each
#define NEAR_TAPS 8     // and so many more around the middle
#define NEAR_TEXELS 6.0
#define FILTER_TAPS 32

// A point in a map.
struct ShadowPlace {
  vec3 at;       // map coordinates in (0, 1), layer
  float z;       // depth
  vec2 slope;    // of depth over the receiver's plane, per texel
  float widest;  // radius in which blockers may be, texels
  float blur;    // shadowBlur's perDepth
};

float visibleIn(ShadowPlace s) {
  float inverse = shadows.params.y, sum = 0.0, count = 0.0;
  for (int i = -NEAR_TAPS; i < SEARCH_TAPS; ++i) {
    vec2 o = vogelDisc(max(i, 0), SEARCH_TAPS) * s.widest;
    // A blocker near the receiver reaches over a texel or two of the sixteen that a far one would, and must be met there: as many taps in each step of the radius.
    if (i < 0) o = vogelDisc(i + NEAR_TAPS, NEAR_TAPS) * (sqrt((float(i + NEAR_TAPS) + 0.5) / float(NEAR_TAPS)) * min(s.widest, NEAR_TEXELS));
    // The four texels around a corner.
    vec2 corner = floor(s.at.xy * shadows.params.x + o + 0.5), off = corner - s.at.xy * shadows.params.x;
    vec4 d = textureGather(shadowDepths, vec3(corner * inverse, s.at.z), 0);
    vec4 x = off.x + vec4(-0.5, 0.5, 0.5, -0.5), y = off.y + vec4(0.5, 0.5, -0.5, -0.5);
    vec4 plane = s.z + s.slope.x * x + s.slope.y * y;
    for (int k = 0; k < 4; ++k) {
      // It blocks when the way from here to the light's disc meets it.
      float reach = shadowBlur(d[k], s.z, s.blur) + 1.0;
      bool blocks = d[k] > plane[k] && x[k] * x[k] + y[k] * y[k] <= reach * reach;
      sum += blocks ? d[k] : 0.0;
      count += blocks ? 1.0 : 0.0;
    }
  }
  float radius = clamp(shadowBlur(sum / max(count, 1.0), s.z, s.blur), 1.0, float(SHADOW_WIDEST));
  float seen = 0.0;
  for (int i = 0; i < FILTER_TAPS; ++i) {
    vec2 o = vogelDisc(i, FILTER_TAPS) * radius;
    seen += texture(shadowMaps, vec4(s.at.xy + o * inverse, s.at.z, max(s.z + dot(s.slope, o), 0.0)));
  }
  return count > 0.0 ? seen / float(FILTER_TAPS) : 1.0;
}
#else
float visibleIn(vec3 at, float z) {
#if SHADOW == 1
  return texture(shadowMaps, vec4(at, z));
#else
  vec2 t = at.xy * shadows.params.x - 0.5, base = floor(t);
  vec2 low = base * shadows.params.y, high = (base + 2.0) * shadows.params.y;
  vec4 ll = textureGather(shadowMaps, vec3(low, at.z), z), lr = textureGather(shadowMaps, vec3(high.x, low.y, at.z), z);
  vec4 ul = textureGather(shadowMaps, vec3(low.x, high.y, at.z), z), ur = textureGather(shadowMaps, vec3(high, at.z), z);
  return shadowFiltered(ll, lr, ul, ur, t - base);
#endif
}
#endif

#if SHADOW_SUNS > 0
// p: camera-relative (m); n: unit normal, toward the eye.
float sunVisible(int sun, vec3 p, vec3 n) {
  int at = sun * SUN_SHADOW_VECTORS;
  vec4 right = shadows.suns[at], up = shadows.suns[at + 1], toward = shadows.suns[at + 2];
  vec3 q = vec3(dot(right.xyz, p), dot(up.xyz, p), dot(toward.xyz, p));
  vec3 m = vec3(dot(right.xyz, n), dot(up.xyz, n), dot(toward.xyz, n));
  // The finest cascade that holds the point and what the kernel reaches around it; casters behind its far side are not in it.
  float inside = 1.0 - 2.0 * (float(SHADOW == 3 ? SHADOW_WIDEST : 3) + SHADOW_OFFSET) * shadows.params.y;
  vec4 place = vec4(0.0, 2.0, 2.0, -1.0), depth = vec4(0.0, 0.0, 1.0, 1.0);
  for (int k = MAX_CASCADES - 1; k >= 0; --k) {
    vec4 c = shadows.suns[at + 4 + 2 * k], d = shadows.suns[at + 5 + 2 * k];
    vec2 u = abs(q.xy * c.x + c.yz);
    bool holds = max(u.x, u.y) < inside && q.z * d.x + d.y >= 0.0;
    place = holds ? c : place;
    depth = holds ? d : depth;
  }
  q += m * (SHADOW_OFFSET * depth.z);
  vec3 where = vec3((q.xy * place.x + place.yz) * 0.5 + 0.5, max(place.w, 0.0));
  float z = max(q.z * depth.x + depth.y, 0.0);
#if SHADOW == 3
  float texelDepth = depth.z * depth.x, perDepth = right.w * depth.w / depth.z;
  vec2 slope = m.xy * (-texelDepth / max(m.z, 0.02));
  float visible = visibleIn(ShadowPlace(where, z, slope, clamp((1.0 - z) * perDepth + 1.0, 2.0, float(SHADOW_WIDEST)), perDepth));
#else
  float visible = visibleIn(where, z);
#endif
  return place.w < 0.0 ? 1.0 : visible;
}
#endif

#if SHADOW_LOCALS
// place: the light's, camera-relative; more: the light's fourth texel (interface/layout.h).
float localVisible(vec3 place, vec4 more, vec3 p, vec3 n) {
  int at = int(shadows.params.w) + (int(more.y) - 1) * SHADOW_TEXELS;
  vec4 head = texelFetch(lights, at), x = texelFetch(lights, at + 1), y = texelFetch(lights, at + 2), z = texelFetch(lights, at + 3);
  bool cube = head.x > 0.5;
  float texel = 2.0 * head.w * shadows.params.y;  // a texel's side at 1 m
  vec4 f = cubeFace(p - place);
  float along = max(cube ? f.z : dot(z.xyz, p) + z.w, 0.0);
  vec3 moved = p + n * (SHADOW_OFFSET * texel * along);
  f = cubeFace(moved - place);
  float w = max(cube ? f.z : dot(z.xyz, moved) + z.w, 1e-6);
  vec2 uv = cube ? f.xy / head.w : vec2(dot(x.xyz, moved) + x.w, dot(y.xyz, moved) + y.w) / w;
  float layer = texelFetch(lights, at + 4 + (cube ? int(f.w) : 0)).x;
  vec3 where = vec3(uv * 0.5 + 0.5, max(layer, 0.0));
  float depth = max(shadowDepth(w, head.y, head.z), 0.0);
#if SHADOW == 3
  vec3 m = cube ? onCubeFace(n, f.w) : vec3(dot(x.xyz, n) * head.w, dot(y.xyz, n) * head.w, dot(z.xyz, n));
  vec3 q = vec3(uv * head.w, 1.0);
  float facing = min(dot(m, q), -0.02), perDepth = more.z / (texel * head.y);
  vec2 slope = m.xy * (head.y * texel / (facing * w));
  float visible = visibleIn(ShadowPlace(where, depth, slope, clamp((1.0 - depth) * perDepth + 1.0, 2.0, float(SHADOW_WIDEST)), perDepth));
#else
  float visible = visibleIn(where, depth);
#endif
  return layer < 0.0 ? 1.0 : visible;
}
#endif
