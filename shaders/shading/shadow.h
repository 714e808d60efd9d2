// Shadows from depth maps: where a point falls in a map, how lookups are weighed, how wide a soft edge is. Depth is reversed: 1 nearest to the light.

// The face of a cube of maps that a direction from the light falls on: x, y = on the face, in (-1, 1); z = distance along the face's axis (m, as d); w = face, 2 · axis + 1 on the negative
// side. The face of axis a has axis a + 1 to the right and a + 2 upward (modulo 3). A zero direction falls on face 0, at distance 0.
FN vec4 cubeFace(vec3 d) {
  real ax = abs(d.x);
  real ay = abs(d.y);
  real az = abs(d.z);
  bool isX = ax >= ay && ax >= az;
  bool isY = !isX && ay >= az;
  vec3 r = isX ? d : (isY ? vec3(d.y, d.z, d.x) : vec3(d.z, d.x, d.y));
  real along = abs(r.x);
  real inverse = R(1.0) / max(along, BURNISH_GUARD_LENGTH);
  real face = (isX ? R(0.0) : (isY ? R(2.0) : R(4.0))) + (r.x < R(0.0) ? R(1.0) : R(0.0));
  return vec4(r.y * inverse, r.z * inverse, along, face);
}

// The same turn for a vector that belongs to a point on that face: right, up, along the face's axis.
FN vec3 onCubeFace(vec3 v, real face) {
  vec3 r = face < R(1.5) ? vec3(v.y, v.z, v.x) : (face < R(3.5) ? vec3(v.z, v.x, v.y) : v);
  real odd = face - R(2.0) * floor(face * R(0.5) + R(0.25));
  return vec3(r.x, r.y, odd > R(0.5) ? -r.z : r.z);
}

// Depth in a perspective map of what lies w metres along its axis, w > 0: a = near · far/(far - near), b = near/(far - near).
FN real shadowDepth(real w, real a, real b) { return a / w - b; }

// 3 x 3 comparisons of which each is filtered over 2 x 2 texels, all of 4 x 4 texels (percentage-closer filtering: Reeves, Salesin and Cook 1987, "Rendering Antialiased Shadows with Depth Maps").
// ll, lr, ul, ur: the four gathers (lower left, lower right, ...), each (0, 1), (1, 1), (1, 0), (0, 0). f: where between texel centres the middle lookup lies, [0, 1).
FN real shadowFiltered(vec4 ll, vec4 lr, vec4 ul, vec4 ur, vec2 f) {
  real gx = R(1.0) - f.x;
  real row0 = ll.w * gx + ll.z + lr.w + lr.z * f.x;
  real row1 = ll.x * gx + ll.y + lr.x + lr.y * f.x;
  real row2 = ul.w * gx + ul.z + ur.w + ur.z * f.x;
  real row3 = ul.x * gx + ul.y + ur.x + ur.y * f.x;
  return (row0 * (R(1.0) - f.y) + row1 + row2 + row3 * f.y) * (R(1.0) / R(9.0));
}

// Point i of n that are spread evenly over the unit disc (Vogel 1979, "A better way to construct the sunflower head").
FN vec2 vogelDisc(int i, int n) {
  real r = sqrt((real(i) + R(0.5)) / real(n));
  real t = real(i) * R(2.39996322972865332);
  return vec2(r * cos(t), r * sin(t));
}

// Radius, in texels, over which the edge of a blocker is blurred: the disc of a light of radius R, seen past the edge at distance b, covers R (w - b)/b of the receiver at w (Fernando 2005,
// "Percentage-Closer Soft Shadows", the penumbra estimate). In the map that is R (1/b - 1/w) at 1 m, which is linear in both depths, with a perspective (1/w = (depth + shadowDepth's b)/a:
// perDepth = R/a over a texel's side at 1 m) as without one (perDepth = the map's depth times the tangent of half the light's angle over a texel's side).
FN real shadowBlur(real blocker, real receiver, real perDepth) { return perDepth * notNegative(blocker - receiver); }
