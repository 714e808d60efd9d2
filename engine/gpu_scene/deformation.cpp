#include "gpu_scene/deformation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "gpu_scene/frame.h"
#include "plan/variants.h"
#include "scene/tangents.h"

namespace burnish::gpu_scene {
namespace {

std::vector<std::uint32_t> packJoints(const Mesh& mesh) {
  std::vector<std::uint32_t> out(mesh.positions.size() * 6);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::u16vec4 j = mesh.joints[v];
    out[6 * v] = std::uint32_t(j.x) | std::uint32_t(j.y) << 16;
    out[6 * v + 1] = std::uint32_t(j.z) | std::uint32_t(j.w) << 16;
    std::memcpy(&out[6 * v + 2], &mesh.weights[v], sizeof(glm::vec4));
  }
  return out;
}

int wordsOf(const Mesh& mesh) {
  int words = 3;
  for (const MorphTarget& t : mesh.targets) words = std::max(words, !t.tangents.empty() && !mesh.tangents.empty() ? 9 : !t.normals.empty() ? 6 : 3);
  return words;
}

std::vector<float> packTargets(const Mesh& mesh, int words) {
  std::vector<float> out;
  out.reserve(mesh.targets.size() * mesh.positions.size() * std::size_t(words));
  const auto push = [&out](const std::vector<glm::vec3>& stream, std::size_t v) {
    const glm::vec3 d = stream.empty() ? glm::vec3(0) : stream[v];
    out.insert(out.end(), {d.x, d.y, d.z});
  };
  for (const MorphTarget& t : mesh.targets)
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      push(t.positions, v);
      if (words > 3) push(t.normals, v);
      if (words > 6) push(t.tangents, v);
    }
  return out;
}

Result<void> fill(gl::Device& device, const Mesh& mesh, DeformSource& source) {
  const std::string label = fmt::format("deformation of mesh {}", mesh.name);
  if (!mesh.joints.empty()) {
    auto made = gl::Buffer::create(device, gl::BufferUse::Static, std::span<const std::uint32_t>(packJoints(mesh)), label);
    if (!made) return fail(made.error());
    source.joints = std::move(*made);
  }
  if (mesh.targets.empty()) return {};
  source.words = wordsOf(mesh);
  if (const std::uint64_t bytes = std::uint64_t(mesh.targets.size()) * mesh.positions.size() * std::uint64_t(source.words) * 4; bytes > std::uint64_t(device.caps.maxStorageBlockBytes) || bytes / 4 > 0x7fffffff)
    return fail(label, fmt::format("its morph targets take {} bytes, more than the device reads at once", bytes), "split the mesh or give it fewer targets");
  auto made = gl::Buffer::create(device, gl::BufferUse::Static, std::span<const float>(packTargets(mesh, source.words)), label);
  if (!made) return fail(made.error());
  source.targets = std::move(*made);
  return {};
}

void appendPose(const scene::Pose& pose, std::vector<glm::vec4>& texels) {
  for (const auto& [target, weight] : pose.targets) texels.emplace_back(float(target), weight, 0, 0);
  for (const glm::mat4& m : pose.joints)
    for (int row = 0; row < 3; ++row) texels.emplace_back(m[0][row], m[1][row], m[2][row], m[3][row]);
}

bool wantsTangents(const Scene& scene, const Instance& instance) {
  const Material* material = scene.materials.get(instance.material);
  return material && plan::wantsTangents(*material);
}

}  // namespace

void Deformation::beginFrame(const Scene& scene, bool previous) {
  dispatches_ = 0;
  previous_ = previous;
  std::erase_if(entries_, [&](const auto& e) {
    const Id<Instance> id = scene.instances.at(e.first);
    return !id || id.generation != e.second.generation || e.second.idle >= kIdleFrames;
  });
  for (auto& [index, entry] : entries_) {
    ++entry.idle;
    entry.moved = false;
    entry.lastPlacement = entry.pose.placement;
    if (!previous) entry.last = {};
  }
  std::erase_if(sources_, [&](const auto& s) { return !scene.meshes.at(s.first); });
}

const Deformation::Entry* Deformation::find(Id<Instance> id) const {
  const auto found = entries_.find(id.index);
  return found == entries_.end() || found->second.generation != id.generation || !found->second.current ? nullptr : &found->second;
}
GLuint Deformation::vertices(Id<Instance> id, std::uint64_t serial) const {
  const Entry* e = find(id);
  return e && e->mesh == serial ? e->current.id() : 0;
}
GLuint Deformation::previousVertices(Id<Instance> id) const {
  const Entry* e = find(id);
  return !e ? 0 : e->moved && e->last ? e->last.id() : e->current.id();
}
const glm::dmat4* Deformation::previousPlacement(Id<Instance> id) const {
  const Entry* e = find(id);
  return e ? &e->lastPlacement : nullptr;
}

// nullptr while it waits for its turn or cannot be made.
const DeformSource* Deformation::sourceOf(FrameContext& c, const scene::VisibleInstance& v, const GpuMesh& mesh) {
  std::unique_ptr<DeformSource>& source = sources_[v.instance->mesh.index];
  if (source && source->mesh == mesh.serial) return source->good ? source.get() : nullptr;
  const std::uint64_t words = (v.mesh->joints.empty() ? 0 : 6) + 9 * std::uint64_t(v.mesh->targets.size());
  if (!c.gpuScene.admit(std::uint64_t(mesh.vertexCount) * words * 4)) return nullptr;
  source = std::make_unique<DeformSource>();
  source->mesh = mesh.serial;
  Report known;  // the mesh was validated when its vertices were uploaded
  const Result<Mesh> valid = scene::preparedMesh(*v.mesh, mesh.madeTangents, known);
  if (const Result<void> filled = valid ? fill(c.device, *valid, *source) : fail(valid.error()); filled)
    source->good = true;
  else
    c.report.warn(filled.error().place, filled.error().what + ": its deformed instances are not drawn");
  return source->good ? source.get() : nullptr;
}

