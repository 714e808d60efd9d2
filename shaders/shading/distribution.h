// Distributions of microfacet normals, normalized so that the integral of D (n·h) over the hemisphere is 1.

// Blinn-Phong: (p + 2)/(2 pi) (n·h)^p. Blinn 1977; normalization: Sloup and Krivanek; `lobe` is (n·h)^p from lobe.h.
FN real D_blinnPhong(real lobe, real p) { return (p + R(2.0)) * lobe / (R(2.0) * BURNISH_PI); }

// Void geometry takes f = F N(p) (n·h)^p; N is exact when the directional albedo at normal incidence is 1:
// (p + 2)(p + 4) / (8 pi (2^(-p/2) + p)). Giesen 2009, "Phong and Blinn-Phong normalization factors".
FN real normalizationExact(real p) { return (p + R(2.0)) * (p + R(4.0)) / (R(8.0) * BURNISH_PI * (exp2(R(-0.5) * p) + p)); }
