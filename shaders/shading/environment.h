// Light of the surroundings: spherical harmonics for the diffuse part, a prefiltered cube for the specular one.

// Roughness of level k of a prefiltered cube with `last` = index of the last level: r = 1.5 - sqrt(2.25 - 2 k/last), and its inverse.
FN real environmentLevel(real roughness, real last) { return last * roughness * (R(1.5) - R(0.5) * roughness); }
FN real environmentRoughness(real level, real last) { return R(1.5) - sqrt(R(2.25) - R(2.0) * level / last); }

// Where the DFG table of 64² texels holds (n·v, perceptual roughness): its first and last texels' centres stand for 0 and 1.
FN vec2 dfgCoordinate(real nov, real roughness) { return vec2(nov, roughness) * R(63.0 / 64.0) + vec2(R(0.5 / 64.0)); }

// The real SH basis up to band 2 in the order (0,0) (1,-1) (1,0) (1,1) (2,-2) (2,-1) (2,0) (2,1) (2,2), without its constants: they are folded into the
// coefficients together with the cosine lobe (Ramamoorthi and Hanrahan 2001, eq. 13).
FN vec3 irradianceSh(vec3 n, vec3 c0, vec3 c1, vec3 c2, vec3 c3, vec3 c4, vec3 c5, vec3 c6, vec3 c7, vec3 c8) {
  return c0 + c1 * n.y + c2 * n.z + c3 * n.x + c4 * (n.x * n.y) + c5 * (n.y * n.z) + c6 * (R(3.0) * n.z * n.z - R(1.0)) + c7 * (n.x * n.z) +
         c8 * (n.x * n.x - n.y * n.y);
}

// Specular occlusion from ambient occlusion: Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering", listing 26, on alpha (not r).
FN real specularOcclusion(real nov, real ao, real alpha) {
  return clamp(pow(max(nov + ao, R(1e-4)), exp2(R(-16.0) * alpha - R(1.0))) - R(1.0) + ao, R(0.0), R(1.0));
}
