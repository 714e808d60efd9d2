// Fog between the eye and what is seen (shading/fog.h), lit by the surroundings' first two bands of harmonics and by the suns. The includer has included shading/bridge.h,
// shading/constants.h, shading/fog.h and interface/layout.h and declared `frame`. Definitions: DIRECTIONAL (count), FOG_AMBIENT (1: the surroundings light it), ORTHOGRAPHIC.

// Optical depth from the eye to p, camera-relative (m).
float fogDepthTo(vec3 p) {
#if ORTHOGRAPHIC
  float way = dot(p, frame.forward.xyz), from = p.y - frame.forward.y * way;
#else
  float way = heldLarge(length(p)), from = 0.0;
#endif
  return fogDepth(frame.fog.z + from, frame.fog.z + p.y, max(way, BURNISH_GUARD_LENGTH), frame.fog.w, frame.fog.x, frame.fog.y);
}

// What fog of any depth shows when one looks along d (unit): pre-exposed radiance. One source of light along the whole way, so that it is exact where fog is lit evenly.
vec3 fogSource(vec3 d) {
#if FOG_AMBIENT
  vec3 sum = max(frame.fogLight[0].rgb + frame.fogLight[1].rgb * d.y + frame.fogLight[2].rgb * d.z + frame.fogLight[3].rgb * d.x, vec3(0.0));  // model: two bands ring below 0
#else
  vec3 sum = vec3(0.0);
#endif
  for (int i = 0; i < DIRECTIONAL; ++i) sum += frame.directional[2 * i + 1].rgb * frame.fogLight[4].rgb * phaseHenyeyGreenstein(dot(frame.directional[2 * i].xyz, d), frame.fogLight[4].a);
  return sum;
}

// Radiance that leaves p, as the eye sees it.
vec3 fogged(vec3 radiance, vec3 p, vec3 toEye) {
  float depth = fogDepthTo(p);
  return radiance * fogThrough(depth) + fogSource(-toEye) * fogTaken(depth);
}
