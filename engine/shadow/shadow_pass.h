// Pass "shadow_maps": depth pictures from lights. A map that an earlier frame drew is kept for as long as its content is the same (scene/shadows.h).
#pragma once
#include "gpu_scene/frame.h"
#include "plan/variants.h"

namespace burnish::shadow {

class ShadowPass {
 public:
  explicit ShadowPass(gl::Device& device) : device_(device) {}
  /// Gives each of the view's maps a layer, draws those whose picture is not there yet, and uploads what lighting looks up.
  Result<void> draw(gpu_scene::FrameContext& context);

 private:
  struct Layer {
    std::uint64_t content = 0;  ///< 0: nothing that lasts
    std::uint64_t used = 0;     ///< when it was last wanted
  };
  /// One call: casters that share vertices, and material where that counts.
  struct Group {
    std::uint32_t caster = 0;    ///< the first one, index into ShadowSet::casters
    std::uint32_t first = 0, count = 0;  ///< matrices
  };
  struct Drawing {
    std::size_t map = 0;
    std::vector<Group> groups;
  };

  /// The maps that must be drawn.
  std::vector<std::size_t> assignLayers(gpu_scene::FrameContext& c);
  int freeLayer() const;
  Result<void> deformCasters(gpu_scene::FrameContext& c, const std::vector<std::size_t>& maps);
  Drawing prepare(gpu_scene::FrameContext& c, std::size_t map);
  Result<void> drawMap(gpu_scene::FrameContext& c, const Drawing& drawing);
  Result<void> drawGroup(gpu_scene::FrameContext& c, const Group& group, const gl::Program*& used);
  const gl::VertexArray& array(plan::ShadowVariant variant);

  gl::Device& device_;
  std::vector<Layer> layers_;
  std::uint64_t texture_ = 0;  ///< TargetPool::serial of the maps
  std::uint64_t now_ = 0;
  std::vector<glm::mat4> matrices_;  ///< of this frame, caster by caster
  gl::Buffer buffer_;
  gl::VertexArray arrays_[3];
};

}  // namespace burnish::shadow
