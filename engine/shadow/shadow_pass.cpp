#include "shadow/shadow_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace burnish::shadow {
namespace {

using gpu_scene::FrameContext;
using gpu_scene::GpuMesh;

const Material& materialOf(const FrameContext& c, const scene::ShadowCaster& caster) {
  static const Material kDefault;
  const Material* m = c.scene.materials.get(caster.placed.instance->material);
  return m ? *m : kDefault;
}

// As the other passes ask for it, so that one upload serves all.
const GpuMesh* meshOf(FrameContext& c, const scene::ShadowCaster& caster) {
  return c.gpuScene.mesh(c.scene, caster.placed.instance->mesh, plan::wantsTangents(materialOf(c, caster)), c.report);
}

}  // namespace

int ShadowPass::freeLayer() const {
  const auto oldest = std::min_element(layers_.begin(), layers_.end(), [](const Layer& a, const Layer& b) { return a.used < b.used; });
  return int(oldest - layers_.begin());
}

std::vector<std::size_t> ShadowPass::assignLayers(FrameContext& c) {
  const gl::Texture& texture = *c.targets.texture("shadow_maps");
  if (const std::uint64_t serial = c.targets.serial("shadow_maps"); serial != texture_) {
    layers_.assign(std::size_t(texture.layers), {});
    texture_ = serial;
  }
  ++now_;
  std::vector<scene::ShadowMap>& maps = c.shadows->maps;
  for (scene::ShadowMap& map : maps) {
    const auto found = std::find_if(layers_.begin(), layers_.end(), [&](const Layer& l) { return l.content == map.content; });
    map.layer = found == layers_.end() ? -1 : int(found - layers_.begin());
    if (map.layer >= 0) found->used = now_;
  }
  std::vector<std::size_t> stale;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    if (maps[i].layer >= 0) continue;
    // Two lights may want the same picture.
    const auto twin = std::find_if(stale.begin(), stale.end(), [&](std::size_t s) { return maps[s].content == maps[i].content; });
    if (twin != stale.end()) {
      maps[i].layer = maps[*twin].layer;
      continue;
    }
    maps[i].layer = freeLayer();
    layers_[std::size_t(maps[i].layer)] = {maps[i].content, now_};
    stale.push_back(i);
  }
  return stale;
}

Result<void> ShadowPass::deformCasters(FrameContext& c, const std::vector<std::size_t>& maps) {
  std::vector<scene::VisibleInstance> posed;
  std::vector<bool> listed(c.shadows->casters.size());
  for (const std::size_t m : maps)
    for (const std::uint32_t i : c.shadows->maps[m].casters) {
      const scene::Placed& p = c.shadows->casters[i].placed;
      if (!p.pose || listed[i]) continue;
      listed[i] = true;
      scene::VisibleInstance v;
      v.id = p.id;
      v.instance = p.instance;
      v.mesh = p.mesh;
      v.pose = p.pose;
      posed.push_back(v);
    }
  return posed.empty() ? Result<void>{} : gpu_scene::deform(c, posed);
}

ShadowPass::Drawing ShadowPass::prepare(FrameContext& c, std::size_t index) {
  const scene::ShadowMap& map = c.shadows->maps[index];
  struct Key {
    const Mesh* mesh;
    const scene::Pose* pose;
    std::uint32_t material;  ///< counts where there are holes
    auto operator<=>(const Key&) const = default;
  };
  std::map<Key, std::vector<std::uint32_t>> same;
  for (const std::uint32_t i : map.casters) {
    const scene::ShadowCaster& caster = c.shadows->casters[i];
    same[{caster.placed.mesh, caster.placed.pose, caster.cutout ? caster.placed.instance->material.index : ~0u}].push_back(i);
  }
  Drawing drawing{index, {}};
  for (const auto& [key, casters] : same) {
    drawing.groups.push_back({casters.front(), std::uint32_t(matrices_.size()), std::uint32_t(casters.size())});
    for (const std::uint32_t i : casters) {
      glm::dmat4 world = c.shadows->casters[i].placed.placement;
      world[3] -= glm::dvec4(map.origin, 0);
      matrices_.emplace_back(map.clip * world);
    }
  }
  return drawing;
}

const gl::VertexArray& ShadowPass::array(plan::ShadowVariant v) {
  gl::VertexArray& made = arrays_[v.general ? 2 : v.alphaTest ? 1 : 0];
  if (made) return made;
  std::vector<gl::VertexAttribute> attributes = {{ATTRIBUTE_POSITION, 3, GL_FLOAT, false, false, 0, 0}};
  if (v.alphaTest) attributes.push_back({ATTRIBUTE_UV0, 2, GL_FLOAT, false, false, 28, 0});
  if (v.general) {
    attributes.push_back({ATTRIBUTE_UV1, 2, GL_FLOAT, false, false, 0, 1});
    attributes.push_back({ATTRIBUTE_COLOR, 4, GL_UNSIGNED_SHORT, true, false, 8, 1});
  }
  for (GLuint k = 0; k < 4; ++k) attributes.push_back({ATTRIBUTE_DRAW + k, 4, GL_FLOAT, false, false, 16 * k, gpu_scene::kDrawBinding});
  made = gl::VertexArray::create(device_, attributes, {}, 0, fmt::format("casters{}{}", v.general ? ", general" : "", v.alphaTest ? ", with holes" : ""));
  return made;
}

