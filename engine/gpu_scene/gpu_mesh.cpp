// Meshes: validated, packed into the vertex format, uploaded.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "gpu_scene/gpu_scene.h"
#include "scene/tangents.h"

namespace burnish::gpu_scene {
namespace {

struct Vertex {
  glm::vec3 position;
  std::int16_t normal[4], tangent[4];
  glm::vec2 uv;
};
static_assert(sizeof(Vertex) == GpuMesh::kStride);
struct Extra {
  glm::vec2 uv;
  std::uint16_t color[4];
};
static_assert(sizeof(Extra) == GpuMesh::kExtraStride);

std::int16_t snorm(float f) { return std::int16_t(std::lround(std::clamp(f, -1.0f, 1.0f) * 32767.0f)); }

std::vector<Vertex> packVertices(const Mesh& mesh) {
  std::vector<Vertex> out(mesh.positions.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    Vertex& v = out[i];
    v = {};
    v.position = mesh.positions[i];
    if (!mesh.normals.empty())
      for (int c = 0; c < 3; ++c) v.normal[c] = snorm(mesh.normals[i][c]);
    if (!mesh.tangents.empty())
      for (int c = 0; c < 4; ++c) v.tangent[c] = snorm(mesh.tangents[i][c]);
    if (!mesh.uv0.empty()) v.uv = mesh.uv0[i];
  }
  return out;
}

std::vector<Extra> packExtras(const Mesh& mesh) {
  std::vector<Extra> out(mesh.positions.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].uv = mesh.uv1.empty() ? glm::vec2(0) : mesh.uv1[i];
    const glm::vec4 color = mesh.colors.empty() ? glm::vec4(1) : glm::clamp(mesh.colors[i], glm::vec4(0), glm::vec4(1));
    for (int c = 0; c < 4; ++c) out[i].color[c] = std::uint16_t(std::lround(color[c] * 65535.0f));
  }
  return out;
}

Result<std::unique_ptr<GpuMesh>> uploadMesh(gl::Device& device, const Mesh& mesh) {
  auto gpu = std::make_unique<GpuMesh>();
  const std::string label = fmt::format("mesh {}", mesh.name);
  const std::vector<Vertex> vertices = packVertices(mesh);
  auto vertexBuffer = gl::Buffer::create(device, gl::BufferUse::Static, std::span<const Vertex>(vertices), label);
  if (!vertexBuffer) return fail(vertexBuffer.error());
  gpu->vertices = std::move(*vertexBuffer);
  if (!mesh.uv1.empty() || !mesh.colors.empty()) {
    const std::vector<Extra> extras = packExtras(mesh);
    auto buffer = gl::Buffer::create(device, gl::BufferUse::Static, std::span<const Extra>(extras), label);
    if (!buffer) return fail(buffer.error());
    gpu->extras = std::move(*buffer);
  }
  gpu->vertexCount = int(vertices.size());
  gpu->indexCount = int(mesh.indices.size());
  gpu->parts = partsOf(mesh);
  Result<gl::Buffer> indexBuffer;
  if (mesh.positions.size() <= 65535) {
    const std::vector<std::uint16_t> small(mesh.indices.begin(), mesh.indices.end());
    indexBuffer = gl::Buffer::create(device, gl::BufferUse::Static, std::span<const std::uint16_t>(small), label);
  } else {
    gpu->indexType = GL_UNSIGNED_INT;
    indexBuffer = gl::Buffer::create(device, gl::BufferUse::Static, std::span<const std::uint32_t>(mesh.indices), label);
  }
  if (!indexBuffer) return fail(indexBuffer.error());
  gpu->indices = std::move(*indexBuffer);
  return gpu;
}

}  // namespace

const GpuMesh* GpuScene::mesh(const Scene& scene, Id<Mesh> id, bool tangents, Report& report) {
  const Mesh* m = scene.meshes.get(id);
  if (!m) return nullptr;
  MeshRow& row = meshes_[id.index];
  const bool lacking = tangents && row.mesh && !row.mesh->tangents && !m->uv0.empty();
  if (row.revision == scene.meshes.revision(id) && !lacking) return row.mesh.get();
  if (!admit(m->positions.size() * (GpuMesh::kStride + (m->uv1.empty() && m->colors.empty() ? 0 : GpuMesh::kExtraStride)) + m->indices.size() * 4)) return nullptr;
  row = {scene.meshes.revision(id), id.generation, nullptr};
  Result<Mesh> valid = scene::preparedMesh(*m, tangents, report);
  if (!valid) {
    report.warn(valid.error().place, valid.error().what + ": it is not drawn");
    return nullptr;
  }
  if (valid->indices.empty()) return nullptr;
  auto uploaded = uploadMesh(device_, *valid);
  if (!uploaded) {
    report.warn(uploaded.error().place, uploaded.error().what + ": it is not drawn");
    return nullptr;
  }
  row.mesh = std::move(*uploaded);
  row.mesh->tangents = tangents || !m->tangents.empty();
  row.mesh->madeTangents = tangents;
  row.mesh->serial = ++meshSerial_;
  return row.mesh.get();
}

}  // namespace burnish::gpu_scene
