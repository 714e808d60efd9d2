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
  real alphaX;   // the widths along them
  real alphaY;
  real sigma;    // diffuse roughness of its own, radians; 0: none
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
  m.sigma = R(0.0);
  m.dfg = vec2(R(1.0), R(0.0));
  m.dfgMean = vec2(R(1.0), R(0.0));
  return m;
}

// Gives the lobe a width of its own along the tangent; under m.alpha it counts for nothing. What asks for one alpha (tables of albedo, coupling, occlusion) gets the mean of the two:
// docs/shading.md has the error.
// tangent: any length; one that is no direction, or lies along the normal, leaves the surface isotropic.
FN void setWidth(INOUT(Surface) m, vec3 tangent, real alphaX) {
  vec3 held = vec3(heldLarge(tangent.x), heldLarge(tangent.y), heldLarge(tangent.z));
  vec3 t = held - m.n * dot(m.n, held);
  real length2 = dot(t, t);
  if (length2 <= BURNISH_GUARD_LENGTH) return;
  m.t = t * inversesqrt(length2);
  m.b = cross(m.n, m.t);
  m.alphaX = max(alphaX, m.alpha);  // model: the wider of the two lies along the tangent
  m.alpha = meanAlpha(m.alphaX, m.alphaY);
  m.power = powerFromAlpha(m.alpha);
}
FN void setTangent(INOUT(Surface) m, vec3 tangent, real strength) { setWidth(m, tangent, alphaOfStrength(m.alpha, strength)); }