Result<void> ShadowPass::drawGroup(FrameContext& c, const Group& group, const gl::Program*& used) {
  const scene::ShadowCaster& caster = c.shadows->casters[group.caster];
  const GpuMesh* mesh = meshOf(c, caster);
  const GLuint vertices = !mesh ? 0 : caster.placed.pose ? c.gpuScene.deformation().vertices(caster.placed.id, mesh->serial) : mesh->vertices.id();
  if (!vertices) return {};
  const plan::ShadowVariant variant = plan::shadowVariantOf(materialOf(c, caster), *caster.placed.mesh);
  const std::string name = plan::shadowProgram(variant).name;
  const gl::Program* program = c.programs.find(name);
  if (!program) return fail("frame plan", fmt::format("program '{}' is not in it", name), "report this as a fault of the engine");
  const GladGLContext& gl = device_.gl;
  const gl::VertexArray& vertexArray = array(variant);
  if (program != used) {
    program->use();
    vertexArray.bind();
    gl.VertexArrayVertexBuffer(vertexArray.id(), gpu_scene::kDrawBinding, buffer_.id(), 0, sizeof(glm::mat4));
    gl.VertexArrayBindingDivisor(vertexArray.id(), gpu_scene::kDrawBinding, 1);
    used = program;
  }
  gl.VertexArrayVertexBuffer(vertexArray.id(), 0, vertices, 0, GpuMesh::kStride);
  if (variant.general) gl.VertexArrayVertexBuffer(vertexArray.id(), 1, mesh->extras ? mesh->extras.id() : mesh->vertices.id(), 0, mesh->extras ? GpuMesh::kExtraStride : GpuMesh::kStride);
  gl.VertexArrayElementBuffer(vertexArray.id(), mesh->indices.id());
  if (variant.alphaTest) {
    const gpu_scene::MaterialBinding& m = c.gpuScene.material(c.scene, caster.placed.instance->material, c.report);
    c.gpuScene.materials().bindRange(GL_UNIFORM_BUFFER, BINDING_MATERIAL, m.offset, sizeof(gpu_scene::MaterialData));
    gl.BindTextureUnit(UNIT_MAP_C, m.texture[UNIT_MAP_C]);
    gl.BindSampler(UNIT_MAP_C, m.sampler[UNIT_MAP_C]);
    if (variant.general) gl.ProgramUniform1f(program->id(), 0, caster.placed.mesh->colors.empty() ? 0.0f : 1.0f);
  }
  gl.DrawElementsInstancedBaseInstance(GL_TRIANGLES, mesh->indexCount, mesh->indexType, nullptr, GLsizei(group.count), group.first);
  ++c.stats.shadowDraws;
  return {};
}

Result<void> ShadowPass::drawMap(FrameContext& c, const Drawing& drawing) {
  const scene::ShadowMap& map = c.shadows->maps[drawing.map];
  auto framebuffer = c.targets.layerFramebuffer("shadow_maps", map.layer);
  if (!framebuffer) return fail(framebuffer.error());
  const GladGLContext& gl = device_.gl;
  const float far = 0;
  gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  gl.ClearNamedFramebufferfv(*framebuffer, GL_DEPTH, 0, &far);
  const gl::Program* used = nullptr;
  for (const Group& group : drawing.groups)
    if (auto drawn = drawGroup(c, group, used); !drawn) return drawn;
  ++c.stats.shadowMapsDrawn;
  return {};
}

Result<void> ShadowPass::draw(FrameContext& c) {
  const std::vector<std::size_t> stale = assignLayers(c);
  c.stats.shadowMapsKept += int(c.shadows->maps.size() - stale.size());
  if (!stale.empty()) {
    if (auto deformed = deformCasters(c, stale); !deformed) return deformed;
    matrices_.clear();
    std::vector<Drawing> drawings;
    for (const std::size_t map : stale) drawings.push_back(prepare(c, map));
    if (!buffer_) {
      auto made = gl::Buffer::create(device_, gl::BufferUse::Stream, sizeof(glm::mat4), nullptr, "casters");
      if (!made) return fail(made.error());
      buffer_ = std::move(*made);
    }
    if (auto written = buffer_.write(std::as_bytes(std::span(matrices_))); !written) return written;
    const GladGLContext& gl = device_.gl;
    const int side = c.targets.texture("shadow_maps")->width;
    gl.Viewport(0, 0, side, side);
    gl.Disable(GL_SCISSOR_TEST);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthMask(GL_TRUE);
    gl.DepthFunc(GL_GREATER);
    // Surfaces are drawn from both sides: what faces away from a light keeps it off as well. Away from the light by one texel's slope; the rest of the bias is the receiver's
    // (interface/shadow.glsl).
    gl.Enable(GL_POLYGON_OFFSET_FILL);
    gl.PolygonOffset(-1, -2);
    Result<void> done;
    for (const Drawing& d : drawings)
      if (done = drawMap(c, d); !done) break;
    gl.PolygonOffset(0, 0);
    gl.Disable(GL_POLYGON_OFFSET_FILL);
    if (!done) return done;
    // Meshes and textures that wait for their turn are in the next frame's picture.
    if (c.gpuScene.pending() > 0)
      for (const std::size_t map : stale) layers_[std::size_t(c.shadows->maps[map].layer)].content = 0;
  }
  return gpu_scene::uploadShadows(c);
}

}  // namespace burnish::shadow
