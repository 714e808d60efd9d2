// From exposed radiance to what a display takes. Definition: TONEMAP (0 none, 1 Neutral, 2 AgX, 3 ACES). The includer has included shading/tonemap.h.
vec3 developed(vec3 c) {
#if TONEMAP == 1
  c = tonemapNeutral(c);
#elif TONEMAP == 2
  c = tonemapAgx(c);
#elif TONEMAP == 3
  c = tonemapAces(c);
#else
  c = tonemapNone(c);
#endif
  return vec3(srgbFromLinearFast(c.r), srgbFromLinearFast(c.g), srgbFromLinearFast(c.b));
}
