// Ambient occlusion from depth: cosine-weighted visibility of the hemisphere by horizons in slices (Jimenez, Wu, Pesce and Jarabo 2016, "Practical Real-Time Strategies for Accurate
// Indirect Occlusion", section 4). Directions are in any one orthonormal frame. A slice is a half turn around the direction to the eye: the plane through it and one direction of the
// screen; angles in it count from the direction to the eye, to either side.
//
// Three things are this project's own:
// - An occluder takes what lies between the horizon so far and itself, times its weight (as Bavoil and Sainz 2008, "Image-space Horizon-based Ambient Occlusion", do by solid angle), so that
//   distance fades occluders without moving horizons.
// - Texels lie beside the slice's line. They are moved into the slice along the surface's plane: a lone plane then has its horizon exactly there, and nothing darkens it at any angle.
// - A pixel's result is seen over seeable, sums over slices that are divided at the end (weights that are not constant would leave noise on a lone plane).

struct OcclusionSlice {
  vec3 v;         // unit, to the eye
  vec3 t;         // unit, the slice's other direction
  vec3 across;    // unit, perpendicular to the slice
  real weight;    // length of the normal's projection into the slice
  real cosNormal; // of the projection's angle from v, toward t
  real sinNormal;
  real angle;     // that angle, [-pi/2, pi/2]
  real shiftT;    // what a step across adds in the surface's plane along t
  real shiftV;    // and along v
};

struct OcclusionSide {
  real cosHorizon;  // of the angle from v
  real arc;     // occlusionArc there
  real lowest;  // and on the surface's own plane
  real lost;    // what occluders take
};

// n, v: unit, n·v >= 0. direction: of the screen, any length, not along v.
FN OcclusionSlice occlusionSlice(vec3 n, vec3 v, vec3 direction) {
  OcclusionSlice s;
  s.v = v;
  vec3 t = direction - v * dot(direction, v);
  s.t = t * inversesqrt(max(dot(t, t), BURNISH_GUARD_LENGTH));
  s.across = cross(v, s.t);
  real nt = dot(n, s.t);
  real nv = notNegative(dot(n, v));
  real na = dot(n, s.across);
  real length2 = max(nt * nt + nv * nv, BURNISH_GUARD_VISIBILITY);
  real inverse = inversesqrt(length2);
  s.weight = length2 * inverse;
  s.cosNormal = unitClamp(nv * inverse);
  s.sinNormal = nt * inverse;
  s.angle = acos(s.cosNormal) * signNotZero(nt);
  s.shiftT = nt * na * inverse * inverse;
  s.shiftV = nv * na * inverse * inverse;
  return s;
}

// The integral of sin x cos(x - normal's angle) up to an angle with this cosine, sine and size: a slice's cosine-weighted visibility (eq. 7).
FN real occlusionArc(real cosine, real sine, real angle, real cosNormal, real sinNormal) {
  return R(0.25) * (R(2.0) * angle * sinNormal - (R(2.0) * cosine * cosine - R(1.0)) * cosNormal - R(2.0) * sine * cosine * sinNormal);
}

// All that a slice can see, both sides.
FN real occlusionSeeable(OcclusionSlice s) { return s.cosNormal + s.angle * s.sinNormal; }

// side: 1 toward t, -1 away from it.
FN OcclusionSide occlusionSide(OcclusionSlice s, real side) {
  OcclusionSide o;
  real sinNormal = s.sinNormal * side;
  o.cosHorizon = -sinNormal;
  o.lowest = R(0.25) * ((R(2.0) * s.angle * side + BURNISH_PI) * sinNormal + s.cosNormal);
  o.arc = o.lowest;
  o.lost = R(0.0);
  return o;
}

// An occluder at `d` (from the surface's point, metres, under 1e9), the next one outward. Full weight up to half the radius, none at the radius. What stays under the horizon says that what made
// the horizon is thin (section 5 of the paper): the horizon falls by the share `thin` of the way to it, and gives back what it took too much.
FN void addOccluder(INOUT(OcclusionSide) o, OcclusionSlice s, vec3 d, real side, real inverseRadius2, real thin) {
  real y = dot(d, s.across);
  real x = (dot(d, s.t) + y * s.shiftT) * side;
  real z = dot(d, s.v) + y * s.shiftV;
  real inverse = inversesqrt(max(x * x + z * z, BURNISH_GUARD_LENGTH));
  real weight = x > R(0.0) ? unitClamp((R(1.0) - dot(d, d) * inverseRadius2) * (R(4.0) / R(3.0))) : R(0.0);
  real cosine = clamp(z * inverse, R(-1.0), R(1.0));  // model: a cosine
  real arc = occlusionArc(cosine, unitClamp(x * inverse), acos(cosine), s.cosNormal, s.sinNormal * side);
  bool above = cosine > -s.sinNormal * side;
  cosine = above ? cosine : -s.sinNormal * side;
  arc = above ? arc : o.lowest;
  bool rises = cosine > o.cosHorizon;
  real follow = rises ? (weight > R(0.0) ? R(1.0) : R(0.0)) : thin;
  o.lost = rises ? o.lost + weight * notNegative(o.arc - arc) : o.lost - thin * notNegative(o.lost - notNegative(o.lowest - arc));
  o.cosHorizon += follow * (cosine - o.cosHorizon);
  o.arc += follow * (arc - o.arc);
}
