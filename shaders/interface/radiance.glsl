// What may be written to the light buffer: at most `limit` in each channel (half floats end at 65504). NaN is let through on purpose: min() would turn it into
// the limit on some drivers, a white pixel that FrameStats::nonfinitePixels could not see.
vec3 limitRadiance(vec3 c, float limit) { return mix(c, vec3(limit), greaterThan(c, vec3(limit))); }
