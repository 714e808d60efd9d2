// Light that crosses a surface: what is left of it, where it leaves a body, what the body absorbs.

// Index of refraction from the reflectance at normal incidence, and back (Born and Wolf, section 1.5.2, eq. 22).
FN real indexFromF0(real f0) {
  real s = sqrt(unitClamp(f0));
  return (R(1.0) + s) / max(R(1.0) - s, BURNISH_GUARD_INDEX);
}
FN real f0FromIndex(real eta) {
  real s = (eta - R(1.0)) / (eta + R(1.0));
  return s * s;
}

// Schlick's equation reaches 1 at grazing incidence for any F0, which no index near 1 does: an F0 under water's, the least that a surface in air has, is drawn as water's times this.
// The same as F90 = min(50 F0, 1) (Lagarde and de Rousiers 2014, section 3.1.3) but for the constant.
FN real faintReflection(real f0) { return min(f0 / BURNISH_F0_WATER, R(1.0)); }  // model: from water on it is whole

// The F0 with which Schlick's equation gives the rung's reflectance at this angle: what preintegrated reflections take in, so that they follow the exact equation on smooth surfaces.
FN real schlickF0(real f0, real cosine, int rung) {
  if (rung != FRESNEL_DIELECTRIC && rung != FRESNEL_CONDUCTOR) return f0;
  real w = schlickWeight(cosine);
  return (F_dielectric(f0, cosine) - w) / max(R(1.0) - w, BURNISH_GUARD_NOV);
}

// What a specular lobe of width alpha reflects, without a table: fittedAlbedo without the share by which that lies above.
FN real reflectedFit(real f0, real reflectance, real alpha) {
  real a2 = unitClamp(alpha) * unitClamp(alpha);
  return unitClamp(f0 + (reflectance - f0) * ((R(1.0) + R(2.8) * a2) / (R(1.0) + R(16.0) * a2)));
}

// Through a body whose far side is parallel to the near one (roundness 0: a slab `thickness` thick) or that is a ball `thickness` across (roundness 1). toEye, n: unit, on the outside;
// eta: index inside over outside, at least 1. Gives the way from the entry to the exit and the direction beyond it (unit), and returns the length of the way (m).
// A slab's way is thickness / cos t and light leaves it as it came; a ball's is thickness · cos t, and its normal at the exit is n + 2 cos t r, for the refracted ray r.
FN real throughBody(vec3 toEye, vec3 n, real eta, real thickness, real roundness, OUT(vec3) way, OUT(vec3) direction) {
  vec3 r;
  refractSnell(toEye, n, eta, r);
  real c = max(-dot(r, n), BURNISH_GUARD_NOV);
  real q = unitClamp(roundness);
  real slab = thickness / c;
  real path = slab + (thickness * c - slab) * q;
  way = r * path;
  // Outward normal where it leaves, from -n to the ball's.
  vec3 e = n * (R(2.0) * q - R(1.0)) + r * (R(2.0) * c * q);
  real e2 = dot(e, e);
  e = e2 > BURNISH_GUARD_LENGTH ? e * inversesqrt(e2) : -n;
  if (refractSnell(-r, -e, R(1.0) / eta, direction) <= R(0.0)) direction = r;  // between slab and ball it may find no way out: it goes on as it is
  return path;
}

// Beer and Lambert: what is left after a way through absorption per metre.
FN vec3 absorbed(vec3 perMetre, real way) { 
  real k = R(-1.4426950408889634) * way;
  return vec3(exp2(k * perMetre.x), exp2(k * perMetre.y), exp2(k * perMetre.z));
}

// Standard deviation (radians, along one axis) of the directions of light that crosses a rough surface: a facet whose slope is s turns it by (eta - 1) s as a thin prism does, and
// slopes of Beckmann's distribution deviate by alpha/sqrt(2).
FN real scatteredAngle(real alpha, real eta) { return alpha * (eta - R(1.0)) * R(0.70710678); }
// alpha of the reflection lobe that is as wide: a facet turns a reflection by 2 s.
FN real scatteredAlpha(real alpha, real eta) { return unitClamp(alpha * (eta - R(1.0)) * R(0.5)); }
