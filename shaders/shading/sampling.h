// Importance sampling of the lobes, with densities. u, w: uniform in [0, 1). Directions are in the frame of the normal (z), or of the mirrored direction for Phong's lobe.
// Half vectors are drawn with density D (n·h) per solid angle (Walter et al. 2007, eq. 28, 35 and section 5.3), so a light direction has density D (n·h) / (4 (l·h)).

FN vec3 fromPolar(real sin2, real w) {
  real s = sqrt(unitClamp(sin2));
  real phi = R(2.0) * BURNISH_PI * w;
  return vec3(s * cos(phi), s * sin(phi), sqrt(unitClamp(R(1.0) - sin2)));
}

// sin² of the polar angle. cos^n falls off as u^(1/(n + 1)): sin² = 1 - u^(2/(n + 1)) = -expm1(2 ln u/(n + 1)), without cancellation for narrow lobes.
FN real sampleCosinePower(real u, real n) { return unitClamp(oneMinusExp(R(-1.3862943611198906) * log2(max(unitClamp(u), BURNISH_GUARD_RANDOM)) / (notNegative(n) + R(1.0)))); }
// tan² = -alpha² ln u
FN real sampleBeckmann(real u, real alpha) {
  real a = max(unitClamp(alpha), BURNISH_GUARD_ALPHA);
  real t2 = a * a * R(-0.69314718055994531) * log2(max(unitClamp(u), BURNISH_GUARD_RANDOM));
  return t2 / (R(1.0) + t2);
}
// tan² = alpha² (1 - u)/u
FN real sampleGgx(real u, real alpha) {
  real a = max(unitClamp(alpha), BURNISH_GUARD_ALPHA);
  real x = max(unitClamp(u), BURNISH_GUARD_RANDOM);
  real t2 = a * a * (R(1.0) - x);
  return t2 / (x + t2);
}

// The half vector of the family (the mirrored direction's deviation for Phong's).
FN vec3 sampleLobe(real u, real w, real alpha, int family) {
  if (family == LOBE_FAMILY_BECKMANN) return fromPolar(sampleBeckmann(u, alpha), w);
  if (family == LOBE_FAMILY_GGX) return fromPolar(sampleGgx(u, alpha), w);
  real p = powerFromAlpha(alpha);
  // D (n·h) ~ cos^(p + 1).
  return fromPolar(sampleCosinePower(u, family == LOBE_FAMILY_PHONG ? phongFromBlinnPhong(p) : p + R(1.0)), w);
}

// Its density per solid angle at a direction with sin2 = sin² of the polar angle, in the upper hemisphere.
FN real lobeDensity(real sin2, real alpha, int family) {
  real c = sqrt(unitClamp(R(1.0) - sin2));
  if (family == LOBE_FAMILY_BECKMANN) return D_beckmann(sin2, alpha) * c;
  if (family == LOBE_FAMILY_GGX) return D_ggx(sin2, alpha) * c;
  real p = powerFromAlpha(alpha);
  if (family == LOBE_FAMILY_PHONG) {
    real q = phongFromBlinnPhong(p);
    return (q + R(1.0)) / (R(2.0) * BURNISH_PI) * lobeStable(sin2, q);
  }
  return D_blinnPhong(lobeStable(sin2, p), p) * c;
}

// The half vector of a lobe with two widths (shading/anisotropy.h; not Phong's). tan φ = alphaY/alphaX tan(2 pi w), as Walter 2005 samples Ward's ("Notes on the Ward BRDF", eq. 7);
// the family's own angle for the width there, alpha² = alphaX² cos²(2 pi w) + alphaY² sin²(2 pi w).
FN vec3 sampleTwoWidths(real u, real w, real alphaX, real alphaY, int family) {
  real phi = R(2.0) * BURNISH_PI * w;
  real x = max(unitClamp(alphaX), BURNISH_GUARD_ALPHA) * cos(phi);
  real y = max(unitClamp(alphaY), BURNISH_GUARD_ALPHA) * sin(phi);
  real alpha = sqrt(x * x + y * y);
  vec3 h = sampleLobe(u, R(0.0), alpha, family);
  return vec3(h.x * x / alpha, h.x * y / alpha, h.z);
}

// Its density per solid angle: D (n·h).
FN real twoWidthsDensity(vec3 h, real alphaX, real alphaY, int family) {
  real alpha = alphaAlong(h.x, h.y, alphaX, alphaY);
  return lobeDensity(h.x * h.x + h.y * h.y, alpha, family) * twoWidthsScale(alpha, alphaX, alphaY);
}

// The diffuse lobe: density cos/pi.
FN vec3 sampleCosine(real u, real w) { return fromPolar(unitClamp(u), w); }
FN real cosineDensity(real cosine) { return unitClamp(cosine) / BURNISH_PI; }

// Radical inverse in base 2 (van der Corput) of an index below 2^24, by its bits as numbers: GLSL and C++ (which has no unsigned reversal in common with it) agree bit for bit.
FN real radicalInverse(int index) {
  real result = R(0.0);
  real digit = R(0.5);
  for (int i = index; i > 0; i /= 2) {
    if (i - i / 2 * 2 == 1) result += digit;
    digit *= R(0.5);
  }
  return result;
}
