// Light of the surroundings at a place: of captured places (shading/probes.h), and of the sky where they leave something to it. Pre-exposed.
// The includer defines, where ENVIRONMENT is 1, skyAmbientAt(normal) and lastLevel() (of the sky's cube), and where PROBES is not 0, probesNear(p, out list): how many records may
// have a share at p (MAX_TILE_PROBES at most), and which, smaller boxes before larger ones. A software renderer saves the turns that a loop does not take, but
// nothing of an if.
// Definitions: ENVIRONMENT (1: the sky gives light), PROBES (1: one captured place may, 2: several), GRID (1: an ambient lattice does), RUNG_AMBIENT, RUNG_ENVIRONMENT_SPECULAR, RUNG_REFLECTION, ENVIRONMENT_UNIT.
#include "interface/cube_level.glsl"
#if ENVIRONMENT || PROBES || GRID
#define SURROUNDINGS 1
#else
#define SURROUNDINGS 0
#endif
// How many are looked at.
#if PROBES == 1
#define PLACES(at) 1
#else
#define PLACES(at) at.count
#endif
#if ENVIRONMENT && RUNG_ENVIRONMENT_SPECULAR != ENVIRONMENT_SPECULAR_NONE
layout(binding = ENVIRONMENT_UNIT) uniform samplerCube environmentCube;
#endif
#if PROBES
layout(binding = UNIT_PROBES) uniform samplerBuffer probeRecords;
#if RUNG_ENVIRONMENT_SPECULAR != ENVIRONMENT_SPECULAR_NONE
layout(binding = UNIT_PROBE_CUBES) uniform samplerCubeArray probeCubes;
#endif
#endif

#if GRID
#include "interface/grid.glsl"
#endif

// A point (camera-relative, m) and who lights it.
struct Place {
  vec3 p;
#if PROBES
  ivec4 probe;
  int count;
  ProbeBlend blend;
#endif
};

#if PROBES
vec3 inBox(int record, vec3 p) {
  vec4 x = texelFetch(probeRecords, record), y = texelFetch(probeRecords, record + 1), z = texelFetch(probeRecords, record + 2);
  return vec3(dot(x.xyz, p) + x.w, dot(y.xyz, p) + y.w, dot(z.xyz, p) + z.w);
}
#endif

Place placeAt(vec3 p) {
  Place at;
  at.p = p;
#if PROBES
  at.count = probesNear(p, at.probe);
  at.blend = beginBlend();
  // A box is larger by what p may be off.
  float slack = frame.probes.z * sqrt(dot(p, p)) + frame.probes.w;
  for (int i = 0; i < PLACES(at); ++i) {
    int record = at.probe[i] * PROBE_TEXELS;
    vec4 extent = texelFetch(probeRecords, record + 3);
    addToBlend(at.blend, i, inBox(record, p), extent.xyz + slack, texelFetch(probeRecords, record + 4).xyz, extent.w);
  }
  endBlend(at.blend);
#endif
  return at;
}

// The sky's share.
float skyAt(Place at) {
#if PROBES
  return at.blend.sky;
#else
  return 1.0;
#endif
}

#if PROBES
// Irradiance over pi of one captured place.
vec3 probeAmbient(int record, vec3 p, vec3 n) {
  vec3 c[9];
  for (int k = 0; k < 9; ++k) c[k] = texelFetch(probeRecords, record + 6 + k).rgb;
#if RUNG_AMBIENT == AMBIENT_BOX
  vec3 x = texelFetch(probeRecords, record).xyz, y = texelFetch(probeRecords, record + 1).xyz, z = texelFetch(probeRecords, record + 2).xyz, sum = vec3(0.0);
  vec3 own = vec3(dot(x, n), dot(y, n), dot(z, n)), q = inBox(record, p), extent = texelFetch(probeRecords, record + 3).xyz, capture = texelFetch(probeRecords, record + 5).xyz;
  for (int i = 0; i < AMBIENT_BOX_TAPS; ++i) {
    vec3 d = ambientTap(i), to = normalize(probeDirection(probeHit(q, d, extent), d, capture));
    sum += irradianceBands(x * to.x + y * to.y + z * to.z, c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8]) * ambientTapWeight(dot(own, d));
  }
  return sum;
