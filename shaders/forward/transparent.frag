// A transparent surface over what is behind it: what it adds, and by what it multiplies the picture (dual-source blending; docs/shading.md, "Transparent surfaces").
// Definitions: those of forward/lit.glsl, COVERAGE, EMISSION (1: it emits or is unlit), THROUGH (0 blended, 1 a clear pane, 2 refracts: forward/behind.glsl),
// FAINT (1: its reflections are scaled down and it has diffuse light, which is not).
#include "forward/lit.glsl"
#define THROUGH_BLEND 0
#define THROUGH_CLEAR 1
#define THROUGH_REFRACT 2
#if THROUGH == THROUGH_REFRACT
#include "forward/behind.glsl"
#endif
layout(std140, binding = BINDING_DRAW) uniform Draw { DrawData draw; };
#if EMISSION
layout(binding = UNIT_EMISSIVE) uniform sampler2D mapEmissive;
#endif

layout(location = 0, index = 0) out vec4 outRadiance;
layout(location = 0, index = 1) out vec4 outBehind;

#if THROUGH != THROUGH_BLEND
// World metres of one metre of the mesh along the normal: what a scaled instance makes of the thickness.
float meshScale(vec3 n) {
  vec3 o = draw.model[0].xyz * n.x + draw.model[1].xyz * n.y + draw.model[2].xyz * n.z;
  float o2 = dot(o, o);
  if (o2 <= BURNISH_GUARD_LENGTH) return 0.0;
  o *= inversesqrt(o2);
  return abs(dot(n, vec3(dot(draw.model[0].xyz, o), dot(draw.model[1].xyz, o), dot(draw.model[2].xyz, o))));
}
#endif

// What the surface reflects toward the eye in all: light from behind crosses it as the rest.
vec3 reflectedShare(Surface m) {
#if DFG
  return vec3(specularAlbedo(m.f0.x, m.dfg, m.dfgMean, kRungs), specularAlbedo(m.f0.y, m.dfg, m.dfgMean, kRungs), specularAlbedo(m.f0.z, m.dfg, m.dfgMean, kRungs));
#else
  vec3 f = fresnelRung(m.f0, m.eta, m.k, m.nov, RUNG_FRESNEL);
  return vec3(reflectedFit(m.f0.x, f.x, m.alpha), reflectedFit(m.f0.y, f.y, m.alpha), reflectedFit(m.f0.z, f.z, m.alpha));
#endif
}

// Light of lights and surroundings. seen: the surface as preintegrated reflections take it.
vec3 lit(Surface m, Surface seen, Place at, float row, float occlusion) {
  vec3 sum = litByLights(m, at.p, row, occlusion);
#if SURROUNDINGS
  sum += surroundings(seen, at, occlusion);
#endif
  return sum;
}

void main() {
  Fetched f = fetchMaterial();
  vec3 toEye;
  vec3 p = positionHere(toEye);
  Surface m = surfaceHere(f, toEye);
  float coverage = f.coverage;
#if THROUGH == THROUGH_BLEND
  // The pigment takes its share of what enters, and reflections keep their strength.
  float pigment = material.albedo.a, reflects = 1.0;
  vec3 through = vec3(1.0 - pigment);
  m.diffuse *= pigment;
#else
  if (material.glass.w > 0.5) coverage *= material.albedo.a;
  float solid = 1.0 - substanceMetalness(unitClamp(f.code)), f0 = material.glass.z > 0.0 ? f0FromIndex(material.glass.z) : m.dielectric;
  float eta = indexFromF0(f0), thickness = material.glass.y * meshScale(m.n);
  bool inside = !gl_FrontFacing && thickness > 0.0;
  if (inside) f0 = dielectricReflectance(1.0 / eta, m.nov);
  float reflects = 1.0 + solid * (faintReflection(f0) - 1.0);
  f0 = max(f0, BURNISH_F0_WATER);
  m.f0 += vec3((f0 - m.dielectric) * solid);
  m.dielectric = f0;
  vec3 through = m.diffuse * material.glass.x;
  m.diffuse -= through;
#endif
  float row = findEnergy(m);
  Surface seen = m;
#if THROUGH != THROUGH_BLEND && RUNG_ENVIRONMENT_SPECULAR != ENVIRONMENT_SPECULAR_SAMPLED
  seen.f0 = vec3(schlickF0(m.f0.x, m.nov, RUNG_FRESNEL), schlickF0(m.f0.y, m.nov, RUNG_FRESNEL), schlickF0(m.f0.z, m.nov, RUNG_FRESNEL));
#endif
  Place at = placeAt(p);
  vec3 sum = lit(m, seen, at, row, f.occlusion) * reflects;
#if FAINT
  // Diffuse light is what is left when reflections are taken away.
  Surface bare = m, bareSeen = seen;
  bare.diffuse = bareSeen.diffuse = vec3(0.0);
  sum += (lit(m, seen, at, row, f.occlusion) - lit(bare, bareSeen, at, row, f.occlusion)) * (1.0 - reflects);
#endif
#if DFG
  vec3 share = vec3(1.0) - reflectedShare(seen) * reflects;
#else
  vec3 share = vec3(1.0) - reflectedShare(m) * reflects;
#endif
#if EMISSION
  vec3 emitted = texture(mapEmissive, mapUv(4)).rgb * material.emission.rgb;
  if (material.more.y > 0.5) {
    // Unlit: its colour lies over what is behind.
    sum = vec3(0.0);
    share = vec3(1.0);
    emitted += f.albedo * material.albedo.a;
  }
  sum += emitted * frame.exposure.x;
#endif
  through *= share;
#if FOG
  // What is behind has all of the fog on its way to the eye already: what lets it through adds no more.
  float depth = fogDepthTo(p);
  sum = sum * fogThrough(depth) + fogSource(-toEye) * (vec3(1.0) - through) * fogTaken(depth);
#endif
#if THROUGH == THROUGH_REFRACT
  sum += through * behind(at, toEye, m, eta, thickness, inside);
  through = vec3(0.0);
#endif
  outRadiance = vec4(limitRadiance(sum, frame.exposure.w) * coverage, 1.0);
  outBehind = vec4(through * coverage + (1.0 - coverage), 1.0);
}
