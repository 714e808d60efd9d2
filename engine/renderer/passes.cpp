#include "renderer/passes.h"

#include <fmt/format.h>

#include <algorithm>

#include "gbuffer/geometry_pass.h"
#include "gl/host_state.h"
#include "post/bloom.h"
#include "post/post_pass.h"
#include "post/temporal.h"

namespace burnish {
namespace {

using gpu_scene::FrameContext;
using lighting::LightingPass;

/// Runs a member of LightingPass.
template <Result<void> (LightingPass::*Run)(FrameContext&)>
Result<void> lit(PassCall& p) {
  return (p.modules.lighting().*Run)(p.c);
}

Result<void> takeHostDepth(PassCall& p) { return post::takeHostDepth(p.c, *p.target.depthIn); }
Result<void> giveHostDepth(PassCall& p) { return post::giveHostDepth(p.c, *p.target.depthOut); }
Result<void> deformPass(PassCall& p) { return gpu_scene::deform(p.c, p.c.visible); }
Result<void> shadowPass(PassCall& p) { return p.modules.shadows().draw(p.c); }
Result<void> gbufferPass(PassCall& p) { return gbuffer::drawGBuffer(p.c); }
Result<void> emissivePass(PassCall& p) { return gbuffer::drawEmissive(p.c); }

Result<void> forwardPass(PassCall& p) {
  if (auto bound = lit<&LightingPass::bindForward>(p); !bound) return bound;
  return gbuffer::drawForward(p.c);
}

Result<void> transparentPass(PassCall& p) {
  if (p.c.transparent.empty()) return {};
  if (auto bound = lit<&LightingPass::bindLights>(p); !bound) return bound;
  return p.modules.transparent().draw(p.c);
}

Result<void> hostDrawPass(PassCall& p) {
  FrameContext& c = p.c;
  auto framebuffer = c.targets.texture("depth") ? c.targets.framebuffer({"light"}, "depth") : c.targets.framebuffer({"light"});
  if (!framebuffer) return fail(framebuffer.error());
  HostDraw draw;
  draw.framebuffer = *framebuffer;
  draw.viewProjection = glm::mat4(c.view.viewProjection);
  draw.eye = c.view.eye;
  draw.viewport = c.view.viewport;
  draw.exposure = c.preExposure;
  c.device.gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  c.setViewport();
  c.device.gl.Enable(GL_DEPTH_TEST);
  c.device.gl.DepthFunc(GL_GREATER);
  p.request.hostDraw(draw);
  // The callback may have changed anything: back to the state that passes start from.
  gl::setDefaults(c.device);
  c.device.gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  c.buffers.frame.bindBase(GL_UNIFORM_BUFFER, BINDING_FRAME);
  return {};
}

Result<void> lightClearPass(PassCall& p) {
  auto framebuffer = p.c.targets.framebuffer({"light"});
  if (!framebuffer) return fail(framebuffer.error());
  p.c.setViewport();
  const float black[4] = {0, 0, 0, 1};
  p.c.device.gl.ClearNamedFramebufferfv(*framebuffer, GL_COLOR, 0, black);
  return {};
}

Result<void> motionVectorsPass(PassCall& p) { return p.modules.motion().draw(p.c); }
Result<void> temporalAntialiasingPass(PassCall& p) { return post::joinHistory(p.c); }
Result<void> exposurePass(PassCall& p) { return post::measureExposure(p.c); }
Result<void> nonfiniteCountPass(PassCall& p) {
  p.c.stats.nonfinitePixels += post::countNonfinite(p.c);
  if (p.c.plan.on("auto_exposure")) p.c.stats.exposureEv = post::readExposure(p.c);
  return {};
}
Result<void> bloomPass(PassCall& p) { return post::scatter(p.c); }
Result<void> tonemapPass(PassCall& p) { return post::drawTonemap(p.c, p.target.framebuffer); }
Result<void> edgeAntialiasingPass(PassCall& p) { return post::smoothEdges(p.c, p.target.framebuffer); }
Result<void> debugViewPass(PassCall& p) {
  if (p.request.debugView != DebugView::Lights) return post::drawDebugView(p.c, p.target.framebuffer);
  const GladGLContext& gl = p.c.device.gl;
  gl.BindFramebuffer(GL_FRAMEBUFFER, p.target.framebuffer);
  p.c.setViewport();
  const float black[4] = {0, 0, 0, 1};
  gl.ClearBufferfv(GL_COLOR, 0, black);
  gl.Disable(GL_DEPTH_TEST);
  if (const gl::Program* program = p.c.programs.find("debug_lights")) program->use();
  return lit<&LightingPass::drawAllTiles>(p);
}

struct PassRow {
  std::string_view name;
  Result<void> (*run)(PassCall&);
};
constexpr PassRow kPasses[] = {
    {"deform", deformPass},
    {"shadow_maps", shadowPass},
    {"depth_in", takeHostDepth},
    {"gbuffer", gbufferPass},
    {"forward", forwardPass},
    {"tiles", lit<&LightingPass::buildTiles>},
    {"occlusion", lit<&LightingPass::findOcclusion>},
    {"occlusion_denoise", lit<&LightingPass::denoiseOcclusion>},
    {"light_clear", lightClearPass},
    {"lighting", lit<&LightingPass::shadeTiles>},
    {"emissive", emissivePass},
    {"background", lit<&LightingPass::drawBackground>},
    {"host_draw", hostDrawPass},
    {"transparent", transparentPass},
    {"motion_vectors", motionVectorsPass},
    {"temporal_antialiasing", temporalAntialiasingPass},
    {"exposure", exposurePass},
    {"nonfinite_count", nonfiniteCountPass},
    {"bloom", bloomPass},
    {"tonemap", tonemapPass},
    {"edge_antialiasing", edgeAntialiasingPass},
    {"debug_view", debugViewPass},
    {"depth_out", giveHostDepth},
};

}  // namespace

LightingPass& Modules::lighting() {
  if (!lighting_) lighting_ = std::make_unique<LightingPass>(device_);
  return *lighting_;
}

transparency::TransparentPass& Modules::transparent() {
  if (!transparent_) transparent_ = std::make_unique<transparency::TransparentPass>(device_);
  return *transparent_;
}

shadow::ShadowPass& Modules::shadows() {
  if (!shadows_) shadows_ = std::make_unique<shadow::ShadowPass>(device_);
  return *shadows_;
}

gbuffer::MotionPass& Modules::motion() {
  if (!motion_) motion_ = std::make_unique<gbuffer::MotionPass>(device_);
  return *motion_;
}

Result<void> runPass(const PassPlan& pass, PassCall& call, gl::FrameTimers& timers) {
  const auto* row = std::find_if(std::begin(kPasses), std::end(kPasses), [&](const PassRow& r) { return r.name == pass.name; });
  if (row == std::end(kPasses)) return fail("frame plan", fmt::format("pass '{}' is unknown", pass.name), "report this as a fault of the engine");
  gl::DebugGroup group(call.c.device, pass.name);
  gl::PassTimer timer(timers, pass.name);
  return row->run(call);
}

}  // namespace burnish
