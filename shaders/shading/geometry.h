// Visibility V = G / (4 (n·l) (n·v)).

// Kelemen and Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model", eq. 3: G/(nl nv) ~ 1/(l·h)².
// As |l + v|² = 4 (l·h)², V is just inverse = 1/|l + v|²: no half vector is needed.
FN real V_kelemen(real inverse) { return inverse; }
