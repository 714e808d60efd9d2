// From exposed linear Rec.709 radiance to display-referred linear Rec.709 in [0,1], and the sRGB transfer function.

FN vec3 tonemapNone(vec3 c) { return clamp(c, vec3(R(0.0)), vec3(R(1.0))); }  // model: the curve

// Khronos PBR Neutral tone mapper, specification 1.0 (2024).
FN vec3 tonemapNeutral(vec3 c) {
  real startCompression = R(0.8) - R(0.04);
  real desaturation = R(0.15);
  real x = min(c.x, min(c.y, c.z));  // model: the curve
  real offset = x < R(0.08) ? x - R(6.25) * x * x : R(0.04);
  c = c - vec3(offset);
  real peak = max(c.x, max(c.y, c.z));  // model: the curve
  if (peak < startCompression) return max(c, vec3(R(0.0)));  // model: the curve
  real d = R(1.0) - startCompression;
  real newPeak = R(1.0) - d * d / (peak + d - startCompression);
  c = c * (newPeak / peak);
  real g = R(1.0) - R(1.0) / (desaturation * (peak - newPeak) + R(1.0));
  return clamp(c + (vec3(newPeak) - c) * g, vec3(R(0.0)), vec3(R(1.0)));  // model: the curve
}

// Stephen Hill's fit of the ACES reference and output transforms (RRT + ODT, Rec.709, 2016); matrices are sRGB → AP1 with saturation, and back.
FN real acesCurve(real x) { return (x * (x + R(0.0245786)) - R(0.000090537)) / (x * (R(0.983729) * x + R(0.4329510)) + R(0.238081)); }
FN vec3 tonemapAces(vec3 c) {
  c = min(c, vec3(BURNISH_GUARD_RADIANCE));
  vec3 a = vec3(acesCurve(R(0.59719) * c.x + R(0.35458) * c.y + R(0.04823) * c.z), acesCurve(R(0.07600) * c.x + R(0.90834) * c.y + R(0.01566) * c.z),
                acesCurve(R(0.02840) * c.x + R(0.13383) * c.y + R(0.83777) * c.z));
  vec3 o = vec3(R(1.60475) * a.x - R(0.53108) * a.y - R(0.07367) * a.z, R(-0.10208) * a.x + R(1.10813) * a.y - R(0.00605) * a.z,
                R(-0.00327) * a.x - R(0.07276) * a.y + R(1.07602) * a.z);
  return clamp(o, vec3(R(0.0)), vec3(R(1.0)));  // model: the curve
}

// AgX (Troy Sobotka, 2022), base look: inset matrix, log2 encoding over 16.5 stops, sigmoid as Benjamin Wrensch's sixth-order fit (2023), outset matrix, 2.2 power.
FN real agxCurve(real x) {
  real x2 = x * x;
  real x4 = x2 * x2;
  return R(15.5) * x4 * x2 - R(40.14) * x4 * x + R(31.96) * x4 - R(6.868) * x2 * x + R(0.4298) * x2 + R(0.1191) * x - R(0.00232);
}
FN real agxEncode(real x) { return agxCurve(clamp((log2(max(x, BURNISH_GUARD_AGX)) + R(12.47393)) / R(16.5), R(0.0), R(1.0))); }
FN vec3 tonemapAgx(vec3 c) {
  c = min(c, vec3(BURNISH_GUARD_RADIANCE));
  vec3 a = vec3(agxEncode(R(0.842479062253094) * c.x + R(0.0784335999999992) * c.y + R(0.0792237451477643) * c.z),
                agxEncode(R(0.0423282422610123) * c.x + R(0.878468636469772) * c.y + R(0.0791661274605434) * c.z),
                agxEncode(R(0.0423756549057051) * c.x + R(0.0784336) * c.y + R(0.879142973793104) * c.z));
  vec3 o = vec3(R(1.19687900512017) * a.x - R(0.0980208811401368) * a.y - R(0.0990297440797205) * a.z,
                R(-0.0528968517574562) * a.x + R(1.15190312990417) * a.y - R(0.0989611768448433) * a.z,
                R(-0.0529716355144438) * a.x - R(0.0980434501171241) * a.y + R(1.15107367264116) * a.z);
  o = clamp(o, vec3(R(0.0)), vec3(R(1.0)));  // model: the curve
  return vec3(pow(o.x, R(2.2)), pow(o.y, R(2.2)), pow(o.z, R(2.2)));
}

// IEC 61966-2-1.
FN real srgbFromLinear(real x) { return x <= R(0.0031308) ? R(12.92) * x : R(1.055) * pow(x, R(1.0) / R(2.4)) - R(0.055); }
// The same for x in [0,1] within 0.1/255, without a power function: a polynomial of degree 5 in sqrt(x), fitted to the curve above the linear toe.
FN real srgbFromLinearFast(real x) {
  real s = sqrt(x);
  real curve = R(-0.04010945) + s * (R(1.51794743) + s * (R(-1.40271549) + s * (R(2.03152262) + s * (R(-1.62360270) + s * R(0.51728135)))));
  return x <= R(0.0031308) ? R(12.92) * x : curve;
}
FN real linearFromSrgb(real x) { return x <= R(0.04045) ? x / R(12.92) : pow((x + R(0.055)) / R(1.055), R(2.4)); }
