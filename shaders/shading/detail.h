// The G-buffer's target for brushed and rough surfaces, four bytes: the tangent as a direction in the frame that the stored normal makes (two bytes; a line has no sign), the code of alpha
// along it, sigma of rough diffuse. All zeros: neither. Inputs may be any finite numbers.

// A line's direction (x, y) on the diamond |x| + |y| = 1, y >= 0: x there, taken to [0, 1]. No trigonometry, and steps of angle that differ by a factor of two at most. -1: no direction.
FN real lineCode(real x, real y) {
  real sum = abs(x) + abs(y);
  if (sum <= BURNISH_GUARD_LENGTH) return R(-1.0);
  real along = y < R(0.0) ? -x : x;
  return R(0.5) + R(0.5) * along / sum;
}

// n: the normal as it is read back, unpackNormal(packNormal(n)). alphaX, or its code: along the tangent; without a tangent the surface is isotropic. Channel values k/255 but for the last two, which
// rounding to a byte makes so. Half a step of the direction is 3.1e-5 radians at most, of alpha 1.6 %, of sigma 0.002.
FN vec4 packDetailCode(vec3 n, vec3 tangent, real alphaCode, real sigma) {
  vec3 t;
  vec3 b;
  basisFrom(n, t, b);
  vec3 held = vec3(heldLarge(tangent.x), heldLarge(tangent.y), heldLarge(tangent.z));
  real line = lineCode(dot(held, t), dot(held, b));
  if (line < R(0.0)) return vec4(R(0.0), R(0.0), R(0.0), unitClamp(sigma));
  real code = floor(line * R(65535.0) + R(0.5));
  real high = floor(code / R(256.0));
  return vec4(high / R(255.0), (code - high * R(256.0)) / R(255.0), alphaCode, unitClamp(sigma));
}
FN vec4 packDetail(vec3 n, vec3 tangent, real alphaX, real sigma) { return packDetailCode(n, tangent, encodeAlpha(storedAlpha(alphaX)), sigma); }

// Unit.
FN vec3 unpackTangent(vec3 n, vec4 d) {
  vec3 t;
  vec3 b;
  basisFrom(n, t, b);
  real x = (d.x * R(65280.0) + d.y * R(255.0)) * (R(2.0) / R(65535.0)) - R(1.0);
  return normalize(t * x + b * (R(1.0) - abs(x)));
}
