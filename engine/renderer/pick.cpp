// Renderer::pick: a frame of one pixel whose only pass draws ids.
#include <fmt/format.h>

#include "gbuffer/geometry_pass.h"
#include "renderer/impl.h"
#include "renderer/refresh.h"

namespace burnish {

using gpu_scene::FrameContext;

Result<Id<Instance>> Renderer::pick(const Scene& scene, const View& view, glm::ivec2 targetSize, glm::ivec2 pixel) {
  Impl& m = *impl_;
  Target target;
  target.size = targetSize;
  if (auto good = m.checkRequest(target, {&view, 1}); !good) return fail(good.error());
  if (scene.instances.capacity() >= (1u << 24) - 1) return fail("pick", fmt::format("the scene has {} instances and ids are exact up to {}", scene.instances.capacity(), (1u << 24) - 2), "pick in a smaller scene");
  const scene::ViewFrame whole = scene::frameOf(view, targetSize);
  const glm::ivec2 local = pixel - glm::ivec2(whole.viewport.x, whole.viewport.y);
  if (local.x < 0 || local.y < 0 || local.x >= whole.viewport.z || local.y >= whole.viewport.w) return Id<Instance>{};
  const CallState callState(*m.device, m.options.hostState);
  FramePlan plan;
  plan.targets = {{"pick", "R32UI", 1, 1, 4}, {"pick_depth", "DEPTH_COMPONENT32F", 1, 1, 4}};
  for (int key = 0; key < 4; ++key) plan.programs.push_back(plan::geometryProgram(plan::GeometryPass::Pick, {(key & 1) != 0, (key & 2) != 0, false}, false));
  SceneState& state = m.stateOf(scene);
  state.derived.update(scene, &m.report);
  plan::Seen seen;
  seen.frame = scene::narrowed(whole, local);
  scene::findVisible(scene, state.derived, seen.frame, seen.instances);
  seen.batches = scene::singles(seen.instances);  // the programs that draw ids draw one at a time
  for (const plan::DeformVariant& v : plan::factsOf(scene, {&seen, 1}, {}, {}).deformVariants) plan.programs.push_back(plan::deformProgram(v));
  gpu_scene::ProgramSet programs(*m.device, *m.programs);
  gpu_scene::TargetPool targets(*m.device);
  if (auto done = programs.prepare(plan); !done) return fail(done.error());
  if (auto done = targets.prepare(plan); !done) return fail(done.error());
  state.gpu.beginFrame(scene, 0);
  if (auto done = state.gpu.updateMaterials(scene); !done) return fail(done.error());
  const Quality quality;
  FrameStats stats;
  FrameContext c{.device = *m.device, .plan = plan, .programs = programs, .targets = targets, .gpuScene = state.gpu, .buffers = m.pictures->buffers, .scene = scene, .quality = quality, .view = seen.frame,
                 .visible = seen.instances, .batches = seen.batches, .lights = seen.lights, .size = {1, 1}, .report = m.report, .stats = stats};
  if (auto done = gpu_scene::uploadFrameData(c, 1); !done) return fail(done.error());
  if (auto done = gpu_scene::uploadDraws(c); !done) return fail(done.error());
  if (auto done = gpu_scene::deform(c, seen.instances); !done) return fail(done.error());
  auto framebuffer = targets.framebuffer({"pick"}, "pick_depth");
  if (!framebuffer) return fail(framebuffer.error());
  m.device->gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  c.setViewport();
  const GLuint nothing[4] = {};
  const float far = 0;
  m.device->gl.ClearNamedFramebufferuiv(*framebuffer, GL_COLOR, 0, nothing);
  m.device->gl.ClearNamedFramebufferfv(*framebuffer, GL_DEPTH, 0, &far);
  if (auto done = gbuffer::drawPick(c); !done) return fail(done.error());
  GLuint found = 0;
  m.device->gl.GetTextureSubImage(targets.texture("pick")->id(), 0, 0, 0, 0, 1, 1, 1, GL_RED_INTEGER, GL_UNSIGNED_INT, sizeof found, &found);
  return found == 0 ? Id<Instance>{} : scene.instances.at(found - 1);
}

}  // namespace burnish
