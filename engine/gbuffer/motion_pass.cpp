#include "gbuffer/motion_pass.h"

#include <fmt/format.h>

#include <optional>

#include "gbuffer/raster_state.h"
#include "plan/variants.h"

namespace burnish::gbuffer {
namespace {

using gpu_scene::FrameContext;
using gpu_scene::GpuMesh;

/// One instance's vertices, now and in the frame before, and where those stood.
struct Motion {
  const GpuMesh* mesh = nullptr;
  GLuint now = 0, before = 0;
  glm::dmat4 placement{1};
};

// No mesh: it is not there (yet).
Motion motionOf(FrameContext& c, const scene::Moved& moved) {
  const scene::VisibleInstance& v = c.visible[moved.visible];
  const Material* material = c.scene.materials.get(v.instance->material);
  Motion m;
  m.mesh = c.gpuScene.mesh(c.scene, v.instance->mesh, material && plan::wantsTangents(*material), c.report);
  if (!m.mesh) return m;
  m.placement = moved.placement;
  m.now = m.before = m.mesh->vertices.id();
  if (!v.pose) return m;
  // Deformed vertices of the frame before have a space of their own.
  gpu_scene::Deformation& d = c.gpuScene.deformation();
  m.now = d.vertices(v.id, m.mesh->serial);
  m.before = d.previousVertices(v.id);
  if (const glm::dmat4* placement = d.previousPlacement(v.id)) m.placement = *placement;
  if (!m.now || !m.before) m.mesh = nullptr;
  return m;
}

}  // namespace

MotionPass::MotionPass(gl::Device& device) {
  const gl::VertexAttribute attributes[] = {{ATTRIBUTE_POSITION, 3, GL_FLOAT, false, false, 0, 0}, {ATTRIBUTE_PREVIOUS, 3, GL_FLOAT, false, false, 0, 1}};
  array_ = gl::VertexArray::create(device, attributes, {}, 0, "vertices now and before");
}

Result<void> MotionPass::draw(FrameContext& c) {
  const GladGLContext& gl = c.device.gl;
  auto framebuffer = c.targets.framebuffer({"velocity"}, "depth");
  if (!framebuffer) return fail(framebuffer.error());
  c.setViewport();
  const float nothing[4] = {};
  gl.ClearNamedFramebufferfv(*framebuffer, GL_COLOR, 0, nothing);
  // In the view's first frame nothing has a past.
  if (!c.past.valid) return {};
  const std::string name = c.view.orthographic ? "motion_vectors+ortho" : "motion_vectors";
  const gl::Program* program = c.programs.find(name);
  if (!program) return fail("frame plan", fmt::format("program '{}' is not in it", name), "report this as a fault of the engine");
  const scene::ViewFrame& then = c.past.frame;
  const glm::dmat4 clip = scene::withoutJitter(then);
  std::optional<RasterState> raster;  // once something is drawn
  for (const scene::Moved& moved : c.moved) {
    const scene::VisibleInstance& v = c.visible[moved.visible];
    const Material* material = c.scene.materials.get(v.instance->material);
    if (material && plan::drawnTransparent(*material, c.plan.on("alpha_blend"), c.plan.on("glass"))) continue;
    const Motion m = motionOf(c, moved);
    if (!m.mesh) continue;
    if (!raster) {
      gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
      program->use();
      array_.bind();
      gl.Enable(GL_DEPTH_TEST);
      gl.DepthMask(GL_FALSE);
      gl.DepthFunc(GL_EQUAL);
      gl.ProgramUniform4f(program->id(), 4, float(c.view.jitter.x), float(c.view.jitter.y), float(then.depthParams.x), float(then.depthParams.y));
      raster.emplace(gl);
    }
    glm::dmat4 placement = m.placement;
    placement[3] -= glm::dvec4(then.eye, 0);
    const glm::mat4 previous(clip * placement);
    gl.ProgramUniformMatrix4fv(program->id(), 0, 1, GL_FALSE, &previous[0][0]);
    gl.VertexArrayVertexBuffer(array_.id(), 0, m.now, 0, GpuMesh::kStride);
    gl.VertexArrayVertexBuffer(array_.id(), 1, m.before, 0, GpuMesh::kStride);
    gl.VertexArrayElementBuffer(array_.id(), m.mesh->indices.id());
    c.buffers.draws.bindRange(GL_UNIFORM_BUFFER, BINDING_DRAW, moved.visible * c.buffers.drawStride, sizeof(gpu_scene::DrawData));
    raster->set(material && material->twoSided, v.flipped);
    gl.DrawElements(GL_TRIANGLES, m.mesh->indexCount, m.mesh->indexType, nullptr);
  }
  gl.DepthMask(GL_TRUE);
  return {};
}

}  // namespace burnish::gbuffer
