// What instances and lights are, as hashes of their content: names and indices do not count, so that the same scene read from another file has the same ones.
#pragma once
#include <burnish/scene.h>

#include <unordered_map>

#include "core/hash.h"
#include "scene/visibility.h"

namespace burnish::scene {

core::Hash128 hashOf(const Environment& environment);
core::Hash128 hashOf(const Fog& fog);

class SceneHashes {
 public:
  explicit SceneHashes(const Scene& scene) : scene_(scene) {}
  /// Shape and place: what a shadow is made of. `withHoles`: and its material, whose holes show in shadows.
  core::Hash128 shape(const Placed& placed, bool withHoles);
  /// Shape, place and material.
  core::Hash128 look(const Placed& placed);
  core::Hash128 light(const Light& light) const;

 private:
  core::Hash128 mesh(Id<Mesh> id);
  core::Hash128 texture(Id<Texture> id);
  core::Hash128 material(Id<Material> id);

  const Scene& scene_;
  std::unordered_map<std::uint32_t, core::Hash128> meshes_, textures_, materials_;  ///< by index
};

}  // namespace burnish::scene
