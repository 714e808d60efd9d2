// A point's clip coordinates in the frame before, as pixels of the view and as its distance. Definitions: ORTHOGRAPHIC.
#define OUT_OF_SIGHT 16384.0    // pixels
#define NEAREST_INVERSE 60000.0  // 1/m: what a half float holds
vec2 pixelThen(vec4 clip, vec2 size) {
  if (clip.w <= 0.0) return vec2(-OUT_OF_SIGHT);
  return clamp((clip.xy / clip.w * 0.5 + 0.5) * size, vec2(-OUT_OF_SIGHT), vec2(2.0 * OUT_OF_SIGHT));
}
float inverseDistanceThen(vec4 clip, vec2 depthParams) {
#if ORTHOGRAPHIC
  float w = depthParams.x - clip.z * depthParams.y;
#else
  float w = clip.w;
#endif
  return w > 0.0 ? min(1.0 / w, NEAREST_INVERSE) : NEAREST_INVERSE;
}
