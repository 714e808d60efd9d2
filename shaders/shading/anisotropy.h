// Lobes with two widths, alphaX along the surface's tangent and alphaY across it. Every distribution here depends on the half vector by its angle and its azimuth's width:
//   1/alpha² = cos² φ/alphaX² + sin² φ/alphaY²,   D(h) = D(angle; alpha) alpha²/(alphaX alphaY),
// which is Ward 1992, eq. 5a, and Beckmann's with Gaussian slopes, GGX of Burley 2012 ("Physically-Based Shading at Disney", eq. 13) and the Blinn-Phong lobe of Ashikhmin and
// Shirley 2000 ("An Anisotropic Phong BRDF Model", eq. 4), for p + 2 = 2/alpha² makes p = px cos² φ + py sin² φ. The integral of D (n·h) stays 1, as ∫ alpha² dφ = 2 pi alphaX alphaY;
// so does what a lobe reflects at normal incidence, where it is an average over alpha.

// Width along the tangent of a surface of that alpha: strength in [0, 1] widens it, alpha_t = mix(alpha, 1, strength²) (KHR_materials_anisotropy).
FN real alphaOfStrength2(real alpha, real strength2) { return alpha + (R(1.0) - alpha) * unitClamp(strength2); }
FN real alphaOfStrength(real alpha, real strength) { return alphaOfStrength2(alpha, unitClamp(strength) * unitClamp(strength)); }

// alpha toward a direction with components x, y along tangent and bitangent; between the two widths for any x, y.
FN real alphaAlong(real x, real y, real alphaX, real alphaY) {
  real ax = max(unitClamp(alphaX), BURNISH_GUARD_ALPHA);
  real ay = max(unitClamp(alphaY), BURNISH_GUARD_ALPHA);
  real hx = heldLarge(x);
  real hy = heldLarge(y);
  real qx = hx * hx;
  real qy = hy * hy;
  return sqrt((qx + qy + BURNISH_GUARD_LENGTH) / (qx / (ax * ax) + qy / (ay * ay) + BURNISH_GUARD_LENGTH / (ax * ay)));
}

FN real twoWidthsScale(real alpha, real alphaX, real alphaY) {
  return alpha * alpha / (max(unitClamp(alphaX), BURNISH_GUARD_ALPHA) * max(unitClamp(alphaY), BURNISH_GUARD_ALPHA));
}

// The one alpha that stands for both where one is asked for: the mean of the slopes' variances. The round lobe of that width reflects what this one does on the mean over azimuths within
// 0.09 (docs/shading.md; the narrower width alone would err by 0.5).
FN real meanAlpha(real alphaX, real alphaY) { return sqrt(R(0.5) * (alphaX * alphaX + alphaY * alphaY)); }

// The width of the facets' profile as seen from a direction with components x, y: alpha² = cos² φ alphaX² + sin² φ alphaY². Heitz 2014, "Understanding the Masking-Shadowing
// Function in Microfacet-Based BRDFs", section 5.3 (stretched facets).
FN real alphaToward(real x, real y, real alphaX, real alphaY) {
  real ax = max(unitClamp(alphaX), BURNISH_GUARD_ALPHA);
  real ay = max(unitClamp(alphaY), BURNISH_GUARD_ALPHA);
  real hx = heldLarge(x);
  real hy = heldLarge(y);
  real qx = hx * hx;
  real qy = hy * hy;
  real alpha = sqrt((qx * ax * ax + qy * ay * ay + BURNISH_GUARD_LENGTH * ax * ay) / (qx + qy + BURNISH_GUARD_LENGTH));
  return min(max(alpha, min(ax, ay)), max(ax, ay));  // model: between the two
}
