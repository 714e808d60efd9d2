// Evaluation of (n·h)^p for unit n, l, v and p >= 0 (1.25e7 in the pipeline). Results lie in [0, 1] for any finite input.

// A power of a cosine as the shading language has it. Loses the lobe to rounding as p grows: n·h near 1 has steps of 6e-8
// (absolute error 0.0028 at r = 0.1, 0.045 at 0.05, 0.74 at 0.02 in float).
FN real lobePow(real noh, real p) { return pow(max(unitClamp(noh), BURNISH_GUARD_LOG), notNegative(p)); }

// The same through exp2 and log2 and without a half vector, from sum = n·l + n·v and inverse = 1/|l + v|²: (n·h)² = sum² · inverse.
FN real lobeExp2(real sum, real inverse, real p) {
  real noh = notNegative(heldLarge(sum));
  return exp2(R(0.5) * notNegative(p) * log2(max(unitClamp(noh * noh * inverse), BURNISH_GUARD_LOG)));
}

// ln(1 - x) for x in [0, 1], relative error below 3e-7 in float also where x is tiny and 1 - x would round to 1.
// With scale = 2^-e such that m = (1 - x) scale lies in [sqrt(1/2), sqrt(2)):  ln(1 - x) = 2 artanh((m - 1)/(m + 1)) + e ln 2
// (Abramowitz and Stegun 4.1.27); the argument is under 0.172, so four terms do. For e = 0 the numerator m - 1 is -x itself: nothing cancels.
FN real logOneMinus(real x) {
  real u = max(R(1.0) - x, BURNISH_GUARD_LOG);
  real e;
  real m = scaleToOne(u, e) * u;
  real t = (e == R(0.0) ? -x : m - R(1.0)) / (m + R(1.0));
  real t2 = t * t;
  return R(2.0) * t * (R(1.0) + t2 * (R(1.0) / R(3.0) + t2 * (R(0.2) + t2 * (R(1.0) / R(7.0))))) + e * R(0.69314718055994531);
}

// 1 - exp(-x) for x >= 0 without cancellation (the series up to x = 0.5: the remainder is under 1e-9).
FN real oneMinusExp(real x) {
  if (x > R(0.5)) return R(1.0) - exp2(x * R(-1.4426950408889634));
  return x * (R(1.0) - x * (R(1.0) / R(2.0) - x * (R(1.0) / R(6.0) - x * (R(1.0) / R(24.0) - x * (R(1.0) / R(120.0) - x * (R(1.0) / R(720.0) - x * (R(1.0) / R(5040.0) - x * (R(1.0) / R(40320.0)))))))));
}

// Through the sine: (n·h)^p = exp(p/2 · ln(1 - |n×h|²)). Stable: absolute error 2.5e-5 at r = 0.05, 1.5e-4 at 0.02 in float
// within 45 degrees of the normal, seven times that toward grazing, where the rounding of l and v themselves turns h.
FN real lobeStable(real sin2, real p) { return exp2(R(0.5) * notNegative(p) * R(1.4426950408889634) * logOneMinus(unitClamp(sin2))); }

// |n×h|² of h = (l + v)/|l + v|, from what l and v leave in the tangent plane: h's own length along n never enters, so nothing cancels near the mirror direction.
// nol = n·l, vt = v - n (n·v), inverse = 1/|l + v|².
FN real sinSquaredHalf(vec3 n, vec3 l, real nol, vec3 vt, real inverse) {
  vec3 t = l - n * nol + vt;
  return dot(t, t) * inverse;
}

// Phong's (r·v)^q, r = 2 n (n·l) - l. 1 - r·v = |r - v|²/2 splits into tangential and normal parts that do not cancel: d2 = |r - v|².
FN real lobePhong(real d2, real q) {
  real x = R(0.5) * d2;
  return x < R(1.0) ? exp2(notNegative(q) * R(1.4426950408889634) * logOneMinus(notNegative(x))) : R(0.0);
}
