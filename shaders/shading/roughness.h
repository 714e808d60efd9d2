// Perceptual roughness r, width alpha = r², Blinn-Phong power p = 2/alpha² - 2 (the Beckmann-equivalent power: Walter et al. 2007, section 5.2).

FN real alphaFromRoughness(real r) { return r * r; }

// alpha in (0, 1]; p from 0 up to 1.25e7 at alpha = 4e-4.
FN real powerFromAlpha(real alpha) { return R(2.0) / (alpha * alpha) - R(2.0); }

FN real alphaFromPower(real p) { return sqrt(R(2.0) / (p + R(2.0))); }

// The G-buffer's code of alpha in [BURNISH_ALPHA_MIN, 1]: linear in log alpha, so that 8 bits err by at most 1.6 % in alpha (3.2 % in the peak) everywhere.
// log2(1/4e-4) = 11.287712...
FN real encodeAlpha(real alpha) { return R(1.0) + log2(clamp(alpha, BURNISH_ALPHA_MIN, R(1.0))) / R(11.287712379549449); }
FN real decodeAlpha(real code) { return exp2((code - R(1.0)) * R(11.287712379549449)); }
