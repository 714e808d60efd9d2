// The G-buffer's target for brushed and rough surfaces, four bytes: the tangent as an angle in the frame that the stored normal makes (two bytes, a line has no sign: modulo pi), the code
// of alpha along it, sigma of rough diffuse. All zeros: neither. Inputs may be any finite numbers.

// Angle over pi, in [0, 1), of a direction in the frame of basisFrom(n); -1 where it has none in the plane.
FN real tangentTurn(vec3 n, vec3 tangent) {
  vec3 t;
  vec3 b;
  basisFrom(n, t, b);
  vec3 held = vec3(heldLarge(tangent.x), heldLarge(tangent.y), heldLarge(tangent.z));
  real x = dot(held, t);
  real y = dot(held, b);
  if (x * x + y * y <= BURNISH_GUARD_LENGTH) return R(-1.0);
  real turn = atan(y, x) / BURNISH_PI;
  return turn - floor(turn);
}

FN vec3 tangentOfTurn(vec3 n, real turn) {
  vec3 t;
  vec3 b;
  basisFrom(n, t, b);
  return t * cos(BURNISH_PI * turn) + b * sin(BURNISH_PI * turn);
}

// n: the normal as it is read back, unpackNormal(packNormal(n)). alphaX: along the tangent; without a tangent the surface is isotropic. sigma: radians, [0, 1]. Channel values k/255 but for the last two, which rounding
// to a byte makes so. Half a step of the angle is 2.4e-5 radians, of alpha 1.6 %, of sigma 0.002.
FN vec4 packDetail(vec3 n, vec3 tangent, real alphaX, real sigma) {
  real turn = tangentTurn(n, tangent);
  if (turn < R(0.0)) return vec4(R(0.0), R(0.0), R(0.0), unitClamp(sigma));
  real code = floor(turn * R(65536.0) + R(0.5));
  code = code >= R(65536.0) ? R(0.0) : code;
  real high = floor(code / R(256.0));
  return vec4(high / R(255.0), (code - high * R(256.0)) / R(255.0), encodeAlpha(storedAlpha(alphaX)), unitClamp(sigma));
}

FN vec3 unpackTangent(vec3 n, vec4 d) { return tangentOfTurn(n, (d.x * R(255.0) * R(256.0) + d.y * R(255.0)) / R(65536.0)); }
