// Punctual lights (KHR_lights_punctual): lux for directional, candela for point and spot lights.

// Irradiance per candela at squared distance d2 (m², held above BURNISH_GUARD_DISTANCE2 by the caller); inverse = 1/d2.
// A light with a range has invRange4 = 1/range^4 and bias 0: windowed inverse square, Karis 2013, "Real Shading in Unreal Engine 4", eq. 9.
// A light without one is cut at the distance R where it gives the threshold irradiance: invRange4 = 0, bias = 1/R²; it loses exactly bias everywhere and ends without a step.
FN real distanceAttenuation(real d2, real inverse, real invRange4, real bias) {
  real w = clamp(R(1.0) - d2 * invRange4 * d2, R(0.0), R(1.0));  // model: the window
  return max(w * w * inverse - bias, R(0.0));  // model: it ends at 0
}

// cosine = axis · (light to point); scale = 1/(cos inner - cos outer), offset = -cos outer · scale (KHR_lights_punctual, "Inner and outer cone angles").
FN real spotAttenuation(real cosine, real scale, real offset) {
  real t = clamp(cosine * scale + offset, R(0.0), R(1.0));  // model: the window
  return t * t;
}
