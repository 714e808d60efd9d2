// What shading needs to know of a surface.

struct Surface {
  vec3 n;        // unit normal
  vec3 v;        // unit, to the eye
  vec3 vt;       // v's part in the tangent plane: v - n (n·v)
  vec3 diffuse;  // albedo of the diffuse part
  vec3 f0;       // reflectance at normal incidence: dielectric and metallic parts together
  real dielectric;  // of the dielectric part alone: what diffuse light passes on its way
  real nov;      // n·v >= 0
  real alpha;    // roughness squared
  real power;    // of the Blinn-Phong lobe
  vec3 eta;      // index of a named conductor and
  vec3 k;        // its extinction; eta 0: not a named conductor. The G-buffer holds neither (forward path)
  vec3 t;        // unit tangent and
  vec3 b;        // bitangent, with
  real alphaX;   // the widths along them; the G-buffer holds none of the four (forward path)
  real alphaY;
  vec2 dfg;      // the lobe's (scale, bias) at n·v and
  vec2 dfgMean;  // over the hemisphere, from the table; only for rungs that need it (needsAlbedoTable)
};

// n, v: unit. albedo, substance: as the maps hold them, [0, 1]. alpha: (0, 1].
FN Surface makeSurface(vec3 n, vec3 v, vec3 albedo, real substance, real alpha) {
  Surface m;
  m.v = v;
  // A mapped or interpolated normal may look away from the eye, which no surface that is seen does: it is bent back until it is perpendicular to v. Without this a
  // light behind the surface (l near -v) meets n·l > 0 with hardly any half vector, and Kelemen's 1/|l + v|² turns into speckles.
  real nov = dot(n, v);
  vec3 bent = n - v * nov;
  m.n = nov < R(0.0) ? bent * inversesqrt(max(dot(bent, bent), BURNISH_GUARD_LENGTH)) : n;
  m.nov = notNegative(nov);
  m.vt = v - m.n * m.nov;
  m.diffuse = substanceDiffuse(substance, albedo);
  m.f0 = substanceF0(substance, albedo);
  m.dielectric = substanceDielectricF0(substance);
  m.alpha = alpha;
  m.power = powerFromAlpha(alpha);
  m.eta = vec3(R(0.0));
  m.k = vec3(R(0.0));
  m.t = vec3(R(0.0));
  m.b = vec3(R(0.0));
  m.alphaX = alpha;
  m.alphaY = alpha;
  m.dfg = vec2(R(1.0), R(0.0));
  m.dfgMean = vec2(R(1.0), R(0.0));
  return m;
}

// Tangents for the anisotropic rungs: strength in [0, 1] widens the lobe along the tangent, alpha_t = mix(alpha, 1, strength²) (KHR_materials_anisotropy).
// tangent: any length; one that is no direction, or lies along the normal, leaves the surface isotropic.
FN void setTangent(INOUT(Surface) m, vec3 tangent, real strength) {
  vec3 held = vec3(heldLarge(tangent.x), heldLarge(tangent.y), heldLarge(tangent.z));
  vec3 t = held - m.n * dot(m.n, held);
  real length2 = dot(t, t);
  if (length2 <= BURNISH_GUARD_LENGTH) return;
  m.t = t * inversesqrt(length2);
  m.b = cross(m.n, m.t);
  real s = unitClamp(strength);
  m.alphaX = m.alpha + (R(1.0) - m.alpha) * s * s;
}
