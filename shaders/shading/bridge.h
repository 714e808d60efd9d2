// The bridge: what lets one text be GLSL 4.50, C++ in float and C++ in double.
// GLSL entry points include this first, then the terms that they use. C++ includes reference/shading.h, which wraps all terms in the namespaces
// burnish::shading::f32 and f64. Rules for the text: no swizzles, no textures, no globals, literals as R(0.5), out parameters as OUT(T),
// functions marked FN; vectors are built by name (vec3(x, y, z)) and read by member.
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
#endif
#endif
