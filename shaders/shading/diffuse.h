// Diffuse reflectance distributions, per albedo where they are proportional to it. nol, nov, the albedo rho in [0, 1]; lov = l·v; sigma: standard deviation of the facets' angle,
// radians, [0, 1].
// All are reciprocal; results are finite and not negative for any finite input.

FN real Fd_lambert() { return R(1.0) / BURNISH_PI; }

// cos φ · sin θl · sin θv: the azimuth's part of l·v.
FN real azimuthTerm(real nol, real nov, real lov) { return unitClamp(R(0.5) + R(0.5) * lov) * R(2.0) - R(1.0) - nol * nov; }

// Oren and Nayar 1994, "Generalization of Lambert's Reflectance Model", eq. 30 (qualitative): A + B max(0, cos φ) sin a tan b with a the larger angle, b the smaller;
// sin a tan b cos φ = s / max(nol, nov), s = azimuthTerm.
FN real Fd_orenNayarQualitative(real nol, real nov, real lov, real sigma) {
  real l = unitClamp(nol);
  real v = unitClamp(nov);
  real s2 = unitClamp(sigma) * unitClamp(sigma);
  real a = R(1.0) - R(0.5) * s2 / (s2 + R(0.33));
  real b = R(0.45) * s2 / (s2 + R(0.09));
  real s = max(azimuthTerm(l, v, lov), R(0.0));  // model: max(0, cos φ)
  return (a + b * s / max(max(l, v), BURNISH_GUARD_NOV)) / BURNISH_PI;  // model: the larger cosine
}

// The same paper, eq. 25 to 29: direct part and interreflection, for one channel of albedo rho. Returns f itself, albedo included.
FN real Fd_orenNayar(real nol, real nov, real lov, real sigma, real rho) {
  real l = unitClamp(nol);
  real v = unitClamp(nov);
  real s2 = unitClamp(sigma) * unitClamp(sigma);
  real sl = sqrt(unitClamp(R(1.0) - l * l));
  real sv = sqrt(unitClamp(R(1.0) - v * v));
  real cosPhi = clamp(azimuthTerm(l, v, lov) / max(sl * sv, BURNISH_GUARD_VISIBILITY), R(-1.0), R(1.0));  // model: a cosine
  real larger = acos(min(l, v));                                                                        // model: the paper's alpha and beta
  real smaller = acos(max(l, v));                                                                       // model
  real sinLarger = max(sl, sv);                                                                         // model
  real tanSmaller = min(sl, sv) / max(max(l, v), BURNISH_GUARD_NOV);                                    // model
  real tanHalf = (sl + sv) / max(l + v, BURNISH_GUARD_NOV);
  real c1 = R(1.0) - R(0.5) * s2 / (s2 + R(0.33));
  real ratio = R(2.0) * smaller / BURNISH_PI;
  real c2 = R(0.45) * s2 / (s2 + R(0.09)) * (cosPhi >= R(0.0) ? sinLarger : sinLarger - ratio * ratio * ratio);
  real product = R(4.0) * larger * smaller / (BURNISH_PI * BURNISH_PI);
  real c3 = R(0.125) * s2 / (s2 + R(0.09)) * product * product;
  real direct = c1 + cosPhi * c2 * tanSmaller + (R(1.0) - abs(cosPhi)) * c3 * tanHalf;
  real albedo = unitClamp(rho);
  real between = R(0.17) * albedo * s2 / (s2 + R(0.13)) * (R(1.0) - cosPhi * ratio * ratio);
  return notNegative(albedo * (direct + between) / BURNISH_PI);
}

// Fujii's form of the qualitative model keeps its ratio B/A: the roughness of the next two functions, in [0, 1].
FN real fujiiRoughness(real sigma) {
  real s2 = unitClamp(sigma) * unitClamp(sigma);
  return unitClamp(R(0.45) * s2 / (s2 + R(0.09)) / (R(1.0) - R(0.5) * s2 / (s2 + R(0.33))));
}

// Directional albedo of Fujii's model for albedo 1, over A = 1/(1 + (1/2 - 2/(3 pi)) rough). Portsmouth, Kutz and Hill 2025, "EON: A Practical Energy-Preserving Rough
// Diffuse BRDF", eq. for E_FON; (sin/cos)(1 - sin³) is written as sin cos (1 + sin + sin²)/(1 + sin), which needs no guard at the horizon.
FN real fujiiAlbedo(real cosine, real rough) {
  real c = unitClamp(cosine);
  real s = sqrt(unitClamp(R(1.0) - c * c));
  real g = s * (acos(c) - s * c) + R(2.0) / R(3.0) * (s * c * (R(1.0) + s + s * s) / (R(1.0) + s) - s);
  return R(1.0) + rough / BURNISH_PI * g;
}

// The model's A, and the mean of A E over the hemisphere for albedo 1.
FN real fujiiScale(real rough) { return R(1.0) / (R(1.0) + (R(0.5) - R(2.0) / (R(3.0) * BURNISH_PI)) * rough); }
FN real fujiiMean(real rough) { return fujiiScale(rough) * (R(1.0) + (R(2.0) / R(3.0) - R(28.0) / (R(15.0) * BURNISH_PI)) * rough); }
// What is given back of the light that is lost once, for albedo rho: rho² mean/(1 - rho (1 - mean)).
FN real fujiiAgain(real rho, real mean) { return rho * rho * mean / max(R(1.0) - rho * (R(1.0) - mean), BURNISH_GUARD_LOSS); }

// Energy-preserving Oren-Nayar (the same paper, eq. for f_EON): single scattering in Fujii's form and what it loses given back as a reciprocal product. One channel; returns f.
FN real Fd_orenNayarEnergy(real nol, real nov, real lov, real sigma, real rho) {
  real l = unitClamp(nol);
  real v = unitClamp(nov);
  real rough = fujiiRoughness(sigma);
  real s = azimuthTerm(l, v, lov);
  real t = s > R(0.0) ? s / max(max(l, v), BURNISH_GUARD_NOV) : s;  // model: the larger cosine
  real a = fujiiScale(rough);
  real albedo = unitClamp(rho);
  real single = albedo * a * (R(1.0) + rough * t);
  real mean = fujiiMean(rough);
  real lost = notNegative(R(1.0) - a * fujiiAlbedo(l, rough)) * notNegative(R(1.0) - a * fujiiAlbedo(v, rough)) / max(R(1.0) - mean, BURNISH_GUARD_LOSS);
  return notNegative(single + fujiiAgain(albedo, mean) * lost) / BURNISH_PI;
}

// Its directional albedo: what it reflects of even surroundings. rho where sigma is 0.
FN real orenNayarEnergyAlbedo(real nov, real sigma, real rho) {
  real rough = fujiiRoughness(sigma);
  real albedo = unitClamp(rho);
  real once = fujiiScale(rough) * fujiiAlbedo(nov, rough);
  return unitClamp(albedo * once + fujiiAgain(albedo, fujiiMean(rough)) * notNegative(R(1.0) - once));
}
