// Vertices as a pose moves them, on the CPU: what shaders/deform does on the GPU.
#pragma once
#include <burnish/scene.h>

#include <vector>

#include "scene/pose.h"

namespace burnish::scene {

/// The vertices in the pose's space: target weights first, then the joints. pose nullptr: as they are.
std::vector<glm::dvec3> deformedPositions(const Mesh& mesh, const Pose* pose);
/// Normals and the tangents' directions there, unit or zero; `mesh` as preparedMesh makes it. Streams that the mesh lacks stay empty.
struct DeformedFrames {
  std::vector<glm::vec3> normals;
  std::vector<glm::vec4> tangents;  ///< w turned where the joints mirror, so that cross(n, t) · w is the bitangent
};
DeformedFrames deformedFrames(const Mesh& mesh, const Pose* pose);

}  // namespace burnish::scene
