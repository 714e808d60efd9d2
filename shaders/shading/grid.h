// Ambient light from a lattice of points that know their irradiance (spherical harmonics) and how far they see (octahedral maps of distances), so that light does not pass through walls.
// After Majercik, Guertin, Nowrouzezahrai and McGuire 2019, "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", section 5. Their test of what a point sees is Chebyshev's
// inequality on mean and variance of distance, which cannot tell a thin wall's two sides apart where it is seen at an angle. Here each texel of a point's map stands for a plane, that of the surface
// seen there (found from the same two numbers: engine/gpu_scene/grid_planes.h), and the test is the side of it: exact for walls, however thin.

// Where (x, y) of a map of `size` texels a side lies on the octahedral square [-1, 1]²: whole numbers are corners of texels, x + 0.5 is the middle of texel x. Row y is v.
FN vec2 distancePlace(real x, real y, real size) { return vec2(x / size * R(2.0) - R(1.0), y / size * R(2.0) - R(1.0)); }
// The direction there, unit, in the axes of the world (shading/normals.h: the middle of the square is +z). A texel's directions are those of its square, evenly spread over it.
FN vec3 distanceDirection(real x, real y, real size) { return octahedralDecode(distancePlace(x, y, size)); }
// The inverse, for a direction of any length: texels from the map's corner, [0, size].
FN vec2 distanceTexel(vec3 direction, real size) {
  vec2 e = octahedralEncode(direction);
  return vec2((e.x + R(1.0)) * R(0.5) * size, (e.y + R(1.0)) * R(0.5) * size);
}
// Distances are held at this, metres: a lookup is never farther from a point than a cell's diagonal and the bias along the normal. spacing: metres.
FN real distanceLimit(vec3 spacing) { return R(1.5) * length(spacing); }

// What a point sees of a surface is looked up this far before it along the normal, metres: the texels there, away from the edge with the next surface, know the planes apart. least: the smallest spacing.
// Not toward the eye too, as the paper has it: what lights a surface then does not depend on who looks.
FN real gridAim(real least) { return R(0.2) * least; }
// And the place that must lie before these planes is this far before the surface, so that it does not hide behind itself.
FN real gridBias(real least) { return R(0.1) * least; }
// How far over the surface's plane a point counts in full, metres.
FN real gridDepth(real least) { return R(0.05) * least; }

// Where a place lies in the lattice.
struct GridCell {
  vec3 first;   // the cell's lowest point, whole numbers
  vec3 share;   // of the next point along each axis, [0, 1]
  vec3 pull;    // toward the lattice, from a place outside: what is seen is looked up so much nearer, since in the very corner of a room texels mix its walls
  real weight;  // of the lattice, [0, 1]: outside it gives way
};

// q: lattice coordinates, where points are whole numbers. last: those of the last point. perMargin: spacing over the margin, for each axis. A point stands for half a cell around it, so the lattice
// reaches that far beyond its outer points with its full weight; then it gives way over the margin.
FN GridCell gridCell(vec3 q, vec3 last, vec3 perMargin) {
  GridCell c;
  vec3 held = clamp(q, vec3(R(0.0)), last);             // model: light goes on as it is outside
  c.first = clamp(floor(held), vec3(R(0.0)), max(last - vec3(R(1.0)), vec3(R(0.0))));  // model: the last point belongs to the cell before it
  c.share = held - c.first;
  c.pull = clamp(held - q, vec3(R(-0.03)), vec3(R(0.03)));  // model: less than points stand before a wall
  vec3 out_ = max(abs(q - held) - vec3(R(0.5)), vec3(R(0.0))) * perMargin;  // model: half a cell belongs to the lattice
  c.weight = unitClamp(R(1.0) - length(out_));
  return c;
}

// The trilinear weight of a corner of the cell; side: 0 or 1 along each axis.
FN real gridShare(GridCell c, vec3 side) {
  vec3 w = vec3(R(1.0)) - side + c.share * (side * R(2.0) - vec3(R(1.0)));
  return w.x * w.y * w.z;
}

// Points under the surface's own plane know nothing of its light. height: of the point over that plane; perDepth: 1 over gridDepth.
FN real gridInFront(real height, real perDepth) {
  real t = unitClamp(height * perDepth);
  return t * t * (R(3.0) - R(2.0) * t);
}

// How much of a place is before the plane of one texel. away: from the point to the place. plane: xyz = the plane's normal over its distance from the point, so that xyz · (what lies on it) = 1;
// w = 1 over how far beyond it, by this measure, light ends. (0, 0, 0, -1): nothing is before it.
FN real gridBefore(vec4 plane, vec3 away) { return unitClamp(R(1.0) - (plane.x * away.x + plane.y * away.y + plane.z * away.z - R(1.0)) * plane.w); }

// What the four texels around a direction say together. An eighth of the weight that says no is a no: next to an edge of the room the texels of one wall would let pass what lies behind the other.
FN real gridSees(real ll, real lr, real ul, real ur, vec2 f) {
  real seen = (ll * (R(1.0) - f.x) + lr * f.x) * (R(1.0) - f.y) + (ul * (R(1.0) - f.x) + ur * f.x) * f.y;
  return unitClamp(R(1.0) - (R(1.0) - seen) * R(8.0));
}

// What the lattice's light counts where the weights of a cell's points sum up to this: next to nothing is left to what is there without a lattice.
FN real gridTrust(real sum) { return unitClamp(sum * R(20.0)); }
