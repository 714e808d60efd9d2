#include "post/post_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "post/bloom.h"
#include "post/screen.h"

namespace burnish::post {
namespace {

using gpu_scene::FrameContext;

Result<void> drawDepth(FrameContext& c, std::string_view name, const HostDepth& host) {
  const GladGLContext& gl = c.device.gl;
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_ALWAYS);
  gl.DepthMask(GL_TRUE);
  if (const gl::Program* program = c.programs.find(name))
    gl.ProgramUniform4f(program->id(), 0, host.near, c.view.orthographic && host.far <= 0 ? 1000.0f : host.far, host.reversed ? 1.0f : 0.0f, c.view.orthographic ? 1.0f : 0.0f);
  auto drawn = c.drawScreen(name);
  gl.Disable(GL_DEPTH_TEST);
  return drawn;
}

}  // namespace

Result<void> measureExposure(FrameContext& c) {
  auto framebuffer = c.targets.framebuffer({"exposure"});
  if (!framebuffer) return fail(framebuffer.error());
  beginScreen(c, *framebuffer);
  c.device.gl.Viewport(0, 0, 1, 1);
  c.device.gl.Scissor(0, 0, 1, 1);
  bindIfThere(c, c.picture, UNIT_LIGHT_BUFFER);
  return c.drawScreen("exposure");
}

float readExposure(FrameContext& c) {
  float value[2] = {};
  if (const gl::Texture* t = c.targets.texture("exposure")) c.device.gl.GetTextureSubImage(t->id(), 0, 0, 0, 0, 1, 1, 1, GL_RG, GL_FLOAT, sizeof value, value);
  return value[1];
}

Result<void> drawTonemap(FrameContext& c, GLuint framebuffer) {
  if (c.targets.texture("display")) {
    auto display = c.targets.framebuffer({"display"});
    if (!display) return fail(display.error());
    framebuffer = *display;
  }
  beginScreen(c, framebuffer, Pixels::Target);
  bindIfThere(c, c.picture, UNIT_LIGHT_BUFFER);
  bindIfThere(c, "exposure", UNIT_EXPOSURE);
  if (c.plan.on("host_depth_in")) {
    bindIfThere(c, "gbuffer_b", UNIT_GBUFFER_B);
    bindIfThere(c, "depth", UNIT_DEPTH);
  }
  if (const gl::Texture* bloom = c.targets.texture("bloom")) {
    bloom->bind(UNIT_BLOOM);
    const glm::ivec2 size = scatteredSize(c, 0);
    if (const gl::Program* program = c.programs.find("tonemap")) c.device.gl.ProgramUniform3f(program->id(), 0, scatteredShare(c), float(size.x) - 0.5f, float(size.y) - 0.5f);
  }
  return c.drawScreen("tonemap");
}

Result<void> smoothEdges(FrameContext& c, GLuint framebuffer) {
  beginScreen(c, framebuffer, Pixels::Target);
  const gl::Texture& display = *c.targets.texture("display");
  c.device.gl.TextureParameteri(display.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  c.device.gl.TextureParameteri(display.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  display.bind(UNIT_DISPLAY);
  return c.drawScreen("edge_antialiasing");
}

Result<void> drawDebugView(FrameContext& c, GLuint framebuffer) {
  beginScreen(c, framebuffer);
  constexpr std::pair<std::string_view, GLuint> kUnits[] = {{"gbuffer_a", UNIT_GBUFFER_A}, {"gbuffer_b", UNIT_GBUFFER_B}, {"gbuffer_c", UNIT_GBUFFER_C},
                                                            {"occlusion", UNIT_GBUFFER_C}, {"gbuffer_d", UNIT_GBUFFER_D}, {"depth", UNIT_DEPTH}, {"light", UNIT_LIGHT_BUFFER}};
  const std::vector<std::string>& reads = c.plan.pass("debug_view")->reads;
  for (const auto& [name, unit] : kUnits)
    if (std::find(reads.begin(), reads.end(), name) != reads.end()) bindIfThere(c, name, unit);
  return c.drawScreen(c.view.orthographic ? "debug_view+ortho" : "debug_view");
}

std::uint64_t countNonfinite(FrameContext& c) {
  const gl::Texture* light = c.targets.texture("light");
  if (!light) return 0;
  const glm::ivec4 v = c.view.viewport;
  std::vector<glm::vec4> pixels(std::size_t(v.z) * std::size_t(v.w));
  c.device.gl.GetTextureSubImage(light->id(), 0, v.x, v.y, 0, v.z, v.w, 1, GL_RGBA, GL_FLOAT, GLsizei(pixels.size() * sizeof(glm::vec4)), pixels.data());
  std::uint64_t count = 0;
  for (const glm::vec4& p : pixels) count += !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  // What spreads light says that it let none of these through.
  if (count > 0 && c.plan.on("bloom")) c.report.warn("bloom", fmt::format("{} pixels of the light buffer are not finite: they scatter nothing (view 'nonfinite' shows them)", count));
  if (count > 0 && c.plan.on("temporal_antialiasing"))
    c.report.warn("antialiasing", fmt::format("{} pixels of the light buffer are not finite: they are left out of the mean over frames (view 'nonfinite' shows them)", count));
  return count;
}

Result<void> takeHostDepth(FrameContext& c, const HostDepth& host) {
  auto framebuffer = c.targets.framebuffer({}, "depth");
  if (!framebuffer) return fail(framebuffer.error());
  beginScreen(c, *framebuffer);
  c.device.gl.BindTextureUnit(UNIT_DEPTH, host.texture);
  return drawDepth(c, "depth_in", host);
}

Result<void> giveHostDepth(FrameContext& c, const HostDepth& host) {
  gl::Attachment attachment;
  attachment.texture = host.texture;
  attachment.format = GL_DEPTH_COMPONENT32F;
  auto framebuffer = gl::Framebuffer::create(c.device, {}, attachment, "host depth");
  if (!framebuffer) return fail("target depth", "cannot be drawn to: " + framebuffer.error().what, "give a 2D depth texture of the target's size");
  beginScreen(c, framebuffer->id(), Pixels::Target);
  bindIfThere(c, "depth", UNIT_DEPTH);
  return drawDepth(c, "depth_out", host);
}

}  // namespace burnish::post
