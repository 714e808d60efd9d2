#include "gbuffer/geometry_pass.h"

#include <fmt/format.h>

#include <map>

namespace burnish::gbuffer {
namespace {

using gpu_scene::FrameContext;

const Material& materialOf(const FrameContext& c, const scene::VisibleInstance& v) {
  static const Material kDefault;
  const Material* m = c.scene.materials.get(v.instance->material);
  return m ? *m : kDefault;
}

// Sets face culling and winding only when they change.
class RasterState {
 public:
  explicit RasterState(const GladGLContext& gl) : gl_(gl) {
    gl_.Enable(GL_CULL_FACE);
    gl_.FrontFace(GL_CCW);
  }
  // A mirrored instance may come last: the screen triangles of the passes that follow must not be culled.
  ~RasterState() {
    gl_.Disable(GL_CULL_FACE);
    gl_.FrontFace(GL_CCW);
  }
  RasterState(const RasterState&) = delete;
  RasterState& operator=(const RasterState&) = delete;
  void set(bool twoSided, bool flipped) {
    if (twoSided != twoSided_) twoSided ? gl_.Disable(GL_CULL_FACE) : gl_.Enable(GL_CULL_FACE);
    if (flipped != flipped_) gl_.FrontFace(flipped ? GL_CW : GL_CCW);
    twoSided_ = twoSided;
    flipped_ = flipped;
  }

 private:
  const GladGLContext& gl_;
  bool twoSided_ = false, flipped_ = false;
};

// What the pass "transparent" does not draw.
struct Opaque {
  explicit Opaque(const FrameContext& c) : blend(c.plan.on("alpha_blend")), glass(c.plan.on("glass")) {}
  bool operator()(const Material& m) const { return !plan::drawnTransparent(m, blend, glass); }
  bool blend, glass;
};

// The pass's program of each variant: looked up once.
class Programs {
 public:
  Programs(FrameContext& c, plan::GeometryPass pass, bool occlusionTarget)
      : c_(c), pass_(pass), occlusionTarget_(occlusionTarget), lighting_{int(c.lights.directional.size()), c.plan.on("environment_lighting"), c.plan.on("baked_occlusion"), c.view.orthographic, -1, c.plan.on("fog")} {}
  Result<const gl::Program*> of(const plan::GeometryVariant& v) {
    const gl::Program*& program = found_[v];
    if (program) return program;
    const std::string name = nameOf(v);
    program = c_.programs.find(name);
    if (!program) return fail("frame plan", fmt::format("program '{}' is not in it", name), "report this as a fault of the engine");
    return program;
  }

 private:
  [[nodiscard]] std::string nameOf(const plan::GeometryVariant& v) const {
    if (pass_ == plan::GeometryPass::Forward) return plan::forwardProgram(v, c_.quality, lighting_).name;
    if (pass_ == plan::GeometryPass::Emissive) return plan::emissiveProgram(v, c_.quality, lighting_).name;
    return plan::geometryProgram(pass_, v, occlusionTarget_).name;
  }

