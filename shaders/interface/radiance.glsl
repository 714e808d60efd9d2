// What may be written to the light buffer: at most `limit` in each channel. NaN is let through on purpose, and asked for by name: min(), and a choice that compilers make one of, turn it into
// the limit on some drivers, a white pixel that FrameStats::nonfinitePixels could not see.
float limitRadiance(float c, float limit) { return isnan(c) ? c : min(c, limit); }
vec3 limitRadiance(vec3 c, float limit) { return vec3(limitRadiance(c.r, limit), limitRadiance(c.g, limit), limitRadiance(c.b, limit)); }

// Of a picture that is read back: what is not a number is black, what is infinite the most that a pass writes.
float firmRadiance(float c, float limit) { return isnan(c) ? 0.0 : min(c, limit); }
vec3 firmRadiance(vec3 c, float limit) { return vec3(firmRadiance(c.r, limit), firmRadiance(c.g, limit), firmRadiance(c.b, limit)); }
