// The copy of the picture that refracting glass reads, and its mip levels. Only what has changed since the last copy is copied again.
#include <algorithm>

#include "transparency/transparent_pass.h"

namespace burnish::transparency {

using gpu_scene::FrameContext;

Result<void> TransparentPass::copyPicture(FrameContext& c, bool levels) {
  const gl::Texture *picture = c.targets.texture("scene_color"), *light = c.targets.texture("light");
  if (!picture || !light) return fail("frame plan", "target 'scene_color' is not in it", "report this as a fault of the engine");
  // The copy begins at the view's corner, whatever the view's place on the target.
  const glm::ivec4 r = copyStale_, v = c.view.viewport;
  if (r.z > 0 && r.w > 0) device_.gl.CopyImageSubData(light->id(), GL_TEXTURE_2D, 0, r.x, r.y, 0, picture->id(), GL_TEXTURE_2D, 0, r.x - v.x, r.y - v.y, 0, r.z, r.w, 1);
  copyStale_ = glm::ivec4(0);
  return levels && blurStale_.z > 0 ? blurPicture(c) : Result<void>{};
}

Result<void> TransparentPass::blurPicture(FrameContext& c) {
  const gl::Texture& picture = *c.targets.texture("scene_color");
  const gl::Program* program = c.programs.find("scene_blur");
  if (!program) return fail("frame plan", "program 'scene_blur' is not in it", "report this as a fault of the engine");
  const GladGLContext& gl = device_.gl;
  gl.Disable(GL_BLEND);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  const glm::ivec4 v = c.view.viewport;
  glm::ivec2 from(blurStale_.x - v.x, blurStale_.y - v.y), to(from.x + blurStale_.z, from.y + blurStale_.w);
  program->use();
  c.buffers.noVertices(device_).bind();
  for (int level = 1; level < picture.levels; ++level) {
    const glm::ivec2 size(std::max(picture.width >> level, 1), std::max(picture.height >> level, 1));
    // Four texels of the level below, one step of rounding.
    from = glm::max((from - 3) / 2, glm::ivec2(0));
    to = glm::min((to + 4) / 2, size);
    auto framebuffer = c.targets.levelFramebuffer("scene_color", level);
    if (!framebuffer) return fail(framebuffer.error());
    gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
    gl.Viewport(0, 0, size.x, size.y);
    gl.Scissor(from.x, from.y, std::max(to.x - from.x, 0), std::max(to.y - from.y, 0));
    gl.ProgramUniform1i(program->id(), 0, level - 1);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
  }
  blurStale_ = glm::ivec4(0);
  return {};
}

}  // namespace burnish::transparency
