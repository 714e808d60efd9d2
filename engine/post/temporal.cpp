#include "post/temporal.h"

#include <fmt/format.h>

#include "plan/temporal.h"
#include "post/screen.h"

namespace burnish::post {

using gpu_scene::FrameContext;

namespace {

// What the program "temporal" takes beside what "temporal_still" does.
void followMotion(FrameContext& c, const gl::Program& program) {
  const GladGLContext& gl = c.device.gl;
  const gpu_scene::PastFrame& past = c.past;
  if (const gl::Texture* before = c.targets.texture(plan::historyName(past.sequence, past.source))) {
    gl.TextureParameteri(before->id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl.TextureParameteri(before->id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  }
  bindIfThere(c, plan::historyDistanceName(past.sequence, past.source), UNIT_HISTORY_DISTANCE);
  bindIfThere(c, "velocity", UNIT_VELOCITY);
  glm::dmat4 moved(1);
  moved[3] = glm::dvec4(c.view.eye - past.frame.eye, 1);
  const glm::mat4 toPrevious(scene::withoutJitter(past.frame) * moved);
  gl.ProgramUniformMatrix4fv(program.id(), 0, 1, GL_FALSE, &toPrevious[0][0]);
  gl.ProgramUniform4f(program.id(), 4, float(c.view.jitter.x), float(c.view.jitter.y), float(past.frame.depthParams.x), float(past.frame.depthParams.y));
}

}  // namespace

Result<void> joinHistory(FrameContext& c) {
  const GladGLContext& gl = c.device.gl;
  const gpu_scene::PastFrame& past = c.past;
  const int into = 1 - past.source;
  const std::string picture = plan::historyName(past.sequence, into);
  // Both are made at once, so that the second frame makes nothing.
  auto other = c.targets.framebuffer({plan::historyName(past.sequence, past.source), plan::historyDistanceName(past.sequence, past.source)});
  auto framebuffer = c.targets.framebuffer({picture, plan::historyDistanceName(past.sequence, into)});
  if (!other) return fail(other.error());
  if (!framebuffer) return fail(framebuffer.error());
  const std::string name = fmt::format("temporal{}{}", past.still ? "_still" : "", c.view.orthographic ? "+ortho" : "");
  const gl::Program* program = c.programs.find(name);
  if (!program) return fail("frame plan", fmt::format("program '{}' is not in it", name), "report this as a fault of the engine");
  beginScreen(c, *framebuffer);
  bindIfThere(c, "light", UNIT_LIGHT_BUFFER);
  bindIfThere(c, "depth", UNIT_DEPTH);
  bindIfThere(c, plan::historyName(past.sequence, past.source), UNIT_HISTORY);
  if (!past.still) followMotion(c, *program);
  gl.ProgramUniform4f(program->id(), 5, past.valid ? 1.0f : 0.0f, past.valid ? c.preExposure / past.preExposure : 1.0f, float(plan::kMovingSamples), 0);
  c.picture = picture;
  return c.drawScreen(name);
}

}  // namespace burnish::post
