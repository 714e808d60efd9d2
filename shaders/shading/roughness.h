// Perceptual roughness r, width alpha = r², Blinn-Phong power p = 2/alpha² - 2 (the Beckmann-equivalent power: Walter et al. 2007, "Microfacet Models for
// Refraction through Rough Surfaces", section 5.2). Inputs: r, alpha and codes in [0, 1], p >= 0. alphaFromPower, powerFromAlpha and encodeAlpha bear any finite number.

FN real alphaFromRoughness(real r) { return r * r; }

// p from 0 at alpha 1 up to 1.25e7 at alpha 4e-4 and 2e12 at BURNISH_GUARD_ALPHA.
FN real powerFromAlpha(real alpha) {
  real a = max(alpha, BURNISH_GUARD_ALPHA);
  return notNegative(R(2.0) / (a * a) - R(2.0));
}

FN real alphaFromPower(real p) { return sqrt(R(2.0) / (notNegative(p) + R(2.0))); }

// The power of Phong's lobe (r·v)^q that has the width of Blinn's (n·h)^p near the mirror direction: the half vector turns by half the angle, cos^p(x/2) ~ cos^(p/4)(x).
FN real phongFromBlinnPhong(real p) { return R(0.25) * p; }
FN real blinnPhongFromPhong(real q) { return R(4.0) * q; }

// Widths of equal half-maximum of D cos⁴: Beckmann's exp(-tan²/a²) falls to 1/2 at tan² = a² ln 2, GGX's (1 + tan²/a²)^-2 at tan² = a² (sqrt(2) - 1).
FN real ggxFromBeckmann(real alpha) { return alpha * R(1.2936017); }
FN real beckmannFromGgx(real alpha) { return alpha * R(0.77303548); }

// Slopes of facets are Gaussian with variance alpha²/2 along each axis (Beckmann); Oren and Nayar's sigma is the standard deviation of the facets' angle, radians.
FN real sigmaFromAlpha(real alpha) { return alpha * R(0.70710678118654752); }

// The G-buffer's code of alpha in [BURNISH_ALPHA_MIN, 1]: linear in log alpha, so that 8 bits err by at most 1.6 % in alpha (3.2 % in the peak) everywhere.
// log2(1/4e-4) = 11.287712...
FN real encodeAlpha(real alpha) { return R(1.0) + log2(max(unitClamp(alpha), BURNISH_ALPHA_MIN)) / R(11.287712379549449); }
// The alpha to store beside a 24-bit normal: the rounding of the normal (mean square 1.61e-7 rad²) spreads a highlight like facets of that variance, alpha² + 1.61e-7, so it is taken
// off beforehand. Without it the peak at r = 0.05 would lose 2.6 %; at r = 0.1 it is 0.2 %.
FN real storedAlpha(real alpha) { return sqrt(max(alpha * alpha - BURNISH_NORMAL_VARIANCE, BURNISH_ALPHA_MIN * BURNISH_ALPHA_MIN)); }

FN real decodeAlpha(real code) { return exp2((code - R(1.0)) * R(11.287712379549449)); }
