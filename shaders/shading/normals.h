// Octahedral unit vectors (Meyer et al. 2010; Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors", section 3.3).

FN real signNotZero(real x) { return x >= R(0.0) ? R(1.0) : R(-1.0); }

// An orthonormal frame around a unit vector. Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3.
FN void basisFrom(vec3 n, OUT(vec3) t, OUT(vec3) b) {
  real s = signNotZero(n.z);
  real a = R(-1.0) / (s + n.z);
  real c = n.x * n.y * a;
  t = vec3(R(1.0) + s * n.x * n.x * a, s * c, -s * n.x);
  b = vec3(c, s + n.y * n.y * a, -n.y);
}

// Vector of any length to the square [-1,1]². A zero vector gives (0, 0), which decodes to +z.
FN vec2 octahedralEncode(vec3 n) {
  real s = abs(n.x) + abs(n.y) + abs(n.z);
  real k = R(1.0) / max(s, BURNISH_GUARD_LENGTH);
  real x = n.x * k;
  real y = n.y * k;
  if (n.z < R(0.0)) return vec2((R(1.0) - abs(y)) * signNotZero(x), (R(1.0) - abs(x)) * signNotZero(y));
  return vec2(x, y);
}

// e in [-1, 1]², which any three bytes unpack to.
FN vec3 octahedralDecode(vec2 e) {
  real z = R(1.0) - abs(e.x) - abs(e.y);
  real t = notNegative(-z);
  real x = e.x + (e.x >= R(0.0) ? -t : t);
  real y = e.y + (e.y >= R(0.0) ? -t : t);
  return normalize(vec3(x, y, z));
}

// 2 × 12 bits in three 8-bit channels. Codes run 0..4094 so that -1, 0 and 1 are exact. Returns channel values k/255.
FN vec3 packNormal(vec3 n) {
  vec2 e = octahedralEncode(n);
  real u = floor((e.x + R(1.0)) * R(2047.0) + R(0.5));
  real v = floor((e.y + R(1.0)) * R(2047.0) + R(0.5));
  real uh = floor(u / R(256.0));
  real vh = floor(v / R(256.0));
  return vec3(u - uh * R(256.0), v - vh * R(256.0), uh * R(16.0) + vh) / R(255.0);
}

// The low bytes need no rounding (k/255 · 255 is k to 1e-5); the nibbles do.
FN vec3 unpackNormal(vec3 rgb) {
  real high = rgb.z * R(255.0);
  real uh = floor((high + R(0.5)) * R(0.0625));
  real vh = high - uh * R(16.0);
  return octahedralDecode(vec2((rgb.x * R(255.0) + uh * R(256.0)) * (R(1.0) / R(2047.0)) - R(1.0), (rgb.y * R(255.0) + vh * R(256.0)) * (R(1.0) / R(2047.0)) - R(1.0)));
}

// With other numbers of bits, a channel each: codes run 0..2 middle, so that -1, 0 and 1 are exact. Returns channel values k/last.
FN vec2 packOctahedral(vec3 n, real middle, real last) {
  vec2 e = octahedralEncode(n);
  return vec2(floor((e.x + R(1.0)) * middle + R(0.5)) / last, floor((e.y + R(1.0)) * middle + R(0.5)) / last);
}

FN vec3 unpackOctahedral(vec2 c, real middle, real last) {
  return octahedralDecode(vec2(floor(unitClamp(c.x) * last + R(0.5)) / middle - R(1.0), floor(unitClamp(c.y) * last + R(0.5)) / middle - R(1.0)));
}

// Their mean square errors (rad²) are that of 12 bits by the square of a code's step, and so the alpha to store beside a normal that is rounded so (roughness.h, storedAlpha).
#define BURNISH_NORMAL_VARIANCE_8 (BURNISH_NORMAL_VARIANCE * R(2047.0 / 127.0) * R(2047.0 / 127.0))
#define BURNISH_NORMAL_VARIANCE_16 (BURNISH_NORMAL_VARIANCE * R(2047.0 / 32767.0) * R(2047.0 / 32767.0))
FN real storedAlphaBeside(real alpha, real variance) { return sqrt(max(alpha * alpha - variance, BURNISH_ALPHA_MIN * BURNISH_ALPHA_MIN)); }

// 2 × 8 bits in two 8-bit channels, codes 0..254.
FN vec2 packNormal8(vec3 n) { return packOctahedral(n, R(127.0), R(255.0)); }
FN vec3 unpackNormal8(vec2 c) { return unpackOctahedral(c, R(127.0), R(255.0)); }

// 2 × 16 bits in two 16-bit channels, codes 0..65534.
FN vec2 packNormal16(vec3 n) { return packOctahedral(n, R(32767.0), R(65535.0)); }
FN vec3 unpackNormal16(vec2 c) { return unpackOctahedral(c, R(32767.0), R(65535.0)); }
