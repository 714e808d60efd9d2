// The G-buffer's target of normals and roughness: what its format holds. Everything that writes or reads normals there goes through here.
// Definition: NORMAL_STORAGE (Quality's NormalStorage: 0 two bytes of RGBA8, 1 2 x 12 bits in three bytes of RGBA8, 2 two of RGBA16's four channels). Roughness is in alpha, a byte or 16 bits.
// The includer has included shading/normals.h.

// All ones are no normal that is written: they mark the host's pixels (gbuffer/geometry_pass.cpp).
bool isHostPixel(vec4 b) { return b.rgb == vec3(1.0); }

#if NORMAL_STORAGE == 0
#define NORMAL_VARIANCE BURNISH_NORMAL_VARIANCE_8
vec3 storeNormal(vec3 n) { return vec3(packNormal8(n), 0.0); }
vec3 storedNormal(vec4 b) { return unpackNormal8(b.rg); }
#elif NORMAL_STORAGE == 1
#define NORMAL_VARIANCE BURNISH_NORMAL_VARIANCE
vec3 storeNormal(vec3 n) { return packNormal(n); }
vec3 storedNormal(vec4 b) { return unpackNormal(b.rgb); }
#else
#define NORMAL_VARIANCE BURNISH_NORMAL_VARIANCE_16
vec3 storeNormal(vec3 n) { return vec3(packNormal16(n), 0.0); }
vec3 storedNormal(vec4 b) { return unpackNormal16(b.rg); }
#endif
