// The lighting equation of the default path for one surface and one light direction.

// Reflected radiance for unit irradiance on a plane facing the light, n·l included: (Lambert (1 - F) + F D V) n·l.
// rungGeometry: 0 void, 1 Kelemen. rungLobe: 0 exp2, 1 stable. Both are constants where it is called, so nothing is left of the branches.
// No half vector is formed: |l + v|² = 2 + 2 l·v = 4 (l·h)².
FN vec3 shadeDirection(Surface m, vec3 l, int rungGeometry, int rungLobe) {
  real nol = dot(m.n, l);
  real s2 = max(R(2.0) + R(2.0) * dot(l, m.v), BURNISH_GUARD_HALF);
  real w = schlickWeight(R(0.5) * sqrt(s2));
  real inverse = R(1.0) / s2;
  real lobe;
  if (rungLobe == 1) {
    lobe = lobeStable(sinSquaredHalf(m.n, l, nol, m.vt, inverse), m.power);
  } else {
    lobe = lobeExp2(m.nov + nol, inverse, m.power);
  }
  real spec = rungGeometry == 1 ? D_blinnPhong(lobe, m.power) * V_kelemen(inverse) : normalizationExact(m.power) * lobe;
  vec3 f = m.f0 + (vec3(R(1.0)) - m.f0) * w;
  return (m.diffuse * (vec3(R(1.0)) - f) * (R(1.0) / BURNISH_PI) + f * spec) * clamp(nol, R(0.0), R(1.0));
}
