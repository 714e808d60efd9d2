// Shading one surface with the rungs in force: what the deferred and the forward path share. The includer has included shading/bridge.h, shading/all.h and interface/layout.h and
// declared `frame`; it defines what lighting/around.glsl asks for before this file.
// Definitions: RUNG_* (plan/variants.cpp), ANISOTROPIC (1: surfaces may have two widths), ROUGH_DIFFUSE (1: and a diffuse roughness of their own), DFG (1: the lobe's table is bound), DFG_WIDTH, DFG_HEIGHT, OCCLUSION and those of
// lighting/around.glsl.

const Rungs kRungs = Rungs(RUNG_SPECULAR, RUNG_DISTRIBUTION, RUNG_GEOMETRY, RUNG_NORMALIZATION, RUNG_LOBE, RUNG_FRESNEL, RUNG_DIFFUSE, RUNG_COMPENSATION, ANISOTROPIC, ROUGH_DIFFUSE);

#if DFG
layout(binding = UNIT_DFG) uniform sampler2D dfgTable;
#define DFG_SIZE vec2(DFG_WIDTH, DFG_HEIGHT)
#endif
#include "lighting/around.glsl"

// Looks up what the surface's lobe reflects toward the eye and on the mean. Returns the table's row.
float findEnergy(inout Surface m) {
#if DFG
  float row = dfgRow(m.alpha), scale = dfgScale(m.power, kRungs);
  m.dfg = textureLod(dfgTable, dfgCoordinate(m.nov, row, DFG_SIZE), 0.0).rg * scale;
  if (needsAlbedoTable(kRungs)) m.dfgMean = textureLod(dfgTable, dfgMeanCoordinate(row, DFG_SIZE), 0.0).rg * scale;
  return row;
#else
  return 0.0;
#endif
}

// Radiance for unit irradiance from direction l.
vec3 shadeLight(Surface m, vec3 l, float row, float occlusion) {
  vec2 dfg = vec2(0.0);
#if DFG
  if (needsAlbedoTable(kRungs)) dfg = textureLod(dfgTable, dfgCoordinate(dot(m.n, l), row, DFG_SIZE), 0.0).rg * dfgScale(m.power, kRungs);
#endif
#if RUNG_DIRECT_OCCLUSION == DIRECT_OCCLUSION_SPECULAR
  vec3 diffuse, specular;
  shadeParts(m, l, dfg, kRungs, diffuse, specular);
  return diffuse + specular * occlusion;
#else
  return shadeDirection(m, l, dfg, kRungs);
#endif
}

// Punctual light: position + 1/range^4, pre-exposed candela + bias (shading/light.h).
vec3 punctual(Surface m, vec3 p, vec4 place, vec4 color, float row, float occlusion) {
  vec3 l = place.xyz - p;
  float d2 = max(dot(l, l), BURNISH_GUARD_DISTANCE2);
  float inverse = inversesqrt(d2);
  float e = distanceAttenuation(d2, inverse * inverse, place.w, color.w);
  return shadeLight(m, l * inverse, row, occlusion) * (color.rgb * e);
}

// Share of a spot light's intensity that goes toward p. axis: direction + spot scale (shading/light.h). Under 1 cm the direction shortens with the distance: the cone ends softly.
float inCone(vec3 p, vec4 place, vec4 axis, float offset) {
  vec3 toPoint = p - place.xyz;
  return spotAttenuation(dot(axis.xyz, toPoint) * inversesqrt(max(dot(toPoint, toPoint), BURNISH_GUARD_DISTANCE2)), axis.w, offset);
}

