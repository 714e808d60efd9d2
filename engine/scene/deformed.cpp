#include "scene/deformed.h"

#include <algorithm>
#include <cmath>

namespace burnish::scene {
namespace {

glm::dmat4 jointOf(const Mesh& mesh, const Pose& pose, std::size_t v) {
  glm::dmat4 m(0);
  for (int c = 0; c < 4; ++c) m += double(mesh.weights[v][c]) * glm::dmat4(pose.joints[mesh.joints[v][c]]);
  return m;
}

glm::vec3 unitOr(const glm::vec3& v, const glm::vec3& otherwise) {
  const float square = glm::dot(v, v);
  return square > 1e-30f ? v / std::sqrt(square) : otherwise;
}

void morph(const Mesh& mesh, const Pose& pose, DeformedFrames& out) {
  std::vector<glm::vec3> normals = out.normals, tangents(out.tangents.begin(), out.tangents.end());
  for (const auto& [target, weight] : pose.targets) {
    const MorphTarget& t = mesh.targets[target];
    for (std::size_t v = 0; v < std::min(t.normals.size(), normals.size()); ++v) normals[v] += weight * t.normals[v];
    for (std::size_t v = 0; v < std::min(t.tangents.size(), tangents.size()); ++v) tangents[v] += weight * t.tangents[v];
  }
  for (std::size_t v = 0; v < normals.size(); ++v) out.normals[v] = unitOr(normals[v], out.normals[v]);
  for (std::size_t v = 0; v < tangents.size(); ++v) out.tangents[v] = glm::vec4(unitOr(tangents[v], glm::vec3(out.tangents[v])), out.tangents[v].w);
}

// Cofactors carry normals through any matrix, singular ones included; of the matrix over its largest element, so that products neither overflow nor vanish.
void turn(const Mesh& mesh, const Pose& pose, DeformedFrames& out) {
  for (std::size_t v = 0; v < std::max(out.normals.size(), out.tangents.size()); ++v) {
    const glm::dmat3 joint(jointOf(mesh, pose, v));
    double largest = 1e-30;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) largest = std::max(largest, std::abs(joint[c][r]));
    const glm::dmat3 m = joint / largest;
    const glm::dmat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    const double sign = glm::dot(m[0], cofactor[0]) < 0 ? -1 : 1;
    if (v < out.normals.size()) out.normals[v] = unitOr(glm::vec3(cofactor * glm::dvec3(out.normals[v]) * sign), out.normals[v]);
    if (v < out.tangents.size()) out.tangents[v] = glm::vec4(unitOr(glm::vec3(m * glm::dvec3(out.tangents[v])), glm::vec3(out.tangents[v])), out.tangents[v].w * float(sign));
  }
}

}  // namespace

std::vector<glm::dvec3> deformedPositions(const Mesh& mesh, const Pose* pose) {
  std::vector<glm::dvec3> out(mesh.positions.begin(), mesh.positions.end());
  if (!pose) return out;
  for (const auto& [target, weight] : pose->targets) {
    const std::vector<glm::vec3>& deltas = mesh.targets[target].positions;
    for (std::size_t v = 0; v < std::min(deltas.size(), out.size()); ++v) out[v] += double(weight) * glm::dvec3(deltas[v]);
  }
  if (!pose->skinned) return out;
  for (std::size_t v = 0; v < out.size(); ++v) out[v] = glm::dvec3(jointOf(mesh, *pose, v) * glm::dvec4(out[v], 1));
  return out;
}

DeformedFrames deformedFrames(const Mesh& mesh, const Pose* pose) {
  DeformedFrames out{mesh.normals, mesh.tangents};
  if (!pose) return out;
  if (!pose->targets.empty()) morph(mesh, *pose, out);
  if (pose->skinned) turn(mesh, *pose, out);
  return out;
}

}  // namespace burnish::scene
