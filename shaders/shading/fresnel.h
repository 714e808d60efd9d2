// Fresnel reflectance of unpolarized light. loh = l·h and cosines: any number, taken into [0, 1]; f0 in [0, 1]; the result lies in [0, 1].

// (1 - c)^5. Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 15.
FN real schlickWeight(real c) {
  real x = unitClamp(R(1.0) - c);
  real x2 = x * x;
  return x2 * x2 * x;
}

// Spherical-Gaussian fit of the same: 2^((-5.55473 c - 6.98316) c). Lagarde 2012, "Spherical Gaussian approximation for Blinn-Phong, Phong and Fresnel"; Karis 2013, eq. 5.
FN real sphericalGaussianWeight(real c) {
  real x = unitClamp(c);
  return exp2((R(-5.55473) * x - R(6.98316)) * x);
}

// Mix of f0 and 1 by a weight.
FN vec3 fresnelMix(vec3 f0, real w) { return f0 + (vec3(R(1.0)) - f0) * w; }

FN vec3 F_schlick(vec3 f0, real loh) { return fresnelMix(f0, schlickWeight(loh)); }
FN vec3 F_sphericalGaussian(vec3 f0, real loh) { return fresnelMix(f0, sphericalGaussianWeight(loh)); }

// Exact, of a dielectric whose reflectance at normal incidence is f0: eta = (1 + s)/(1 - s), s = sqrt(f0). Born and Wolf, "Principles of Optics", section 1.5.2, eq. 20 and 21,
// with numerators and denominators times 1 - s, so that nothing overflows as f0 goes to 1: g (1 - s) = sqrt(4 s + (1 - s)² c²).
FN real F_dielectric(real f0, real loh) {
  real c = unitClamp(loh);
  real s = sqrt(unitClamp(f0));
  real d = max(R(1.0) - s, BURNISH_GUARD_INDEX);
  s = R(1.0) - d;
  real dc = d * c;
  real g = sqrt(R(4.0) * s + dc * dc);
  real perpendicular = (g - dc) / max(g + dc, BURNISH_GUARD_FRESNEL);
  // eta² cos = (1 + s)² c / (1 - s)², cos of the refracted ray times eta = g/(1 - s).
  real e = (R(1.0) + s) * (R(1.0) + s) * c;
  real parallel = (e - d * g) / max(e + d * g, BURNISH_GUARD_FRESNEL);
  return R(0.5) * (perpendicular * perpendicular + parallel * parallel);
}

// Exact, for eta = index behind the surface over index before it (both real, eta > 0); 1 beyond the critical angle. The same equations.
FN real dielectricReflectance(real eta, real cosine) {
  real c = unitClamp(cosine);
  real n = clamp(abs(eta), BURNISH_GUARD_FRESNEL, R(1e9));  // model: no larger index exists, and its square must not overflow
  real g2 = n * n - R(1.0) + c * c;
  if (g2 <= R(0.0)) return R(1.0);
  real g = sqrt(g2);
  real perpendicular = (c - g) / max(c + g, BURNISH_GUARD_FRESNEL);
  real parallel = (n * n * c - g) / max(n * n * c + g, BURNISH_GUARD_FRESNEL);
  return unitClamp(R(0.5) * (perpendicular * perpendicular + parallel * parallel));
}

// Exact, of a conductor in air, index eta - i k (eta >= 0, k >= 0), one channel. Born and Wolf, section 14.2; in this form Lagarde 2013, "Memo on Fresnel equations":
// a² + b² = sqrt((eta² - k² - sin²)² + 4 eta² k²).
FN real F_conductor(real eta, real k, real loh) {
  real c = unitClamp(loh);
  real c2 = c * c;
  real s2 = R(1.0) - c2;
  real n = clamp(eta, R(0.0), R(1e4));  // model: no metal has more, and fourth powers must not overflow
  real x = clamp(k, R(0.0), R(1e4));    // model
  real n2 = n * n;
  real k2 = x * x;
  real t0 = n2 - k2 - s2;
  real t = sqrt(t0 * t0 + R(4.0) * n2 * k2);
  real a = sqrt(notNegative(R(0.5) * (t + t0)));
  real perpendicular = (t + c2 - R(2.0) * a * c) / max(t + c2 + R(2.0) * a * c, BURNISH_GUARD_FRESNEL);
  real u = c2 * t + s2 * s2;
  real v = R(2.0) * a * c * s2;
  real parallel = perpendicular * (u - v) / max(u + v, BURNISH_GUARD_FRESNEL);
  return unitClamp(R(0.5) * (perpendicular + parallel));
}