#if SURROUNDINGS
#if RUNG_ENVIRONMENT_SPECULAR == ENVIRONMENT_SPECULAR_SAMPLED
#define SAMPLES 256
// The lobe in force, sampled (Hammersley's points). Each sample reads the level whose lobe has the solid angle that the sample stands for, 1/(density · count), so that few do:
// it adds 1/SAMPLES to the lobe's variance (Krivanek and Colbert 2008, "Real-time Shading with Filtered Importance Sampling").
vec3 sampledReflection(Surface m, Place at) {
  vec3 sum = vec3(0.0), t, b;
  int family = lobeFamily(kRungs);
  bool phong = family == LOBE_FAMILY_PHONG;
  bool twoWidths = ANISOTROPIC == 1 && m.alphaX != m.alphaY && hasTwoWidths(kRungs);
  vec3 axis = phong ? m.n * (2.0 * m.nov) - m.v : m.n;
  basisFrom(axis, t, b);
  if (twoWidths) {
    t = m.t;
    b = m.b;
  }
  for (int i = 0; i < SAMPLES; ++i) {
    float u = (float(i) + 0.5) / float(SAMPLES), w = radicalInverse(i);
    vec3 h = twoWidths ? sampleTwoWidths(u, w, m.alphaX, m.alphaY, family) : sampleLobe(u, w, m.alpha, family);
    vec3 world = t * h.x + b * h.y + axis * h.z;
    float voh = dot(m.v, world), sin2 = h.x * h.x + h.y * h.y;
    vec3 l = phong ? world : world * (2.0 * voh) - m.v;
    if (dot(m.n, l) <= 0.0 || voh <= 0.0 && !phong) continue;
    float density = twoWidths ? twoWidthsDensity(h, m.alphaX, m.alphaY, family) : lobeDensity(sin2, m.alpha, family);
    if (!phong) density /= 4.0 * max(voh, BURNISH_GUARD_NOV);
    Angles a = anglesOf(m, l);
    float roughness = min(sqrt(sqrt(1.0 / (4.0 * BURNISH_PI * float(SAMPLES) * max(density, BURNISH_GUARD_VISIBILITY)))), 1.0);
    sum += radianceAt(at, l, roughness) * fresnelRung(m.f0, m.eta, m.k, a.loh, RUNG_FRESNEL) * (specularRung(m, a, kRungs) / max(density, BURNISH_GUARD_VISIBILITY));
  }
  return sum / float(SAMPLES);
}
#endif

#if RUNG_ENVIRONMENT_SPECULAR != ENVIRONMENT_SPECULAR_NONE && RUNG_ENVIRONMENT_SPECULAR != ENVIRONMENT_SPECULAR_SAMPLED
// The prefiltered surroundings where the surface mirrors them. A lobe with two widths is the round one of the narrow width, spread along the tangent.
vec3 mirrored(Surface m, Place at) {
#if ANISOTROPIC
  if (hasTwoWidths(kRungs)) {
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int i = 0; i < BRUSHED_TAPS; ++i) {
      vec3 l = brushedDirection(m, brushedNode(i));
      float weight = max(dot(m.n, l), BURNISH_GUARD_NOV);
      sum += radianceAt(at, l, sqrt(brushedAlpha(m))) * weight;
      total += weight;
    }
    return sum / total;
  }
#endif
  return radianceAt(at, m.n * (2.0 * m.nov) - m.v, sqrt(m.alpha));
}
#endif

// What the surface reflects of the surroundings.
vec3 surroundings(Surface m, Place at, float occlusion) {
  vec3 ambient = ambientAt(at, m.n);
#if RUNG_ENVIRONMENT_SPECULAR == ENVIRONMENT_SPECULAR_NONE
  vec3 specular = vec3(0.0);
#elif RUNG_ENVIRONMENT_SPECULAR == ENVIRONMENT_SPECULAR_SAMPLED
  vec3 specular = sampledReflection(m, at);
#else
  vec3 specular = mirrored(m, at) * environmentReflectance(m, RUNG_ENVIRONMENT_SPECULAR, RUNG_FRESNEL);
#endif
#if OCCLUSION
  specular *= specularOcclusion(max(m.nov, BURNISH_GUARD_NOV), occlusion, m.alpha, RUNG_SPECULAR_OCCLUSION);
  ambient *= occlusion;
#endif
  return specular + ambient * (ambientAlbedo(m, kRungs) * ambientShare(m, RUNG_ENVIRONMENT_SPECULAR, kRungs) + environmentScattered(m, kRungs));
}
#endif
