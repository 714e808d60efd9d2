// Light of the surroundings: spherical harmonics for the diffuse part, a prefiltered cube for the specular one.

// Roughness of level k of a prefiltered cube with `last` = index of the last level: r = 1.5 - sqrt(2.25 - 2 k/last), and its inverse.
FN real environmentLevel(real roughness, real last) { return last * roughness * (R(1.5) - R(0.5) * roughness); }
FN real environmentRoughness(real level, real last) { return R(1.5) - sqrt(R(2.25) - R(2.0) * level / last); }

// The real SH basis up to band 2 in the order (0,0) (1,-1) (1,0) (1,1) (2,-2) (2,-1) (2,0) (2,1) (2,2), without its constants: they are folded into the
// coefficients together with the cosine lobe (Ramamoorthi and Hanrahan 2001, eq. 13). The lower rungs leave bands out.
FN vec3 irradianceSh(vec3 n, vec3 c0, vec3 c1, vec3 c2, vec3 c3, vec3 c4, vec3 c5, vec3 c6, vec3 c7, vec3 c8, int rung) {
  if (rung == AMBIENT_NONE) return vec3(R(0.0));
  if (rung == AMBIENT_CONSTANT) return c0;
  vec3 linear = c0 + c1 * n.y + c2 * n.z + c3 * n.x;
  if (rung == AMBIENT_SH_L1) return linear;
  return linear + c4 * (n.x * n.y) + c5 * (n.y * n.z) + c6 * (R(3.0) * n.z * n.z - R(1.0)) + c7 * (n.x * n.z) + c8 * (n.x * n.x - n.y * n.y);
}

// Box-projected ambient light: a probe's light looked up where fixed directions from the point meet its box, seen from where it was captured. The corners of an icosahedron integrate bands up to 5
// exactly, so that at the capture itself the light is that of the three bands. The cosine lobe, 1, 2/3 and 1/4 in the bands, is shared: the directions' weights take 1, 3/4 and 2/5 of what is looked up,
// which takes the rest. Lookups of the bare light would ring, those of the whole irradiance would know little of the box (tests/probe/grid_box_test has the errors).
#define AMBIENT_BOX_TAPS 12
// Direction i, in the axes of the box.
FN vec3 ambientTap(int i) {
  real s = (i & 1) == 0 ? R(0.52573111211913361) : R(-0.52573111211913361);
  real l = (i & 2) == 0 ? R(0.85065080835203993) : R(-0.85065080835203993);
  if (i < 4) return vec3(s, l, R(0.0));
  if (i < 8) return vec3(R(0.0), s, l);
  return vec3(l, R(0.0), s);
}
// Its weight for a surface; cosine: of its angle with the normal.
FN real ambientTapWeight(real cosine) { return (R(1.0) + R(3.0) * R(0.75) * cosine + R(5.0) * R(0.4) * (R(1.5) * cosine * cosine - R(0.5))) * (R(1.0) / R(12.0)); }
// What is looked up: irradiance with that kernel taken out of its bands.
FN vec3 irradianceBands(vec3 d, vec3 c0, vec3 c1, vec3 c2, vec3 c3, vec3 c4, vec3 c5, vec3 c6, vec3 c7, vec3 c8) {
  return c0 + (c1 * d.y + c2 * d.z + c3 * d.x) * R(1.3333333333333333) + (c4 * (d.x * d.y) + c5 * (d.y * d.z) + c6 * (R(3.0) * d.z * d.z - R(1.0)) + c7 * (d.x * d.z) + c8 * (d.x * d.x - d.y * d.y)) * R(2.5);
}

// The share of a prefiltered reflection that the surface reflects, for one channel, by the rung: Schlick's F(n·v); the same held down on rough surfaces,
// F0 + (max(1 - r, F0) - F0)(1 - n·v)^5 (Lagarde 2011, "Adopting a physically based shading model"); the lobe's own albedo F0 · scale + bias (Karis 2013, eq. 8).
FN real environmentReflectance(Surface m, real f0, int rung, int fresnel) {
  if (rung == ENVIRONMENT_SPECULAR_NONE) return R(0.0);
  if (rung == ENVIRONMENT_SPECULAR_SCHLICK) return f0 + (R(1.0) - f0) * schlickWeight(m.nov);
  if (rung == ENVIRONMENT_SPECULAR_ROUGH_SCHLICK) return f0 + (max(R(1.0) - sqrt(unitClamp(m.alpha)), f0) - f0) * schlickWeight(m.nov);  // model: Lagarde's maximum
  return lobeAlbedo(f0, m.dfg, fresnel);
}
FN vec3 environmentReflectance(Surface m, int rung, int fresnel) {
  return vec3(environmentReflectance(m, m.f0.x, rung, fresnel), environmentReflectance(m, m.f0.y, rung, fresnel), environmentReflectance(m, m.f0.z, rung, fresnel));
}

