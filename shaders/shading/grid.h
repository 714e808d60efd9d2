// Ambient light from a lattice of points that know their irradiance (spherical harmonics) and how far they see (octahedral maps of distances), so that light does not pass through walls.
// After Majercik, Guertin, Nowrouzezahrai and McGuire 2019, "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", section 5; docs/probes.md says what differs.

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
