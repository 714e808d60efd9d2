// The lighting equation for one surface and one light direction.

// The diffuse BRDF with what specular leaves to it, albedo included. Only the dielectric part has diffuse light and takes from it: a share 1 - metalness of the surface is that
// part, so the mixed F0 of a partly metallic one (a filtered edge, rust) must not darken it or tint it.
// A surface with a diffuse roughness of its own is Oren-Nayar's whatever the rung, which says what share of the light gets there.
FN vec3 diffuseRung(Surface m, Angles a, vec2 dfgL, Rungs k) {
  if (k.diffuse == DIFFUSE_LAMBERT && k.roughDiffuse == 0) return m.diffuse * Fd_lambert();
  real share;
  if (k.diffuse == DIFFUSE_LAMBERT) share = R(1.0);
  else if (k.diffuse == DIFFUSE_COUPLED || k.diffuse == DIFFUSE_OREN_NAYAR_ENERGY) share = coupledShare(m.dielectric, m.dfg, dfgL, m.dfgMean, k);
  else if (k.diffuse == DIFFUSE_COUPLED_FIT) share = coupledFitShare(m.dielectric, m.nov, a.nol, m.alpha, k.fresnel);
  else share = R(1.0) - fresnelDielectricPart(m.dielectric, a.loh, k.fresnel);
  bool own = k.roughDiffuse == 1 && m.sigma > R(0.0);
  real sigma = own ? m.sigma : sigmaFromAlpha(m.alpha);
  if (k.roughDiffuse == 1 && k.diffuse < DIFFUSE_OREN_NAYAR_QUALITATIVE) sigma = m.sigma;
  if (k.diffuse == DIFFUSE_OREN_NAYAR_QUALITATIVE) return m.diffuse * (share * Fd_orenNayarQualitative(a.nol, m.nov, a.lov, sigma));
  if (k.diffuse == DIFFUSE_OREN_NAYAR)
    return vec3(Fd_orenNayar(a.nol, m.nov, a.lov, sigma, m.diffuse.x), Fd_orenNayar(a.nol, m.nov, a.lov, sigma, m.diffuse.y), Fd_orenNayar(a.nol, m.nov, a.lov, sigma, m.diffuse.z)) * share;
  if (k.diffuse == DIFFUSE_OREN_NAYAR_ENERGY || k.roughDiffuse == 1)
    return vec3(Fd_orenNayarEnergy(a.nol, m.nov, a.lov, sigma, m.diffuse.x), Fd_orenNayarEnergy(a.nol, m.nov, a.lov, sigma, m.diffuse.y), Fd_orenNayarEnergy(a.nol, m.nov, a.lov, sigma, m.diffuse.z)) * share;
  return m.diffuse * (share * Fd_lambert());
}

// Reflected radiance for unit irradiance on a plane facing the light, n·l included, diffuse and specular apart (occlusion may weigh them differently).
// l: unit, to the light. dfgL: the lobe's (scale, bias) at n·l, only for rungs that need it (needsAlbedoTable). Zero where n·l <= 0.
FN void shadeParts(Surface m, vec3 l, vec2 dfgL, Rungs k, OUT(vec3) diffuse, OUT(vec3) specular) {
  Angles a = anglesOf(m, l);
  vec3 f = fresnelRung(m.f0, m.eta, m.k, a.loh, k.fresnel);
  real nol = unitClamp(a.nol);
  diffuse = diffuseRung(m, a, dfgL, k) * nol;
  // The models without a cosine of their own end at the horizon.
  bool cosine = k.specular != SPECULAR_PHONG && k.specular != SPECULAR_BLINN_PHONG;
  specular = f * (cosine || a.nol > R(0.0) ? specularRung(m, a, k) : R(0.0));
  if (k.compensation == COMPENSATION_MULTIPLE_SCATTERING)
    specular += vec3(scatteredShare(m.f0.x, m.dfgMean, k.fresnel), scatteredShare(m.f0.y, m.dfgMean, k.fresnel), scatteredShare(m.f0.z, m.dfgMean, k.fresnel)) *
                (multipleScatteringLobe(m.dfg, dfgL, m.dfgMean) * nol);
}

FN vec3 shadeDirection(Surface m, vec3 l, vec2 dfgL, Rungs k) {
  vec3 diffuse;
  vec3 specular;
  shadeParts(m, l, dfgL, k, diffuse, specular);
  return diffuse + specular;
}
