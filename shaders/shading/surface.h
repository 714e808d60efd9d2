// What shading needs to know of a surface.

struct Surface {
  vec3 n;        // unit normal
  vec3 v;        // unit, to the eye
  vec3 vt;       // v's part in the tangent plane: v - n (n·v)
  vec3 diffuse;  // albedo of the diffuse part
  vec3 f0;       // reflectance at normal incidence
  real nov;      // n·v, not clamped
  real alpha;    // roughness squared
  real power;    // of the Blinn-Phong lobe
};

FN Surface makeSurface(vec3 n, vec3 v, vec3 albedo, real substance, real alpha) {
  Surface m;
  m.n = n;
  m.v = v;
  m.nov = dot(n, v);
  m.vt = v - n * m.nov;
  m.diffuse = substanceDiffuse(substance, albedo);
  m.f0 = substanceF0(substance, albedo);
  m.alpha = alpha;
  m.power = powerFromAlpha(alpha);
  return m;
}
