// Light of captured places (docs/probes.md): where a ray meets a place's box, and what share of the light around a point each place and the sky have.
// Points and directions are in a box's own axes, relative to its middle; `extent` holds its half sizes.

// A face counts as at least this share of the half size away, so that a ray in the face's own plane changes its course continuously.
#define PROBE_FACE_GAP (R(1.0) / R(1048576.0))
// The least influence inside a box and the least distance outside (as a share of the margin) that shares are reckoned with: a box has its share on its very faces.
#define PROBE_LEAST_SHARE (R(1.0) / R(1048576.0))
// So many places have a share at a point: ProbeBlend::weight has one component each.
#define PROBES_BLENDED 4

FN real probeFaceDistance(real p, real d, real extent) {
  return max(d < R(0.0) ? extent + p : extent - p, extent * PROBE_FACE_GAP) / max(abs(d), BURNISH_GUARD_LENGTH);  // model: the gap
}

// The nearest point of the box.
FN vec3 probeHeld(vec3 p, vec3 extent) { return clamp(p, -extent, extent); }  // model: outside, that point stands for p

// Where the ray from p along d (unit) leaves the box (Lagarde and Zanuttini 2012, "Local Image-Based Lighting With Parallax-Corrected Cubemaps"). From outside it starts in the nearest
// point of the box, so that it moves continuously through the faces.
FN vec3 probeHit(vec3 p, vec3 d, vec3 extent) {
  vec3 from = probeHeld(p, extent);
  real way = min(probeFaceDistance(from.x, d.x, extent.x), min(probeFaceDistance(from.y, d.y, extent.y), probeFaceDistance(from.z, d.z, extent.z)));  // model: the first face
  return from + d * way;
}

// The direction in which the capture saw that point: of any length. d where it is the capture's own place.
FN vec3 probeDirection(vec3 hit, vec3 d, vec3 capture) {
  vec3 to = hit - capture;
  return dot(to, to) > BURNISH_GUARD_LENGTH ? to : d;
}

// Perceptual roughness with which the capture is looked up: a lobe that reaches a near wall spans less of it than the same lobe from the capture's place (Lagarde and de Rousiers 2014,
// "Moving Frostbite to Physically Based Rendering", distance-based roughness).
FN real probeRoughness(real roughness, vec3 p, vec3 hit, vec3 capture) {
  vec3 a = hit - p;
  vec3 b = hit - capture;
  real nearer = unitClamp(sqrt(dot(a, a) / max(dot(b, b), BURNISH_GUARD_LENGTH))) * roughness;
  return nearer + (roughness - nearer) * roughness;
}

// How deep p lies inside, over the fade along each axis, 0 to 1. fade: at most the extent.
FN real probeInfluence(vec3 p, vec3 extent, vec3 fade) {
  vec3 in_ = extent - abs(p);
  return unitClamp(in_.x / max(fade.x, BURNISH_GUARD_LENGTH)) * unitClamp(in_.y / max(fade.y, BURNISH_GUARD_LENGTH)) * unitClamp(in_.z / max(fade.z, BURNISH_GUARD_LENGTH));
}

// From the box to p; 0 inside and on the faces.
FN real probeDistance(vec3 p, vec3 extent) {
  vec3 d = p - probeHeld(p, extent);
  return sqrt(dot(d, d));
}

// Shares of the places around a point and of the sky; they sum to 1.
struct ProbeBlend {
  vec4 weight;
  real sky;
  real left;      // what the boxes so far leave to larger ones
  real coverage;  // of the nearest box, while p is in none
  bool inside;    // p lies in some box
};

FN ProbeBlend beginBlend() {
  ProbeBlend b;
  b.weight = vec4(R(0.0));
  b.sky = R(1.0);
  b.left = R(1.0);
  b.coverage = R(0.0);
  b.inside = false;
  return b;
}

// Adds a place, smaller boxes before larger ones. Inside: its influence of what is left. In no box: by how near it is; nothing at the margin's end.
FN void addToBlend(INOUT(ProbeBlend) b, int slot, vec3 p, vec3 extent, vec3 fade, real margin) {
  real away = probeDistance(p, extent);
  if (away <= R(0.0)) {
    if (!b.inside) b.weight = vec4(R(0.0));
    b.inside = true;
    real influence = max(probeInfluence(p, extent, fade), PROBE_LEAST_SHARE);  // model: its share on its faces
    b.weight[slot] = influence * b.left;
    b.left *= R(1.0) - influence;
  } else if (!b.inside) {
    real beyond = unitClamp(away / max(margin, BURNISH_GUARD_LENGTH));
    b.weight[slot] = (R(1.0) - beyond) / max(beyond, PROBE_LEAST_SHARE);  // model: its share on its faces
    b.coverage = max(b.coverage, R(1.0) - beyond);  // model: the nearest box's
  }
}

FN void endBlend(INOUT(ProbeBlend) b) {
  real all = b.inside ? R(1.0) : b.coverage;
  b.weight = b.weight * (all / max(b.weight.x + b.weight.y + b.weight.z + b.weight.w, BURNISH_GUARD_LENGTH));
  b.sky = R(1.0) - all;
}
