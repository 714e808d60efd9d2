// Fresnel reflectance. loh = l·h in [0, 1].

// (1 - c)^5. Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 15.
FN real schlickWeight(real c) {
  real x = clamp(R(1.0) - c, R(0.0), R(1.0));
  real x2 = x * x;
  return x2 * x2 * x;
}

FN vec3 F_schlick(vec3 f0, real loh) {
  real w = schlickWeight(loh);
  return vec3(f0.x + (R(1.0) - f0.x) * w, f0.y + (R(1.0) - f0.y) * w, f0.z + (R(1.0) - f0.z) * w);
}
