#include "scene/shadow_content.h"

#include <bit>

namespace burnish::scene {
namespace {

// A running mix of 64-bit words (Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators", the finaliser).
class Digest {
 public:
  void add(std::uint64_t word) {
    state_ = (state_ ^ word) + 0x9e3779b97f4a7c15ull;
    state_ = (state_ ^ (state_ >> 30)) * 0xbf58476d1ce4e5b9ull;
    state_ = (state_ ^ (state_ >> 27)) * 0x94d049bb133111ebull;
    state_ ^= state_ >> 31;
  }
  void add(const glm::dmat4& m) {
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r) add(std::bit_cast<std::uint64_t>(m[c][r]));
  }
  void add(const glm::mat4& m) {
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; r += 2) add(std::uint64_t(std::bit_cast<std::uint32_t>(m[c][r])) << 32 | std::bit_cast<std::uint32_t>(m[c][r + 1]));
  }
  [[nodiscard]] std::uint64_t value() const { return state_ ? state_ : 1; }

 private:
  std::uint64_t state_ = 0;
};

// Where a caster is, which vertices it shows and where it has holes.
std::uint64_t contentOf(const Scene& scene, ShadowCaster& c) {
  if (c.content) return c.content;
  Digest d;
  const Instance& instance = *c.placed.instance;
  d.add(std::uint64_t(instance.mesh.index) << 32 | instance.mesh.generation);
  d.add(scene.meshes.revision(instance.mesh));
  d.add(c.placed.placement);
  if (const Pose* pose = c.placed.pose) {
    for (const glm::mat4& joint : pose->joints) d.add(joint);
    for (const auto& [target, weight] : pose->targets) d.add(std::uint64_t(target) << 32 | std::bit_cast<std::uint32_t>(weight));
  }
  if (c.cutout) {
    d.add(std::uint64_t(instance.material.index) << 32 | instance.material.generation);
    d.add(scene.materials.revision(instance.material));
    d.add(scene.textures.revision());
  }
  return c.content = d.value();
}

}  // namespace

std::uint64_t contentOf(const Scene& scene, const ShadowMap& map, std::vector<ShadowCaster>& casters, int resolution) {
  Digest d;
  d.add(scene.identity.value());
  d.add(std::uint64_t(resolution));
  for (int i = 0; i < 3; ++i) d.add(std::bit_cast<std::uint64_t>(map.origin[i]));
  d.add(map.clip);
  for (const std::uint32_t c : map.casters) d.add(contentOf(scene, casters[c]));
  return d.value();
}

}  // namespace burnish::scene
