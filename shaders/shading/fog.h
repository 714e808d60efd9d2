// Fog that thins with height: what it takes of light on its way to the eye, and what it scatters into that way.
// Its extinction is density · exp(-falloff · h) per metre and grey, h metres above the fog's reference height (Wenzel 2006, "Real-Time Atmospheric Effects in Games", SIGGRAPH
// course 26, section 6.3: the integral along a ray in closed form). Heights here are above that reference.

// How far the background is (m): ways to it end here, so that even fog hides it and level rays stay finite.
#define BURNISH_FOG_FAR R(1e6)

// (1 - e^-x)/x for x >= 0: the mean of e^-t over t from 0 to x. Five terms of its series where the difference would cancel; they err by less than x^5/720 = 1.4e-9.
FN real meanExponential(real x) {
  if (x < R(0.0625)) return R(1.0) - x * (R(0.5) - x * (R(1.0) / R(6.0) - x * (R(1.0) / R(24.0) - x / R(120.0))));
  return (R(1.0) - exp2(R(-1.4426950408889634) * x)) / x;
}

// Optical depth of a straight way of `way` m from height `from` to height `to`, of which the first `start` m are clear. All of it finite; density, falloff, way, start >= 0.
// It is taken from the lower end up, where the fog is densest, so that an eye far above or below it loses nothing.
FN real fogDepth(real from, real to, real way, real start, real density, real falloff) {
  real skipped = min(start, way);  // model: the fog begins there
  real share = skipped / max(way, BURNISH_GUARD_LENGTH);
  real begin = from * (R(1.0) - share) + to * share;
  real low = min(begin, to), rise = heldLarge(abs(to - begin));  // model: the lower end
  real densest = heldLarge(density * heldLarge(exp2(R(-1.4426950408889634) * heldLarge(falloff * low))));
  return heldLarge(densest * (way - skipped) * meanExponential(heldLarge(falloff * rise)));
}

// Share of light that an optical depth lets through, and its complement without cancellation.
FN real fogThrough(real depth) { return exp2(R(-1.4426950408889634) * depth); }
FN real fogTaken(real depth) { return depth * meanExponential(depth); }

// Henyey and Greenstein 1941, "Diffuse radiation in the galaxy", eq. 2, over the sphere 1. cosine: between the ways before and after; g: mean cosine, |g| <= 0.95.
// Its harmonics are g^l: band l of light from all around scatters as itself times g^l.
FN real phaseHenyeyGreenstein(real cosine, real g) {
  real a = abs(g), c = g < R(0.0) ? -cosine : cosine;
  real s = inversesqrt((R(1.0) - a) * (R(1.0) - a) + R(2.0) * a * (R(1.0) - c));  // 1 + g^2 - 2 g c
  return (R(1.0) - a) * (R(1.0) + a) * s * s * s / (R(4.0) * BURNISH_PI);
}
