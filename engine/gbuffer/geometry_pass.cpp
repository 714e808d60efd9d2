#include "gbuffer/geometry_pass.h"

#include <fmt/format.h>

#include <map>

#include "gbuffer/raster_state.h"

namespace burnish::gbuffer {
namespace {

using gpu_scene::FrameContext;

const Material& materialOf(const FrameContext& c, const scene::VisibleInstance& v) {
  static const Material kDefault;
  const Material* m = c.scene.materials.get(v.instance->material);
  return m ? *m : kDefault;
}

// What the pass "transparent" does not draw.
struct Opaque {
  explicit Opaque(const FrameContext& c) : blend(c.plan.on("alpha_blend")), glass(c.plan.on("glass")) {}
  bool operator()(const Material& m) const { return !plan::drawnTransparent(m, blend, glass); }
  bool blend, glass;
};

/// Surfaces that write the target of details, or those that do not: the two are drawn apart, so that the others are spared it.
enum class Share : std::uint8_t { All, Plain, Detailed };

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

// Finds the runs of a large rigid mesh that are in view. Returns whether it is drawn by runs.
bool findRuns(FrameContext& c, const scene::Frustum& frustum, scene::Batch batch, gpu_scene::PartRuns& runs) {
  const scene::VisibleInstance& v = c.visible[batch.first];
  if (batch.count > 1 || v.pose) return false;
  const gpu_scene::GpuMesh* mesh = gpu_scene::meshOf(c, batch.first);
  if (!mesh || mesh->parts.empty()) return false;
  runs.find(frustum, v, mesh->parts, mesh->indexCount, mesh->indexType == GL_UNSIGNED_INT ? 4 : 2);
  return true;
}

// Draws every batch that `wants`, with the pass's program for its variant; `before` runs once it is bound.
template <class Wants, class Before>
Result<void> drawInstances(FrameContext& c, plan::GeometryPass pass, bool occlusionTarget, Share share, Wants&& wants, Before&& before) {
  const GladGLContext& gl = c.device.gl;
  RasterState raster(gl);
  Programs programs(c, pass, occlusionTarget);
  const gl::Program* used = nullptr;
  gpu_scene::BoundInstance bound;
  gpu_scene::PartRuns runs;
  const scene::Frustum frustum(c.view);
  const plan::Details details = pass == plan::GeometryPass::GBuffer || pass == plan::GeometryPass::Forward ? plan::detailsOf(c.plan) : plan::Details{false, false};
  const bool counted = pass == plan::GeometryPass::GBuffer || pass == plan::GeometryPass::Forward;
  for (const scene::Batch& batch : c.batches) {
    const scene::VisibleInstance& v = c.visible[batch.first];
    const Material& material = materialOf(c, v);
    if (!wants(material)) continue;
    plan::GeometryVariant variant = plan::variantOf(material, *v.mesh, details);
    variant.instanced = batch.count > 1;
    if (!occlusionTarget) variant.occlusionMap = false;
    if (share != Share::All && variant.detail() != (share == Share::Detailed)) continue;
    auto program = programs.of(variant);
    if (!program) return fail(program.error());
    const bool byRuns = findRuns(c, frustum, batch, runs);
    if (byRuns && runs.size() == 0) continue;
    if (!(variant.instanced ? gpu_scene::bindInstances(c, batch, variant.general, bound) : gpu_scene::bindInstance(c, batch.first, variant.general, bound))) continue;
    if (*program != used) (used = *program)->use();
    raster.set(material.twoSided, v.flipped);
    before(material);
    if (variant.instanced)
      gl.DrawElementsInstanced(GL_TRIANGLES, bound.mesh->indexCount, bound.mesh->indexType, nullptr, GLsizei(batch.count));
    else if (!byRuns)
      gl.DrawElements(GL_TRIANGLES, bound.mesh->indexCount, bound.mesh->indexType, nullptr);
    else if (runs.size() == 1)
      gl.DrawElements(GL_TRIANGLES, runs.counts()[0], bound.mesh->indexType, runs.offsets()[0]);
    else
      gl.MultiDrawElements(GL_TRIANGLES, runs.counts(), bound.mesh->indexType, runs.offsets(), runs.size());
    if (!counted) continue;
    ++c.stats.draws;
    c.stats.triangles += (byRuns ? runs.indices() : std::uint64_t(bound.mesh->indexCount)) / 3 * batch.count;
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
  const auto nothing = [](const Material&) {};
  if (!c.targets.texture("gbuffer_d")) return drawInstances(c, plan::GeometryPass::GBuffer, occlusion, Share::All, Opaque(c), nothing);
  // What has no details comes first: nothing that is drawn later leaves the others' behind in its pixels.
  if (auto drawn = drawInstances(c, plan::GeometryPass::GBuffer, occlusion, Share::Plain, Opaque(c), nothing); !drawn) return drawn;
  auto detailed = c.targets.framebuffer({"gbuffer_a", "gbuffer_b", "gbuffer_c", "gbuffer_d"}, "depth");
  if (!detailed) return fail(detailed.error());
  gl.BindFramebuffer(GL_FRAMEBUFFER, *detailed);
  const float none[4] = {0, 0, 0, 0};
  gl.ClearNamedFramebufferfv(*detailed, GL_COLOR, occlusion ? 3 : 2, none);
  return drawInstances(c, plan::GeometryPass::GBuffer, occlusion, Share::Detailed, Opaque(c), nothing);
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
  return drawInstances(c, plan::GeometryPass::Forward, c.plan.on("baked_occlusion"), Share::All, Opaque(c), [](const Material&) {});
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
  auto result = drawInstances(c, plan::GeometryPass::Emissive, false, Share::All, [opaque = Opaque(c)](const Material& m) { return plan::emits(m) && opaque(m); },
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
  return drawInstances(c, plan::GeometryPass::Pick, false, Share::All, [](const Material&) { return true; }, [](const Material&) {});
}

}  // namespace burnish::gbuffer
