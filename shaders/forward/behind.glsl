// What is seen through refracting glass: the picture behind it (a copy with mip levels), looked up where the ray that leaves the body meets what is opaque; the surroundings where that
// lies outside the picture. Surroundings that give no light are black (UNLIT_AROUND); where the quality leaves their reflections out, the picture's edge stands for them.
layout(binding = UNIT_SCENE_COLOR) uniform sampler2D sceneColor;
layout(binding = UNIT_SCENE_DEPTH) uniform sampler2D sceneDepth;

// Steps that look for the point where the ray meets the depth buffer: one finds a plane across the view, each further one corrects for a slope.
#define STEPS 4

vec2 pixelOf(vec4 clip) { return (clip.xy * (0.5 / clip.w) + 0.5) * vec2(frame.viewport.zw); }

float depthAt(vec2 local) {
  vec2 held = clamp(local, vec2(0.0), vec2(frame.viewport.zw) - 1.0);  // model: the picture ends here
  return texelFetch(sceneDepth, ivec2(held) + frame.viewport.xy, 0).r;
}

float distanceOf(float z) {
#if ORTHOGRAPHIC
  return frame.depthParams.x - z * frame.depthParams.y;
#else
  return frame.depthParams.x / (z + frame.depthParams.y);
#endif
}

// Level whose texels spread light as far as wanted. A level k of the pyramid (forward/scene_blur.frag, then bilinear) has the variance 0.4167 · 4^k - 0.25 pixels²; a footprint of
// f pixels stands for f²/4 of it, less what makes up to 1.2 pixels one (0.375).
float levelOf(float blur, float footprint) { return 0.5 * log2(1.0 + max(blur * blur + 0.25 * footprint * footprint - 0.375, 0.0) * 2.4); }  // model: a sharp lookup is one pixel

vec3 pictureAt(vec2 local, float level) {
  vec2 size = vec2(textureSize(sceneColor, 0));
  float inset = 0.5 * exp2(ceil(level));
  vec2 held = clamp(local, vec2(inset), max(vec2(frame.viewport.zw) - inset, vec2(inset)));  // model: the picture ends here
  return firmRadiance(textureLod(sceneColor, held / size, level).rgb, frame.exposure.w);
}

// The body is as round as its surface here, for its thickness: 1 for a ball. Signed, so that a hollow is no ball.
float roundnessHere(vec3 p, float thickness) {
  vec3 n = worldNormal * inversesqrt(max(dot(worldNormal, worldNormal), BURNISH_GUARD_LENGTH));
  if (!gl_FrontFacing) n = -n;
  vec3 nx = dFdx(n), ny = dFdy(n), px = dFdx(p), py = dFdy(p);
  float area = dot(px, px) + dot(py, py);
  return unitClamp(0.5 * thickness * (dot(nx, px) + dot(ny, py)) / max(area, BURNISH_GUARD_LENGTH));
}

// A ray that leaves the glass, and where it meets what is opaque.
struct Meeting {
  vec2 at;     // pixel of the view
  vec2 first;  // the first guess at it, from the depth behind this pixel
  float way;   // m from where it leaves
  bool far;    // it meets nothing: the background
  bool gone;   // it leads away from the picture's side
};

Meeting meet(vec3 leaves, vec3 direction) {
  float depth = dot(leaves, frame.forward.xyz), slope = dot(direction, frame.forward.xyz);
  vec4 from = frame.viewProjection * vec4(leaves, 1.0), along = frame.viewProjection * vec4(direction, 0.0);
  vec2 here = gl_FragCoord.xy - vec2(frame.viewport.xy);
  Meeting m = Meeting(here, here, 0.0, false, slope <= BURNISH_GUARD_NOV);
  if (m.gone) return m;
  for (int i = 0; i < STEPS; ++i) {
    float z = depthAt(m.at);
#if !ORTHOGRAPHIC
    m.far = z <= 0.0;
#endif
    m.way = max(distanceOf(max(z, BURNISH_GUARD_LENGTH)) - depth, 0.0) / slope;  // model: what is nearer than the exit is no hit
    m.at = pixelOf(m.far ? along : from + along * m.way);
    if (i == 0) m.first = m.at;
  }
  return m;
}

// What is nearer than the glass is not behind it, nor what the bilinear lookup would mix in from beside it.
vec2 behindHere(vec2 at) {
  if (depthAt(at) > gl_FragCoord.z) at = gl_FragCoord.xy - vec2(frame.viewport.xy);
  vec4 four = textureGather(sceneDepth, (at + vec2(frame.viewport.xy)) / vec2(textureSize(sceneDepth, 0)));
  return any(greaterThan(four, vec4(gl_FragCoord.z))) ? floor(at) + 0.5 : at;
}

