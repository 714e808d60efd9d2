// The level of a prefiltered cube whose lobe has this roughness (shading/environment.h). Units of textures blend two levels in 256 steps, and some cut off: a level that rounding
// left a millionth under a whole one would get 1/256 of the one above, which beside a sun is a quarter of the peak (docs/hard_cases.md, H27).
float cubeLevel(float roughness, float last) {
  float level = environmentLevel(roughness, last), whole = floor(level + 0.5);
  return abs(level - whole) < 1.0 / 1024.0 ? whole : level;
}
