// The substance code s (docs/shading.md, section 1): one channel that runs from gems (F0 0.25) down to water (0.0196) and on to metal.

#define BURNISH_F0_WATER R(0.0196)

// Metalness of a code: 0 up to s = 0.4, 1 at s = 1.
FN real substanceMetalness(real s) { return clamp((s - R(0.4)) * (R(1.0) / R(0.6)), R(0.0), R(1.0)); }  // model: the code has two branches

FN real substanceDielectricF0(real s) {
  real root = R(0.5) - R(0.9) * min(s, R(0.4));  // model: the code has two branches
  return root * root;
}

FN vec3 substanceF0(real s, vec3 albedo) {
  real m = substanceMetalness(s);
  real f = substanceDielectricF0(s) * (R(1.0) - m);
  return vec3(f + albedo.x * m, f + albedo.y * m, f + albedo.z * m);
}

FN vec3 substanceDiffuse(real s, vec3 albedo) { return albedo * (R(1.0) - substanceMetalness(s)); }
