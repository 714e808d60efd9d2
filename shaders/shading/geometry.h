// Visibility V = G / (4 (n·l) (n·v)). nol, nov in [0, 1], alpha in (0, 1]. Times n·l each is finite for any finite input.

// Void geometry: G = (n·l)(n·v), every facet sees everything.
FN real V_void() { return R(0.25); }

// Kelemen and Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model", eq. 3: G/(nl nv) ~ 1/(l·h)².
// As |l + v|² = 4 (l·h)², V is just inverse = 1/|l + v|²: no half vector is needed.
FN real V_kelemen(real inverse) { return inverse; }

// Schlick 1994, eq. 19: G1 = c/(c (1 - k) + k); k = alpha sqrt(2/pi) fits Smith's Beckmann, alpha/2 GGX's (Karis 2013, eq. 4).
// kl, kv: of the light's and of the eye's side, which differ where the surface has two widths; so below.
FN real V_schlickSmith(real nol, real nov, real kl, real kv) {
  real l = unitClamp(nol) * (R(1.0) - kl) + kl;
  real v = unitClamp(nov) * (R(1.0) - kv) + kv;
  return R(0.25) / max(l * v, BURNISH_GUARD_VISIBILITY);
}
FN real V_schlickSmith(real nol, real nov, real k) { return V_schlickSmith(nol, nov, k, k); }

// Height-correlated Smith for GGX: Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", eq. 99 with eq. 72.
FN real V_smithGgx(real nol, real nov, real alphaL, real alphaV) {
  real l = unitClamp(nol);
  real v = unitClamp(nov);
  real al = unitClamp(alphaL);
  real av = unitClamp(alphaV);
  real sum = l * sqrt(v * v * (R(1.0) - av * av) + av * av) + v * sqrt(l * l * (R(1.0) - al * al) + al * al);
  return R(0.5) / max(sum, BURNISH_GUARD_VISIBILITY);
}
FN real V_smithGgx(real nol, real nov, real alpha) { return V_smithGgx(nol, nov, alpha, alpha); }

// cosine · Lambda of Beckmann's distribution (Blinn-Phong takes it with the width of its power): rational fit of Walter et al. 2007, eq. 27 and section 5.2, within 0.35 %.
// With a = c/(alpha s), c · Lambda(a) = alpha s (1 - 1.259 a + 0.396 a²)/(3.535 + 2.181 a): no division by the cosine is left.
FN real lambdaBeckmann(real c, real alpha) {
  real s = alpha * sqrt(unitClamp(R(1.0) - c * c));
  if (c >= R(1.6) * s) return R(0.0);
  real a = c / max(s, BURNISH_GUARD_VISIBILITY);
  return s * (R(1.0) - R(1.259) * a + R(0.396) * a * a) / (R(3.535) + R(2.181) * a);
}

// Height-correlated Smith for Beckmann: G = 1/(1 + Lambda(l) + Lambda(v)), Heitz 2014, eq. 99.
FN real V_smithBeckmann(real nol, real nov, real alphaL, real alphaV) {
  real l = unitClamp(nol);
  real v = unitClamp(nov);
  real sum = l * v + l * lambdaBeckmann(v, unitClamp(alphaV)) + v * lambdaBeckmann(l, unitClamp(alphaL));
  return R(0.25) / max(sum, BURNISH_GUARD_VISIBILITY);
}
FN real V_smithBeckmann(real nol, real nov, real alpha) { return V_smithBeckmann(nol, nov, alpha, alpha); }

// V-shaped cavities: G = min(1, 2 nh nv/vh, 2 nh nl/vh). Torrance and Sparrow 1967; Cook and Torrance 1982, "A Reflectance Model for Computer Graphics", eq. for G in section 3.
FN real V_vCavity(real nol, real nov, real noh, real loh) {
  real l = unitClamp(nol);
  real v = unitClamp(nov);
  real open = R(0.25) / max(l * v, BURNISH_GUARD_VISIBILITY);
  real masked = R(0.5) * unitClamp(noh) / max(unitClamp(loh) * max(l, v), BURNISH_GUARD_VISIBILITY);  // model: the smaller cosine masks
  return min(open, masked);                                                                            // model
}
