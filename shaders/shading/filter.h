// What a pixel's width does to a lobe: over it the normal turns, and a lobe that is narrower than the turn is hit or missed by one sample. The pixel's normals are taken as facets: their
// variance is added to the lobe's (Kaplanyan, Hill, Patney and Lefohn 2016, "Filtering Distributions of Normals for Shading Antialiasing", section 4; the isotropic form for deferred
// shading is that of Tokuyoshi and Kaplanyan 2021, "Stable Geometric Specular Antialiasing with Projected-Space NDF Filtering", listing 5).

// Variance of the pixel's filter along each axis, pixels²: the Gaussian whose peak is a pixel's box, 1/(2 pi).
#define PIXEL_VARIANCE R(0.15915494309189535)
// The most that is added to alpha²: past it derivatives are edges between surfaces, not curvature (their kappa).
#define FILTER_LIMIT R(0.18)

// alpha: [0, 1]. dndx, dndy: how the unit normal changes from a pixel to the next, any finite numbers. Slopes have variance alpha²/2 along each axis (Beckmann); the filter adds
// variance · (|dndx|² + |dndy|²)/2 on the mean of both. At least alpha; at most 1.
FN real filteredAlpha(real alpha, vec3 dndx, vec3 dndy) {
  real turned = PIXEL_VARIANCE * (dot(dndx, dndx) + dot(dndy, dndy));
  return sqrt(min(alpha * alpha + min(turned, FILTER_LIMIT), R(1.0)));  // model: the filter
}