// Whether the instance's vertices have to be computed; its buffers are there then.
bool Deformation::prepare(FrameContext& c, const scene::VisibleInstance& v, const GpuMesh& mesh) {
  Entry& e = entries_[v.id.index];
  const bool fits = e.current && e.generation == v.id.generation && e.mesh == mesh.serial;
  if (!fits) e = Entry{.generation = v.id.generation, .mesh = mesh.serial, .lastPlacement = v.pose->placement};
  e.idle = 0;
  const bool same = fits && e.pose.sameShape(*v.pose);
  e.pose.placement = v.pose->placement;
  if (same) return false;
  if (fits && previous_ && !e.moved) {
    std::swap(e.current, e.last);
    e.moved = true;
  }
  if (!e.current) {
    auto made = gl::Buffer::create(c.device, gl::BufferUse::Dynamic, std::size_t(mesh.vertexCount) * GpuMesh::kStride, nullptr, fmt::format("deformed {}", v.instance->name));
    if (!made) {
      c.report.warn(made.error().place, made.error().what + ": it is not drawn");
      return false;
    }
    e.current = std::move(*made);
  }
  e.pose = *v.pose;
  return true;
}

namespace {

struct Job {
  const scene::VisibleInstance* instance = nullptr;
  const GpuMesh* mesh = nullptr;
  const DeformSource* source = nullptr;
  int texel = 0;  ///< of its pose
};

Result<void> dispatch(FrameContext& c, const Job& job) {
  const GladGLContext& gl = c.device.gl;
  const scene::Pose& pose = *job.instance->pose;
  const std::string name = plan::deformProgram({pose.skinned, pose.morphed}).name;
  const gl::Program* program = c.programs.find(name);
  if (!program) return fail("frame plan", fmt::format("program '{}' is not in it", name), "report this as a fault of the engine");
  program->use();
  job.mesh->vertices.bindBase(GL_SHADER_STORAGE_BUFFER, STORAGE_DEFORM_SOURCE);
  gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, STORAGE_DEFORM_RESULT, c.gpuScene.deformation().vertices(job.instance->id, job.mesh->serial));
  if (pose.skinned) job.source->joints.bindBase(GL_SHADER_STORAGE_BUFFER, STORAGE_DEFORM_JOINTS);
  if (pose.morphed) job.source->targets.bindBase(GL_SHADER_STORAGE_BUFFER, STORAGE_DEFORM_TARGETS);
  gl.ProgramUniform4i(program->id(), 0, job.mesh->vertexCount, job.texel, int(pose.targets.size()), job.source->words);
  // GL 4.5 promises 65535 groups along an axis.
  const int groups = (job.mesh->vertexCount + DEFORM_GROUP - 1) / DEFORM_GROUP, wide = std::min(groups, 65535);
  gl.DispatchCompute(GLuint(wide), GLuint((groups + wide - 1) / wide), 1);
  return {};
}

}  // namespace

Result<void> deform(FrameContext& c, std::span<const scene::VisibleInstance> instances) {
  Deformation& d = c.gpuScene.deformation();
  const auto meshOf = [&c](const scene::VisibleInstance& v) { return c.gpuScene.mesh(c.scene, v.instance->mesh, wantsTangents(c.scene, *v.instance), c.report); };
  // Another material may have the mesh uploaded anew, with tangents: all that share meshes come to rest before any is deformed.
  const bool any = std::any_of(instances.begin(), instances.end(), [](const scene::VisibleInstance& v) { return v.pose; });
  if (!any) return {};
  for (const scene::VisibleInstance& v : instances)
    if (!v.mesh->joints.empty() || !v.mesh->targets.empty()) meshOf(v);
  std::vector<Job> jobs;
  std::vector<glm::vec4> texels;
  for (const scene::VisibleInstance& v : instances) {
    const GpuMesh* mesh = v.pose ? meshOf(v) : nullptr;
    const DeformSource* source = mesh ? d.sourceOf(c, v, *mesh) : nullptr;
    if (!source || !d.prepare(c, v, *mesh)) continue;
    jobs.push_back({&v, mesh, source, int(texels.size())});
    appendPose(*v.pose, texels);
  }
  if (jobs.empty()) return {};
  const std::span<const std::byte> bytes = std::as_bytes(std::span(texels));
  if (!d.pose_) {
    auto made = gl::TextureBuffer::create(c.device, GL_RGBA32F, gl::BufferUse::Stream, bytes.size(), nullptr, "poses");
    if (!made) return fail(made.error());
    d.pose_ = std::move(*made);
  }
  if (auto written = d.pose_.write(bytes); !written) return written;
  d.pose_.bind(UNIT_POSE);
  for (const Job& job : jobs)
    if (auto done = dispatch(c, job); !done) return done;
  d.dispatches_ += int(jobs.size());
  c.device.gl.MemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
  return {};
}

}  // namespace burnish::gpu_scene
