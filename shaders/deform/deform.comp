// A mesh's vertices into an instance's own, moved by morph targets and joints (glTF 2.0, sections 3.7.2.2 and 3.7.3.3): one invocation a vertex.
// Both buffers hold vertices as GpuMesh does, nine words each: position f32x3, normal and tangent snorm16x4, uv f32x2.
// Definitions: MORPH 1 = weighed targets are added; SKIN 1 = four joints move the vertex.
#include "interface/layout.h"
layout(local_size_x = DEFORM_GROUP) in;

layout(std430, binding = STORAGE_DEFORM_SOURCE) readonly buffer Source { uint source[]; };
layout(std430, binding = STORAGE_DEFORM_RESULT) writeonly buffer Result { uint result[]; };
// x vertices; y first texel of the instance in `pose`; z morph targets that count; w words that a target holds for a vertex: 3 position, 6 with normal, 9 with tangent
layout(location = 0) uniform ivec4 counts;
// The targets that count, a texel each: x its index, y its weight. Then joints, three texels each: the rows of the matrix from mesh space to the deformed one.
layout(binding = UNIT_POSE) uniform samplerBuffer pose;
#if MORPH
layout(std430, binding = STORAGE_DEFORM_TARGETS) readonly buffer Targets { float targets[]; };
#endif
#if SKIN
// Six words a vertex: joints u16x4, weights f32x4.
layout(std430, binding = STORAGE_DEFORM_JOINTS) readonly buffer Joints { uint joints[]; };
#endif

vec3 unitOr(vec3 v, vec3 otherwise) {
  float square = dot(v, v);
  return square > 1e-30 ? v * inversesqrt(square) : otherwise;
}

#if MORPH
vec3 delta(int target, int vertex, int part) {
  int at = (target * counts.x + vertex) * counts.w + 3 * part;
  return vec3(targets[at], targets[at + 1], targets[at + 2]);
}
#endif

void main() {
  int vertex = int((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * DEFORM_GROUP + gl_LocalInvocationID.x);
  if (vertex >= counts.x) return;
  int from = 9 * vertex;
  vec3 position = vec3(uintBitsToFloat(source[from]), uintBitsToFloat(source[from + 1]), uintBitsToFloat(source[from + 2]));
  vec4 n = vec4(unpackSnorm2x16(source[from + 3]), unpackSnorm2x16(source[from + 4]));
  vec4 t = vec4(unpackSnorm2x16(source[from + 5]), unpackSnorm2x16(source[from + 6]));
  vec3 normal = n.xyz, tangent = t.xyz;
#if MORPH
  for (int i = 0; i < counts.z; ++i) {
    vec4 target = texelFetch(pose, counts.y + i);
    int index = int(target.x);
    position += target.y * delta(index, vertex, 0);
    if (counts.w > 3) normal += target.y * delta(index, vertex, 1);
    if (counts.w > 6) tangent += target.y * delta(index, vertex, 2);
  }
  normal = unitOr(normal, n.xyz);
  tangent = unitOr(tangent, t.xyz);
#endif
#if SKIN
  int at = 6 * vertex;
  uvec4 joint = uvec4(joints[at] & 0xffffu, joints[at] >> 16, joints[at + 1] & 0xffffu, joints[at + 1] >> 16);
  vec4 row0 = vec4(0), row1 = vec4(0), row2 = vec4(0);
  for (int c = 0; c < 4; ++c) {
    float weight = uintBitsToFloat(joints[at + 2 + c]);
    int row = counts.y + counts.z + 3 * int(joint[c]);
    row0 += weight * texelFetch(pose, row);
    row1 += weight * texelFetch(pose, row + 1);
    row2 += weight * texelFetch(pose, row + 2);
  }
  vec4 p = vec4(position, 1);
  position = vec3(dot(row0, p), dot(row1, p), dot(row2, p));
  // Cofactors carry normals through any matrix, singular ones included; of the matrix over its largest element, so that products neither overflow nor vanish.
  vec3 largest = max(max(abs(row0.xyz), abs(row1.xyz)), abs(row2.xyz));
  float scale = 1 / max(max(largest.x, max(largest.y, largest.z)), 1e-30);
  vec3 r0 = row0.xyz * scale, r1 = row1.xyz * scale, r2 = row2.xyz * scale;
  vec3 c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
  vec3 turned = vec3(dot(c0, normal), dot(c1, normal), dot(c2, normal));
  normal = unitOr(dot(r0, c0) < 0 ? -turned : turned, normal);
  if (dot(r0, c0) < 0) t.w = -t.w;  // as gbuffer.vert has it for transforms that mirror
  tangent = unitOr(vec3(dot(r0, tangent), dot(r1, tangent), dot(r2, tangent)), tangent);
#endif
  result[from] = floatBitsToUint(position.x);
  result[from + 1] = floatBitsToUint(position.y);
  result[from + 2] = floatBitsToUint(position.z);
  result[from + 3] = packSnorm2x16(normal.xy);
  result[from + 4] = packSnorm2x16(vec2(normal.z, n.w));
  result[from + 5] = packSnorm2x16(tangent.xy);
  result[from + 6] = packSnorm2x16(vec2(tangent.z, t.w));
  result[from + 7] = source[from + 7];
  result[from + 8] = source[from + 8];
}