#else
  return irradianceSh(n, c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], RUNG_AMBIENT);
#endif
}
#endif

// Irradiance over pi for the normal n, of captured places and the sky.
vec3 ambientAround(Place at, vec3 n) {
  vec3 sum = vec3(0.0);
#if PROBES
#if ENVIRONMENT
  if (at.blend.sky > 0.0) sum = skyAmbientAt(n) * at.blend.sky;
#endif
  for (int i = 0; i < PLACES(at); ++i) sum += probeAmbient(at.probe[i] * PROBE_TEXELS, at.p, n) * at.blend.weight[i];
#elif ENVIRONMENT
  sum = skyAmbientAt(n);
#endif
  return max(sum, vec3(0.0));  // model: three bands of harmonics ring below 0
}

// The same with the lattice's share. What is there without it is found where some of that is left: by a loop, whose turns no pixel takes inside (interface/grid.glsl).
vec3 ambientAt(Place at, vec3 n) {
#if GRID && RUNG_AMBIENT != AMBIENT_NONE
  vec4 lattice = gridAt(at.p, n);
  vec3 sum = max(lattice.rgb, vec3(0.0)) * lattice.w;  // model: as above
#if ENVIRONMENT || PROBES
  for (float rest = 1.0 - lattice.w; rest > 0.0; rest = 0.0) sum += ambientAround(at, n) * rest;
#endif
  return sum;
#else
  return ambientAround(at, n);
#endif
}

#if RUNG_ENVIRONMENT_SPECULAR != ENVIRONMENT_SPECULAR_NONE
#if PROBES
vec3 probeRadiance(int record, vec3 p, vec3 d, float roughness) {
  float layer = texelFetch(probeRecords, record + 4).w;
  vec4 capture = texelFetch(probeRecords, record + 5);  // w: what texels are multiplied by
  vec3 direction = d;
#if RUNG_REFLECTION != REFLECTION_INFINITE
  vec3 x = texelFetch(probeRecords, record).xyz, y = texelFetch(probeRecords, record + 1).xyz, z = texelFetch(probeRecords, record + 2).xyz;
  vec3 own = vec3(dot(x, d), dot(y, d), dot(z, d)), q = inBox(record, p), extent = texelFetch(probeRecords, record + 3).xyz;
  vec3 hit = probeHit(q, own, extent), to = probeDirection(hit, own, capture.xyz);
  direction = x * to.x + y * to.y + z * to.z;
#if RUNG_REFLECTION == REFLECTION_BOX_ROUGH
  roughness = probeRoughness(roughness, q, hit, capture.xyz);
#endif
#endif
  return textureLod(probeCubes, vec4(direction, layer), cubeLevel(roughness, frame.probes.y)).rgb * capture.w;
}
#endif

// Radiance that arrives from the direction d (unit), averaged over the lobe of that perceptual roughness.
vec3 radianceAt(Place at, vec3 d, float roughness) {
  vec3 sum = vec3(0.0);
#if PROBES
#if ENVIRONMENT
  if (at.blend.sky > 0.0) sum = textureLod(environmentCube, d, cubeLevel(roughness, lastLevel())).rgb * (frame.background.w * at.blend.sky);
#endif
  for (int i = 0; i < PLACES(at); ++i) sum += probeRadiance(at.probe[i] * PROBE_TEXELS, at.p, d, roughness) * at.blend.weight[i];
#elif ENVIRONMENT
  sum = textureLod(environmentCube, d, cubeLevel(roughness, lastLevel())).rgb * frame.background.w;
#endif
  return sum;
}
#endif
