// Light of the lattice (shading/grid.h) at a place. The includer has included shading/bridge.h, shading/all.h and interface/layout.h. Definitions: RUNG_AMBIENT.
layout(std140, binding = BINDING_GRID) uniform Grid { GridData grid; };
// Of each point: its harmonics as pairs of half floats, 27 of them in GRID_LIGHT_TEXELS texels; its planes as half floats, with a border of one texel.
layout(binding = UNIT_GRID_LIGHT) uniform usamplerBuffer gridLights;
layout(binding = UNIT_GRID_PLANES) uniform usamplerBuffer gridPlanes;

vec4 gridPlane(int texel) {
  uvec2 two = texelFetch(gridPlanes, texel).xy;
  return vec4(unpackHalf2x16(two.x), unpackHalf2x16(two.y));
}

// How much of the point sees the place; aim and away: shading/grid.h.
float gridSeen(int point, vec3 aim, vec3 away) {
  vec2 t = distanceTexel(aim, float(GRID_MAP_SIZE)) + 0.5, low = floor(t);
  int texel = point * (GRID_TILE * GRID_TILE) + int(low.y) * GRID_TILE + int(low.x);
  return gridSees(gridBefore(gridPlane(texel), away), gridBefore(gridPlane(texel + 1), away), gridBefore(gridPlane(texel + GRID_TILE), away), gridBefore(gridPlane(texel + GRID_TILE + 1), away), t - low);
}

// Its irradiance over pi for the normal n, without the lattice's scale.
vec3 gridLight(int point, vec3 n) {
  int texel = point * GRID_LIGHT_TEXELS;
  uvec4 a = texelFetch(gridLights, texel);
  vec2 a0 = unpackHalf2x16(a.x), a1 = unpackHalf2x16(a.y);
  vec3 sum = vec3(a0, a1.x);
#if RUNG_AMBIENT >= AMBIENT_SH_L1
  uvec4 b = texelFetch(gridLights, texel + 1);
  vec2 a2 = unpackHalf2x16(a.z), a3 = unpackHalf2x16(a.w), b0 = unpackHalf2x16(b.x), b1 = unpackHalf2x16(b.y);
  sum += vec3(a1.y, a2) * n.y + vec3(a3, b0.x) * n.z + vec3(b0.y, b1) * n.x;
#endif
#if RUNG_AMBIENT >= AMBIENT_SH_L2
  uvec4 c = texelFetch(gridLights, texel + 2), d = texelFetch(gridLights, texel + 3);
  vec2 b2 = unpackHalf2x16(b.z), b3 = unpackHalf2x16(b.w), c0 = unpackHalf2x16(c.x), c1 = unpackHalf2x16(c.y), c2 = unpackHalf2x16(c.z), c3 = unpackHalf2x16(c.w);
  vec2 d0 = unpackHalf2x16(d.x), d1 = unpackHalf2x16(d.y);
  sum += vec3(b2, b3.x) * (n.x * n.y) + vec3(b3.y, c0) * (n.y * n.z) + vec3(c1, c2.x) * (3.0 * n.z * n.z - 1.0) + vec3(c2.y, c3) * (n.x * n.z) + vec3(d0, d1.x) * (n.x * n.x - n.y * n.y);
#endif
  return sum;
}

// rgb: pre-exposed irradiance over pi at p (camera-relative, m) for the unit normal n; w: the lattice's share of it, the rest is of what is there without one.
// A loop over the points that count, with a bit for each of the cell's eight: a software renderer pays for what it branches around, but not for turns of a loop that no pixel of its group takes.
vec4 gridAt(vec3 p, vec3 n) {
  vec3 q = vec3(dot(grid.toLattice[0].xyz, p) + grid.toLattice[0].w, dot(grid.toLattice[1].xyz, p) + grid.toLattice[1].w, dot(grid.toLattice[2].xyz, p) + grid.toLattice[2].w);
  GridCell cell = gridCell(q, grid.last.xyz, grid.margin.xyz);
  vec3 x = grid.step[0].xyz, y = grid.step[1].xyz, z = grid.step[2].xyz, inCell = q - cell.first;
  vec3 fromFirst = x * inCell.x + y * inCell.y + z * inCell.z, perStep = vec3(dot(x, n), dot(y, n), dot(z, n));
  float height = -dot(fromFirst, n), perDepth = grid.step[2].w;
  fromFirst += x * cell.pull.x + y * cell.pull.y + z * cell.pull.z;
  int base = int((cell.first.z * (grid.last.y + 1.0) + cell.first.y) * (grid.last.x + 1.0) + cell.first.x), row = int(grid.last.x) + 1, slice = row * (int(grid.last.y) + 1);
  vec3 light = vec3(0.0);
  float sum = 0.0, left = 1.0;
  int todo = 0, behind = 0;
  for (int i = 0; i < 8; ++i) {
    vec3 side = vec3(i & 1, (i >> 1) & 1, i >> 2);
    bool counts = cell.weight > 0.0 && gridShare(cell, side) > 0.0;
    float before = gridInFront(height + dot(perStep, side), perDepth);
    todo |= int(counts && before > 0.0) << i;
    behind |= int(counts && before < 1.0) << i;
  }
  // Points before the surface's plane; where they know next to nothing, the others take over.
  bool front = todo != 0;
  if (!front) todo = behind;
  while (todo != 0) {
    int i = findLSB(todo);
    todo &= todo - 1;
    vec3 side = vec3(i & 1, (i >> 1) & 1, i >> 2), away = fromFirst - x * side.x - y * side.y - z * side.z;
    float before = gridInFront(height + dot(perStep, side), perDepth), w = gridShare(cell, side) * (front ? before : (1.0 - before) * left);
    int point = base + (i & 1) + ((i >> 1) & 1) * row + (i >> 2) * slice;
    w *= gridSeen(point, away + n * grid.step[0].w, away + n * grid.step[1].w);
    light += gridLight(point, n) * w;
    sum += w;
    if (todo == 0 && front) {
      front = false;
      left = 1.0 - gridTrust(sum);
      todo = left > 0.0 ? behind : 0;
    }
  }
  return vec4(light * (grid.last.w / max(sum, BURNISH_GUARD_LENGTH)), cell.weight * gridTrust(sum));
}
