// What shading needs to know of a surface.

struct Surface {
  vec3 n;        // unit normal
  vec3 v;        // unit, to the eye
  vec3 vt;       // v's part in the tangent plane: v - n (n·v)
  vec3 diffuse;  // albedo of the diffuse part
  vec3 f0;       // reflectance at normal incidence
  real nov;      // n·v >= 0
  real alpha;    // roughness squared
  real power;    // of the Blinn-Phong lobe
};

FN Surface makeSurface(vec3 n, vec3 v, vec3 albedo, real substance, real alpha) {
  Surface m;
  m.v = v;
  // A mapped or interpolated normal may look away from the eye, which no surface that is seen does: it is bent back until it is perpendicular to v. Without this a
  // light behind the surface (l near -v) meets n·l > 0 with hardly any half vector, and Kelemen's 1/|l + v|² turns into speckles.
  real nov = dot(n, v);
  m.n = nov < R(0.0) ? normalize(n - v * nov) : n;
  m.nov = max(nov, R(0.0));
  m.vt = v - m.n * m.nov;
  m.diffuse = substanceDiffuse(substance, albedo);
  m.f0 = substanceF0(substance, albedo);
  m.alpha = alpha;
  m.power = powerFromAlpha(alpha);
  return m;
}
