// What the cases of engine/stability/shader_cases.h and the tests ask of the shading text in one call each; GLSL and C++ alike (shading/bridge.h).
// n: normal and alpha; l, v: directions; albedo: with the substance; dfg: the lobe's (scale, bias) at n·v and at n·l; mean: over the hemisphere.

FN Surface surfaceCase(vec4 n, vec4 v, vec4 albedo) { return makeSurface(vec3(n), vec3(v), vec3(albedo), albedo.w, n.w); }

FN Surface tableCase(vec4 n, vec4 v, vec4 albedo, vec4 dfg, vec4 mean) {
  Surface m = surfaceCase(n, v, albedo);
  m.dfg = vec2(dfg);
  m.dfgMean = vec2(mean);
  return m;
}

FN vec4 shadeCase(vec4 n, vec4 l, vec4 v, vec4 albedo, vec4 dfg, vec2 mean, Rungs k) {
  return vec4(shadeDirection(tableCase(n, v, albedo, dfg, vec4(mean, R(0.0), R(0.0))), vec3(l), vec2(dfg.z, dfg.w), k), R(0.0));
}

// tangent: with the strength of anisotropy; index: two of a conductor's indices, then two of its extinctions.
FN Surface metalCase(vec4 n, vec4 v, vec4 albedo, vec4 tangent, vec4 index) {
  Surface m = surfaceCase(n, v, albedo);
  setTangent(m, vec3(tangent), tangent.w);
  m.eta = vec3(index.x, index.y, index.x);
  m.k = vec3(index.z, index.z, index.w);
  return m;
}

// With the albedo's red for a diffuse roughness of its own.
FN Surface roughCase(vec4 n, vec4 v, vec4 albedo, vec4 dfg, vec4 mean) {
  Surface m = tableCase(n, v, albedo, dfg, mean);
  m.sigma = albedo.x;
  return m;
}

// The direction that the target of details gives back, and the sine of its angle to what went in; what went in: a direction in the plane of the stored normal.
FN vec4 detailCase(vec3 normal, vec3 direction, real alphaX, real sigma) {
  vec3 n = unpackNormal(packNormal(normal));
  vec3 held = vec3(heldLarge(direction.x), heldLarge(direction.y), heldLarge(direction.z));
  vec4 d = packDetail(n, direction, alphaX, sigma);
  vec3 t = unpackTangent(n, d);
  vec3 plane = held - n * dot(n, held);
  vec3 off = cross(t, plane) * inversesqrt(max(dot(plane, plane), BURNISH_GUARD_LENGTH));
  return vec4(sqrt(dot(off, off)), decodeAlpha(d.z), d.w, dot(t, n));
}

// The refracted direction and the transmittance.
FN vec4 refractCase(vec3 toEye, vec3 n, real eta) {
  vec3 direction;
  real transmittance = refractSnell(toEye, n, eta, direction);
  return vec4(direction, transmittance);
}

// The tangent or the bitangent of basisFrom.
FN vec4 basisCase(vec3 n, bool second) {
  vec3 t;
  vec3 b;
  basisFrom(n, t, b);
  return vec4(second ? b : t, R(0.0));
}

// One slice of ambient occlusion with two occluders on one side: what can be seen, what they take, the projection's length and the horizon, by the slice's weight.
FN vec4 occlusionCase(vec3 n, vec3 v, vec3 direction, vec3 d) {
  OcclusionSlice s = occlusionSlice(makeSurface(n, v, vec3(R(0.0)), R(0.0), R(1.0)).n, v, direction);
  OcclusionSide o = occlusionSide(s, R(1.0));
  addOccluder(o, s, d, R(1.0), R(0.25), R(0.1));
  addOccluder(o, s, d * R(1.5) + v * R(0.3), R(1.0), R(0.25), R(0.1));
  return vec4(s.weight * occlusionSeeable(s), s.weight * o.lost, s.weight, s.weight * o.cosHorizon);
}

// A place in a lattice of 4 x 3 x 1 points: the lattice's weight there, one point's trilinear share, how much of it lies before the surface, and how much before a plane and its neighbours.
FN vec4 gridCase(vec3 q, real height, vec4 plane, vec3 away, vec2 f) {
  GridCell c = gridCell(q, vec3(R(3.0), R(2.0), R(0.0)), vec3(R(2.0), R(4.0), R(1.0)));
  real before = gridBefore(plane, away);
  return vec4(c.weight, gridShare(c, vec3(R(1.0), R(0.0), R(0.0))), gridInFront(height, R(20.0)), gridSees(before, R(1.0), R(1.0), before, f) * gridTrust(before));
}

// One lookup of the box-projected variation of ambient light.
FN vec3 ambientBoxCase(vec3 n, int tap, vec3 c0, vec3 c1, vec3 c2, vec3 c3) {
  vec3 d = ambientTap(tap);
  return irradianceBands(d, c0, c1, c2, c3, c1, c2, c3, c0, c1) * ambientTapWeight(dot(n, d));
}

// Shares of two boxes around p and the sky's, and 1 where p lies in a box. Boxes: half sizes along the axes; w: fade along each of them, and margin.
FN vec4 blendCase(vec3 p, vec4 first, vec3 firstCenter, vec4 second, vec3 secondCenter) {
  ProbeBlend b = beginBlend();
  addToBlend(b, 0, p - firstCenter, vec3(first), vec3(first.w), first.w);
  addToBlend(b, 1, p - secondCenter, vec3(second), vec3(second.w), second.w);
  endBlend(b);
  return vec4(b.weight.x, b.weight.y, b.sky, b.inside ? R(1.0) : R(0.0));
}

// The roughness with which a place is looked up along d, and the direction; capture: the place's, in the box's axes.
FN vec4 lookupCase(vec3 p, vec3 d, vec3 extent, vec3 capture, real roughness) {
  vec3 hit = probeHit(p, d, extent);
  return vec4(probeDirection(hit, d, capture), probeRoughness(roughness, p, hit, capture));
}