  FrameContext& c_;
  plan::GeometryPass pass_;
  bool occlusionTarget_;
  plan::LightingVariant lighting_;
  std::map<plan::GeometryVariant, const gl::Program*> found_;
};

// Draws every batch that `wants`, with the pass's program for its variant; `before` runs once it is bound.
template <class Wants, class Before>
Result<void> drawInstances(FrameContext& c, plan::GeometryPass pass, bool occlusionTarget, Wants&& wants, Before&& before) {
  const GladGLContext& gl = c.device.gl;
  RasterState raster(gl);
  Programs programs(c, pass, occlusionTarget);
  const gl::Program* used = nullptr;
  gpu_scene::BoundInstance bound;
  const bool counted = pass == plan::GeometryPass::GBuffer || pass == plan::GeometryPass::Forward;
  for (const scene::Batch& batch : c.batches) {
    const scene::VisibleInstance& v = c.visible[batch.first];
    const Material& material = materialOf(c, v);
    if (!wants(material)) continue;
    plan::GeometryVariant variant = plan::variantOf(material, *v.mesh);
    variant.instanced = batch.count > 1;
    if (!occlusionTarget) variant.occlusionMap = false;
    auto program = programs.of(variant);
    if (!program) return fail(program.error());
    if (!(variant.instanced ? gpu_scene::bindInstances(c, batch, variant.general, bound) : gpu_scene::bindInstance(c, batch.first, variant.general, bound))) continue;
    if (*program != used) (used = *program)->use();
    raster.set(material.twoSided, v.flipped);
    before(material);
    if (variant.instanced)
      gl.DrawElementsInstanced(GL_TRIANGLES, bound.mesh->indexCount, bound.mesh->indexType, nullptr, GLsizei(batch.count));
    else
      gl.DrawElements(GL_TRIANGLES, bound.mesh->indexCount, bound.mesh->indexType, nullptr);
    if (!counted) continue;
    ++c.stats.draws;
    c.stats.triangles += std::uint64_t(bound.mesh->indexCount) / 3 * batch.count;
  }
  return {};
}

}  // namespace

Result<void> drawGBuffer(FrameContext& c) {
  const GladGLContext& gl = c.device.gl;
  const bool occlusion = c.plan.on("baked_occlusion");
  auto framebuffer = occlusion ? c.targets.framebuffer({"gbuffer_a", "gbuffer_b", "gbuffer_c"}, "depth") : c.targets.framebuffer({"gbuffer_a", "gbuffer_b"}, "depth");
  if (!framebuffer) return fail(framebuffer.error());
  gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  c.setViewport();
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthMask(GL_TRUE);
  gl.DepthFunc(GL_GREATER);
  if (c.plan.on("host_depth_in")) {
    // All ones is no normal that packNormal makes: it marks the host's pixels. Depth holds the host's already.
    const float marker[4] = {1, 1, 1, 1};
    gl.ClearNamedFramebufferfv(*framebuffer, GL_COLOR, 1, marker);
  } else {
    const float far = 0;
    gl.ClearNamedFramebufferfv(*framebuffer, GL_DEPTH, 0, &far);
  }
  return drawInstances(c, plan::GeometryPass::GBuffer, occlusion, Opaque(c), [](const Material&) {});
}

Result<void> drawForward(FrameContext& c) {
  const GladGLContext& gl = c.device.gl;
  auto framebuffer = c.targets.framebuffer({"light"}, "depth");
  if (!framebuffer) return fail(framebuffer.error());
  gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  c.setViewport();
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthMask(GL_TRUE);
  gl.DepthFunc(GL_GREATER);
  const float black[4] = {0, 0, 0, 1}, far = 0;
  gl.ClearNamedFramebufferfv(*framebuffer, GL_COLOR, 0, black);
  if (!c.plan.on("host_depth_in")) gl.ClearNamedFramebufferfv(*framebuffer, GL_DEPTH, 0, &far);
  return drawInstances(c, plan::GeometryPass::Forward, c.plan.on("baked_occlusion"), Opaque(c), [](const Material&) {});
}

Result<void> drawEmissive(FrameContext& c) {
  const GladGLContext& gl = c.device.gl;
  auto framebuffer = c.targets.framebuffer({"light"}, "depth");
  if (!framebuffer) return fail(framebuffer.error());
  gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  c.setViewport();
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthMask(GL_FALSE);
  gl.DepthFunc(GL_EQUAL);
  gl.Enable(GL_BLEND);
  auto result = drawInstances(c, plan::GeometryPass::Emissive, false, [opaque = Opaque(c)](const Material& m) { return plan::emits(m) && opaque(m); },
                              [&gl](const Material& m) { gl.BlendFunc(GL_ONE, m.unlit ? GL_ZERO : GL_ONE); });
  gl.Disable(GL_BLEND);
  gl.DepthMask(GL_TRUE);
  return result;
}

Result<void> drawPick(FrameContext& c) {
  const GladGLContext& gl = c.device.gl;
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthMask(GL_TRUE);
  gl.DepthFunc(GL_GREATER);
  return drawInstances(c, plan::GeometryPass::Pick, false, [](const Material&) { return true; }, [](const Material&) {});
}

}  // namespace burnish::gbuffer