// Snell's law and what crosses the surface. toEye, n: unit, on one side (toEye·n >= 0); eta = index on the far side over index on the eye's side.
// Returns the transmittance 1 - F, exact, and the refracted direction (unit, leaving the far side); 0 and the mirrored direction beyond the critical angle.
// Radiance that crosses also scales by 1/eta² (Walter et al. 2007, section 4.3), which is the caller's.
FN real refractSnell(vec3 toEye, vec3 n, real eta, OUT(vec3) direction) {
  real c = unitClamp(dot(toEye, n));
  real ratio = R(1.0) / max(abs(eta), BURNISH_GUARD_FRESNEL);
  vec3 tangent = toEye - n * c;
  real sin2 = dot(tangent, tangent) * ratio * ratio;
  if (sin2 >= R(1.0)) {
    direction = n * c - tangent;
    return R(0.0);
  }
  direction = tangent * -ratio - n * sqrt(R(1.0) - sin2);
  return R(1.0) - dielectricReflectance(eta, c);
}

// The same scaled to f0 at normal incidence: a map's tint over the named metal's curve. Not above 1.
FN real conductorOver(real f0, real eta, real k, real loh) {
  real n = clamp(eta, R(0.0), R(1e4));  // model: as in F_conductor
  real x = clamp(k, R(0.0), R(1e4));    // model
  real normal = ((n - R(1.0)) * (n - R(1.0)) + x * x) / ((n + R(1.0)) * (n + R(1.0)) + x * x);
  return unitClamp(F_conductor(n, x, loh) * (unitClamp(f0) / max(normal, BURNISH_GUARD_FRESNEL)));
}

// The rung in force. eta, k: of named conductors, eta 0 elsewhere, where the exact equation takes its index from f0.
FN vec3 fresnelRung(vec3 f0, vec3 eta, vec3 k, real loh, int rung) {
  if (rung == FRESNEL_NONE) return f0;
  if (rung == FRESNEL_SPHERICAL_GAUSSIAN) return F_sphericalGaussian(f0, loh);
  if (rung == FRESNEL_CONDUCTOR && eta.x > R(0.0)) return vec3(conductorOver(f0.x, eta.x, k.x, loh), conductorOver(f0.y, eta.y, k.y, loh), conductorOver(f0.z, eta.z, k.z, loh));
  if (rung == FRESNEL_DIELECTRIC || rung == FRESNEL_CONDUCTOR) return vec3(F_dielectric(f0.x, loh), F_dielectric(f0.y, loh), F_dielectric(f0.z, loh));
  return F_schlick(f0, loh);
}

// The same for the dielectric part of a surface, one channel.
FN real fresnelDielectricPart(real f0, real loh, int rung) {
  if (rung == FRESNEL_NONE) return f0;
  if (rung == FRESNEL_DIELECTRIC || rung == FRESNEL_CONDUCTOR) return F_dielectric(f0, loh);
  return f0 + (R(1.0) - f0) * (rung == FRESNEL_SPHERICAL_GAUSSIAN ? sphericalGaussianWeight(loh) : schlickWeight(loh));
}

// The mean of the reflectance over the hemisphere, 2 ∫ F(c) c dc: Schlick's is f0 + (1 - f0)/21. One channel.
FN real fresnelMean(real f0, int rung) { return rung == FRESNEL_NONE ? f0 : f0 + (R(1.0) - f0) * (R(1.0) / R(21.0)); }
