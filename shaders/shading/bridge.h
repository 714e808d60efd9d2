// The bridge: what lets one text be GLSL 4.50, C++ in float and C++ in double.
// GLSL entry points include this first, then the terms that they use. C++ includes reference/shading.h, which wraps all terms in the namespaces
// burnish::shading::f32 and f64. Rules for the text: no swizzles, no textures, no globals, literals as R(0.5), out parameters as OUT(T),
// functions marked FN; vectors are built by name (vec3(x, y, z)) and read by member. Epsilons, clamps and saturates that only guard the arithmetic are
// declared in constants.h (tests/layering enforces it).
#ifndef BURNISH_BRIDGE
#define BURNISH_BRIDGE
#ifdef __cplusplus
#define FN inline
#define R(x) real(x)
#define OUT(T) T&
#define INOUT(T) T&
#else
#define FN
#define real float
#define R(x) (x)
#define OUT(T) out T
#define INOUT(T) inout T
#define NO_LIMIT 3.4028234e38
// For u > 0: 2^-e with u 2^-e in [sqrt(1/2), sqrt(2)), and e. The constants are the bits of 1 and of sqrt(1/2).
float scaleToOne(float u, out float e) {
  int k = (floatBitsToInt(u) - 0x3f3504f3) >> 23;
  e = float(k);
  return intBitsToFloat(0x3f800000 - (k << 23));
}
#endif
// What a guard makes of a value, and the value without it: the guard ledger (engine/stability) compiles the text once more for each guard with that one taken out.
#define GUARDED(number, with, without) (with)
#endif
