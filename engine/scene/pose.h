// Deformed instances: where joints and morph weights take a mesh's vertices, and what they can reach.
#pragma once
#include <burnish/scene.h>

#include <vector>

namespace burnish::scene {

/// What deformation moves in a mesh, as boxes: poses bound their vertices with it.
struct Extents {
  Bounds all;                       ///< of the vertices that triangles use
  std::vector<Bounds> joints;       ///< of those that hang on each joint; empty boxes for joints that hold none
  std::vector<glm::vec3> least, most;  ///< of each morph target's deltas; zero is always between them
};
/// Bounds of the vertices that triangles use; `joints` and targets only where the mesh's streams are whole.
Extents extentsOf(const Mesh& mesh);

/// How one instance is deformed at one moment. Deformed vertices live in a space of their own, near the instance, so that floats do wherever it stands:
/// target weights first, then position = sum of weight · joints[j] · v.
struct Pose {
  bool skinned = false, morphed = false;
  glm::dmat4 placement{1};        ///< from that space to the world: of a skinned instance a translation, of others its node
  std::vector<glm::mat4> joints;  ///< mesh space to that space; empty unless skinned
  std::vector<std::pair<std::uint32_t, float>> targets;  ///< index and weight of the morph targets that count
  Bounds bounds;                  ///< in that space; holds every deformed vertex
  bool flipped = false;           ///< the joints mirror
  /// The same vertices, wherever the instance stands.
  [[nodiscard]] bool sameShape(const Pose& o) const { return skinned == o.skinned && joints == o.joints && targets == o.targets; }
};
/// Whether the instance's mesh may be deformed: it has a skin, or a morph weight that is not zero. poseOf decides, and says what does not fit.
bool deforms(const Scene& scene, const Instance& instance, const Mesh& mesh);
/// `world`: of all nodes, by index (worldMatrices). What is mended is reported.
Pose poseOf(const Scene& scene, const Instance& instance, const Mesh& mesh, const Extents& extents, const std::vector<glm::dmat4>& world, Report* report);
/// The box of a box under an affine matrix; empty when it is not finite.
Bounds transformed(const Bounds& box, const glm::dmat4& matrix);

}  // namespace burnish::scene