// Pixels that the ray's cone spans, seen from the eye. The lower of two estimates: by how far the places that neighbours see lie apart, which is too much across an edge of the depth
// buffer, and by how their rays part over the same way, which is too much on outlines, where a neighbour's surface may be anywhere.
float footprintOf(Meeting m, vec3 leaves, vec3 direction, float perPixel) {
  vec3 x = m.far ? dFdx(direction) : dFdx(leaves) + dFdx(direction) * m.way, y = m.far ? dFdy(direction) : dFdy(leaves) + dFdy(direction) * m.way;
#if ORTHOGRAPHIC
  vec3 sight = frame.forward.xyz;
  float scale = 1.0 / perPixel;
#else
  vec3 hit = m.far ? direction : leaves + direction * m.way, sight = hit * inversesqrt(max(dot(hit, hit), BURNISH_GUARD_LENGTH));
  float scale = 1.0 / (perPixel * max(dot(hit, frame.forward.xyz), BURNISH_GUARD_NOV));
#endif
  x -= sight * dot(sight, x);
  y -= sight * dot(sight, y);
  return min(sqrt(max(dot(x, x), dot(y, y))) * scale, max(length(dFdx(m.at)), length(dFdy(m.at))));  // model: the lower estimate
}

// inside: the eye sees the far side's back: light enters there. Pre-exposed radiance, absorption taken off.
vec3 behind(Place at, vec3 toEye, Surface m, float eta, float thickness, bool inside) {
  vec3 p = at.p;
  vec3 way = vec3(0.0), direction = -m.v;
  float path = 0.0, roundness = roundnessHere(p, thickness), perPixel = length(frame.rayX.xyz);
  if (inside) {
    if (refractSnell(m.v, m.n, 1.0 / eta, direction) <= 0.0) return vec3(0.0);  // total internal reflection
  } else if (thickness > 0.0) {
    path = throughBody(m.v, m.n, eta, thickness, roundness, way, direction);
  }
  vec3 leaves = p + way;
  Meeting met = meet(leaves, direction);
  float footprint = footprintOf(met, leaves, direction, perPixel);
  // Pixels over which roughness spreads it; a perspective's as of what is far behind.
  float blur = scatteredAngle(m.alpha, eta) / perPixel;
#if ORTHOGRAPHIC
  blur *= met.way + path;
#endif
  // Exact places jump at every edge of the depth buffer: blurred lookups take the first guess.
  vec2 place = met.at + (met.first - met.at) * unitClamp((blur - 4.0) * 0.125);
  // Thin panes shift nothing.
  if (thickness <= 0.0) {
    place = gl_FragCoord.xy - vec2(frame.viewport.xy);
    met.gone = false;
    footprint = 1.0;
  }
  vec2 size = vec2(frame.viewport.zw), beyond = max(max(-place, place - size), vec2(0.0)) / size;  // model: 0 inside the picture
  float outside = met.gone ? 1.0 : unitClamp(max(beyond.x, beyond.y) / max(0.05, 4.0 * blur / size.y));  // model: the surroundings take over within a twentieth of the picture, or within what is blurred
  float last = float(textureQueryLevels(sceneColor) - 1);
  vec3 seen = pictureAt(behindHere(place), min(levelOf(blur, footprint), last));  // model: the pyramid ends
#if SURROUNDINGS && RUNG_ENVIRONMENT_SPECULAR != ENVIRONMENT_SPECULAR_NONE
  if (outside > 0.0) {
    at.p = leaves;  // shared as at the surface, looked up from where the ray leaves
    vec3 around = radianceAt(at, direction, sqrt(scatteredAlpha(m.alpha, eta)));
#if FOG
    // Before the sky: fog to the end of the world. Then as if it were seen here.
    float beyondFog = fogDepth(frame.fog.z + p.y, frame.fog.z + p.y + direction.y * BURNISH_FOG_FAR, BURNISH_FOG_FAR, 0.0, frame.fog.x, frame.fog.y);
    around = fogged(around + (fogSource(direction) - around) * (fogTaken(beyondFog) * skyAt(at)), p, toEye);
#endif
    seen += (around - seen) * outside;
  }
#elif UNLIT_AROUND
  seen -= seen * outside;
#endif
  return seen * absorbed(material.attenuation.rgb, path);
}
