// Energy: what a specular lobe reflects in all, what it loses between facets, and what is left for diffuse. One channel each, f0 in [0, 1].
// dfg = (scale, bias) of the lobe at one direction, mean = the same averaged over the hemisphere (2 ∫ dfg c dc): engine/prefilter tabulates both.

// Reflectance of the lobe alone: F0 · scale + bias (Karis 2013, eq. 8); all of it F0 with a Fresnel rung that is constant.
FN real lobeAlbedo(real f0, vec2 dfg, int fresnel) { return fresnel == FRESNEL_NONE ? f0 * (dfg.x + dfg.y) : f0 * dfg.x + dfg.y; }

// The part of multiply scattered light that each bounce keeps: Fm² E / (1 - Fm (1 - E)), Fm the mean of Fresnel's reflectance, E the lobe's mean albedo with F = 1.
// Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks", slide 18.
FN real scatteredShare(real f0, vec2 mean, int fresnel) {
  real e = unitClamp(mean.x + mean.y);
  real f = fresnelMean(f0, fresnel);
  return f * f * e / max(notNegative(R(1.0) - f) + f * e, BURNISH_GUARD_LOSS);
}

// What the lobe loses at one direction with F = 1.
FN real lobeLoss(vec2 dfg) { return unitClamp(R(1.0) - dfg.x - dfg.y); }

// The lost energy as a lobe of its own: (1 - E(v))(1 - E(l)) / (pi (1 - E mean)), to be scaled by scatteredShare. Reciprocal.
// Kulla and Conty 2017, slide 13; Kelemen and Szirmay-Kalos 2001, eq. 9.
FN real multipleScatteringLobe(vec2 dfgV, vec2 dfgL, vec2 mean) { return lobeLoss(dfgV) * lobeLoss(dfgL) / (BURNISH_PI * max(lobeLoss(mean), BURNISH_GUARD_LOSS)); }

// Reflectance of the lobe and what is given back.
FN real specularAlbedo(real f0, vec2 dfg, vec2 mean, Rungs k) {
  real e = lobeAlbedo(f0, dfg, k.fresnel);
  if (k.compensation == COMPENSATION_MULTIPLE_SCATTERING) e += scatteredShare(f0, mean, k.fresnel) * lobeLoss(dfg);
  return unitClamp(e);
}

// A fit of the default lobe's albedo (Blinn-Phong, Kelemen): Fresnel's rise toward grazing, held down on rough surfaces, e = F0 + (F - F0) (1 + 2.8 α²)/(1 + 16 α²) + 0.007.
// It lies at or above the lobe's own everywhere, so that a white furnace never passes 1 (tests/shading/furnace_test): the last term pays for that.
// `reflectance`: Fresnel's at one direction, or its mean.
FN real fittedAlbedo(real f0, real reflectance, real alpha) {
  real a2 = unitClamp(alpha) * unitClamp(alpha);
  return unitClamp(f0 + (reflectance - f0) * ((R(1.0) + R(2.8) * a2) / (R(1.0) + R(16.0) * a2)) + R(0.007));
}

// Diffuse takes what that lobe leaves, on the way in and on the way out: (1 - e(v))(1 - e(l))/(1 - mean e). Reciprocal, no table. Shirley, Hu, Smits and Lafortune 1997, "A Practitioners'
// Assessment of Light Reflection Models", section 3, is its case of a smooth surface: 21/20 (1 - F0)(1 - (1 - n·v)^5)(1 - (1 - n·l)^5).
// 1 - F(l·h) in its place lets diffuse keep what specular reflects toward a grazing eye.
FN real coupledFitShare(real f0, real nov, real nol, real alpha, int fresnel) {
  real v = R(1.0) - fittedAlbedo(f0, fresnelDielectricPart(f0, nov, fresnel), alpha);
  real l = R(1.0) - fittedAlbedo(f0, fresnelDielectricPart(f0, nol, fresnel), alpha);
  return v * l / max(R(1.0) - fittedAlbedo(f0, fresnelMean(f0, fresnel), alpha), BURNISH_GUARD_LOSS);
}

// Diffuse takes what specular leaves, on the way in and on the way out: (1 - E(v))(1 - E(l)) / (1 - E mean). Kelemen and Szirmay-Kalos 2001, eq. 8 and 9. Reciprocal;
// with diffuse albedo 1 the sum of both is 1 at every angle.
FN real coupledShare(real f0, vec2 dfgV, vec2 dfgL, vec2 mean, Rungs k) {
  real left = R(1.0) - specularAlbedo(f0, mean, mean, k);
  return (R(1.0) - specularAlbedo(f0, dfgV, mean, k)) * (R(1.0) - specularAlbedo(f0, dfgL, mean, k)) / max(left, BURNISH_GUARD_LOSS);
}
