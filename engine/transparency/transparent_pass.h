// Pass "transparent": blended surfaces and glass over the lit picture, farthest first; layer by layer where no order holds for the whole picture (docs/decisions/transparency.md).
#pragma once
#include <map>

#include "gpu_scene/frame.h"
#include "plan/variants.h"

namespace burnish::transparency {

class TransparentPass {
 public:
  explicit TransparentPass(gl::Device& device) : device_(device) {}
  /// Draws the view's groups into the light buffer, with what LightingPass::bindLights bound.
  Result<void> draw(gpu_scene::FrameContext& context);

 private:
  struct Programs {
    const gl::Program* shade = nullptr;
    const gl::Program* peel = nullptr;
  };
  enum class Stage : std::uint8_t { Shade, Peel };

  Result<void> begin(gpu_scene::FrameContext& c);
  Result<void> drawGroup(gpu_scene::FrameContext& c, const scene::TransparentGroup& group);
  Result<void> drawLayers(gpu_scene::FrameContext& c, const scene::TransparentGroup& group);
  Result<void> drawRest(gpu_scene::FrameContext& c, const scene::TransparentGroup& group, std::string_view last, bool refracts);
  /// False when the layer is empty.
  Result<bool> peel(gpu_scene::FrameContext& c, const scene::TransparentGroup& group, std::string_view before, std::string_view into);
  Result<void> drawParts(gpu_scene::FrameContext& c, std::span<const scene::TransparentPart> parts, Stage stage);
  Result<const Programs*> programsOf(gpu_scene::FrameContext& c, const Material& material, const Mesh& mesh);
  /// Binds light buffer and depth for shading.
  Result<void> bindShading(gpu_scene::FrameContext& c, std::string_view depth, GLenum depthFunction, bool refracts);
  /// Brings the copy of the picture up to date with what has been drawn since.
  Result<void> copyPicture(gpu_scene::FrameContext& c, bool levels);
  Result<void> blurPicture(gpu_scene::FrameContext& c);

  gl::Device& device_;
  gl::Query samples_;
  gl::Sampler smooth_;
  std::map<plan::TransparentVariant, Programs> programs_;  ///< of this frame
  bool blend_ = false, glass_ = false;
  glm::ivec4 copyStale_{0}, blurStale_{0};  ///< x, y, width, height of the target; empty: up to date
};

}  // namespace burnish::transparency
