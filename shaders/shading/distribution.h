// Distributions of microfacet normals, normalized so that the integral of D (n·h) over the hemisphere is 1; zero or more for any finite input.
// sin2 = |n×h|² and alpha: any numbers, taken into [0, 1] and [BURNISH_GUARD_ALPHA, 1]; p >= 0.

// Blinn-Phong: (p + 2)/(2 pi) (n·h)^p. Blinn 1977; normalization: Sloup and Krivanek; `lobe` is (n·h)^p from lobe.h.
FN real D_blinnPhong(real lobe, real p) { return (p + R(2.0)) * lobe / (R(2.0) * BURNISH_PI); }

// exp(-tan²/alpha²) / (pi alpha² cos⁴). Beckmann and Spizzichino 1963; Walter et al. 2007, eq. 25.
FN real D_beckmann(real sin2, real alpha) {
  real s = unitClamp(sin2);
  real c2 = max(R(1.0) - s, BURNISH_GUARD_COS2);
  real a = max(unitClamp(alpha), BURNISH_GUARD_ALPHA);
  real a2 = a * a;
  return exp2(R(-1.4426950408889634) * s / (c2 * a2)) / (BURNISH_PI * a2 * c2 * c2);
}

// GGX: alpha² / (pi (cos² (alpha² - 1) + 1)²). Walter et al. 2007, eq. 33, with cos² = 1 - sin²: nothing cancels near the normal.
FN real D_ggx(real sin2, real alpha) {
  real s = unitClamp(sin2);
  real a = max(unitClamp(alpha), BURNISH_GUARD_ALPHA);
  real a2 = a * a;
  real d = s + a2 * (R(1.0) - s);
  return a2 / (BURNISH_PI * d * d);
}

// Void geometry takes f = F N(p) (n·h)^p. N is exact when the directional albedo at normal incidence is 1:
// (p + 2)(p + 4) / (8 pi (2^(-p/2) + p)). Giesen 2009, "Phong and Blinn-Phong normalization factors".
// (p + 4)/(e + p) as 1 + (4 - e)/(e + p): no product overflows, and a reciprocal that some chips take for 0 (of more than 2^126) does no harm.
FN real normalizationExact(real p) {
  real e = exp2(R(-0.5) * p);
  return (p + R(2.0)) / (R(8.0) * BURNISH_PI) * (R(1.0) + (R(4.0) - e) / (e + p));
}

// The rungs of N(p): none; the linear fits 0.0397436 p + 0.0856832 and 0.0397436 p + 0.3183 (Gotanda 2010, "Practical Implementation at tri-Ace", after Giesen);
// (p + 2)/8 pi: V = 1/4 under D; (p + 8)/8 pi (Akenine-Möller, Haines and Hoffman 2008, "Real-Time Rendering", 3rd ed., eq. 7.49); exact.
FN real normalizationRung(real p, int rung) {
  if (rung == NORMALIZATION_NONE) return R(1.0);
  if (rung == NORMALIZATION_LINEAR_FIT) return R(0.0397436) * p + R(0.0856832);
  if (rung == NORMALIZATION_LINEAR_FIT_8) return R(0.0397436) * p + R(0.3183);
  if (rung == NORMALIZATION_PLUS_2) return (p + R(2.0)) / (R(8.0) * BURNISH_PI);
  if (rung == NORMALIZATION_PLUS_8) return (p + R(8.0)) / (R(8.0) * BURNISH_PI);
  return normalizationExact(p);
}
