// Energy: what a specular lobe reflects in all, what it loses between facets, and what is left for diffuse. One channel each, f0 in [0, 1].
// dfg = (scale, bias) of the lobe at one direction, mean = the same averaged over the hemisphere (2 ∫ dfg c dc): engine/prefilter tabulates both.

// Reflectance of the lobe alone: F0 · scale + bias (Karis 2013, eq. 8); all of it F0 with a Fresnel rung that is constant.
FN real lobeAlbedo(real f0, vec2 dfg, int fresnel) { return fresnel == FRESNEL_NONE ? f0 * (dfg.x + dfg.y) : f0 * dfg.x + dfg.y; }

// The part of multiply scattered light that each bounce keeps: Fm² E / (1 - Fm (1 - E)), Fm the mean of Fresnel's reflectance, E the lobe's mean albedo with F = 1.
// Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks", slide 18.
FN real scatteredShare(real f0, vec2 mean, int fresnel) {
  real e = unitClamp(mean.x + mean.y);
  real f = fresnelMean(f0, fresnel);
  return f * f * e / max((R(1.0) - f) + f * e, BURNISH_GUARD_LOSS);
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

// The same for a smooth surface, whose albedo is Fresnel's reflectance itself: (1 - F(n·v))(1 - F(n·l)) / (1 - F mean); with Schlick's 21/20 (1 - F0)(1 - (1 - n·v)^5)(1 - (1 - n·l)^5).
// Shirley, Hu, Smits and Lafortune 1997, "A Practitioners' Assessment of Light Reflection Models", section 3. No table, reciprocal, and the sum never passes 1 (tests/shading/energy_test),
// while 1 - F(l·h) lets diffuse keep what specular reflects toward a grazing eye.
FN real coupledSmoothShare(real f0, real nov, real nol, int fresnel) {
  return (R(1.0) - fresnelDielectricPart(f0, nov, fresnel)) * (R(1.0) - fresnelDielectricPart(f0, nol, fresnel)) / max(R(1.0) - fresnelMean(f0, fresnel), BURNISH_GUARD_LOSS);
}

// Diffuse takes what specular leaves, on the way in and on the way out: (1 - E(v))(1 - E(l)) / (1 - E mean). Kelemen and Szirmay-Kalos 2001, eq. 8 and 9. Reciprocal;
// with diffuse albedo 1 the sum of both is 1 at every angle.
FN real coupledShare(real f0, vec2 dfgV, vec2 dfgL, vec2 mean, Rungs k) {
  real left = R(1.0) - specularAlbedo(f0, mean, mean, k);
  return (R(1.0) - specularAlbedo(f0, dfgV, mean, k)) * (R(1.0) - specularAlbedo(f0, dfgL, mean, k)) / max(left, BURNISH_GUARD_LOSS);
}