// A lobe with two widths convolves the round one of the narrow width with a Gaussian of slopes along the tangent: alphaX² = alphaY² + spread². The Gaussian is sampled at the middles of
// BRUSHED_TAPS equal shares, x = erf⁻¹((2 i + 1)/BRUSHED_TAPS - 1) (after Revie 2012, "Implementing Fur Using Deferred Shading", which bends one normal along the tangent).
#define BRUSHED_TAPS 8
FN real brushedNode(int i) {
  int k = i < 4 ? 3 - i : i - 4;
  real x = k == 0 ? R(0.11124) : k == 1 ? R(0.34562) : k == 2 ? R(0.62731) : R(1.08479);
  return i < 4 ? -x : x;
}
FN real brushedSpread2(Surface m) { return notNegative(m.alphaX * m.alphaX - m.alphaY * m.alphaY); }
// The mirrored direction about the normal that is tilted by the node's slope.
FN vec3 brushedDirection(Surface m, real node) {
  vec3 h = normalize(m.n + m.t * (node * sqrt(brushedSpread2(m))));
  return h * (R(2.0) * dot(h, m.v)) - m.v;
}
// Width of what is looked up there: the narrow one, and as much of the spread as closes the gaps between taps.
FN real brushedAlpha(Surface m) { return sqrt(m.alphaY * m.alphaY + R(0.03) * brushedSpread2(m)); }

// What multiple scattering adds to it: lit by the ambient light, since it is as wide as diffuse.
FN vec3 environmentScattered(Surface m, Rungs k) {
  if (k.compensation == COMPENSATION_NONE) return vec3(R(0.0));
  return vec3(scatteredShare(m.f0.x, m.dfgMean, k.fresnel), scatteredShare(m.f0.y, m.dfgMean, k.fresnel), scatteredShare(m.f0.z, m.dfgMean, k.fresnel)) * lobeLoss(m.dfg);
}

// What is left for ambient diffuse light, by the diffuse rung: all of it (Lambert), what the rung's own directional albedo is (coupled-fit: 1 - e(n·v)), or what the dielectric
// part does not reflect.
FN real ambientShare(Surface m, int rung, Rungs k) {
  if (k.diffuse == DIFFUSE_LAMBERT) return R(1.0);
  if (k.diffuse == DIFFUSE_COUPLED_FIT) return R(1.0) - fittedAlbedo(m.dielectric, fresnelDielectricPart(m.dielectric, m.nov, k.fresnel), m.alpha);
  if (k.diffuse == DIFFUSE_COUPLED || k.diffuse == DIFFUSE_OREN_NAYAR_ENERGY) return R(1.0) - specularAlbedo(m.dielectric, m.dfg, m.dfgMean, k);
  return unitClamp(R(1.0) - environmentReflectance(m, m.dielectric, rung, k.fresnel));
}

// What diffuse has to reflect ambient light with: its albedo, or that of a rough surface toward the eye. The rung that is rough everywhere takes its sigma from alpha, as toward lights.
FN vec3 ambientAlbedo(Surface m, Rungs k) {
  bool rough = k.diffuse == DIFFUSE_OREN_NAYAR_ENERGY;
  if (k.roughDiffuse == 0 && !rough) return m.diffuse;
  real sigma = rough && (k.roughDiffuse == 0 || m.sigma <= R(0.0)) ? sigmaFromAlpha(m.alpha) : m.sigma;
  return vec3(orenNayarEnergyAlbedo(m.nov, sigma, m.diffuse.x), orenNayarEnergyAlbedo(m.nov, sigma, m.diffuse.y), orenNayarEnergyAlbedo(m.nov, sigma, m.diffuse.z));
}

// Specular occlusion from ambient occlusion, by the rung: none, the ambient occlusion itself, or Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based
// Rendering", listing 26, on alpha (not r).
FN real specularOcclusion(real nov, real ao, real alpha, int rung) {
  if (rung == SPECULAR_OCCLUSION_NONE) return R(1.0);
  if (rung == SPECULAR_OCCLUSION_AO) return unitClamp(ao);
  real a = unitClamp(ao);
  return clamp(pow(unitClamp(nov) + a, exp2(R(-16.0) * unitClamp(alpha) - R(1.0))) - R(1.0) + a, R(0.0), R(1.0));  // model: Lagarde's saturate
}
