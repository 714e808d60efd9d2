// What full-screen passes begin with.
#pragma once
#include "gpu_scene/frame.h"

namespace burnish::post {

/// Whose pixels a pass writes: those that are shaded, or the target's, which are more where pixels are shaded at a smaller size.
enum class Pixels : std::uint8_t { Shaded, Target };

/// Plain state on a framebuffer, viewport and scissor at the view's rectangle.
inline void beginScreen(gpu_scene::FrameContext& c, GLuint framebuffer, Pixels pixels = Pixels::Shaded) {
  const GladGLContext& gl = c.device.gl;
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  pixels == Pixels::Target ? c.setTargetViewport() : c.setViewport();
  gl.Disable(GL_DEPTH_TEST);
  gl.BindSamplers(0, 10, nullptr);
}

inline void bindIfThere(gpu_scene::FrameContext& c, std::string_view target, GLuint unit) {
  if (const gl::Texture* t = c.targets.texture(target)) t->bind(unit);
}

}  // namespace burnish::post
