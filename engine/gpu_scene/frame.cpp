#include "gpu_scene/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "plan/variants.h"
#include "scene/fog.h"

namespace burnish::gpu_scene {

Result<void> TargetPool::prepare(const FramePlan& plan) {
  bool changed = false;
  for (auto& [name, entry] : entries_) ++entry.idle;
  for (const TargetPlan& t : plan.targets) {
    Entry& entry = entries_[t.name];
    entry.idle = 0;
    if (entry.texture && entry.plan.format == t.format && entry.plan.width == t.width && entry.plan.height == t.height && entry.plan.levels == t.levels && entry.plan.layers == t.layers) continue;
    changed = true;
    const gl::FormatInfo* format = gl::formatInfo(t.format);
    if (!format) return fail(fmt::format("target '{}'", t.name), fmt::format("unknown format {}", t.format));
    entry.texture = {};  // the old one goes first: memory may be short
    auto texture = gl::Texture::create(device_, {.target = GLenum(t.layers > 0 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D), .format = format->format, .width = t.width, .height = t.height, .layers = std::max(t.layers, 1), .levels = t.levels}, t.name);
    if (!texture) {
      framebuffers_.clear();
      return fail(texture.error());
    }
    entry.plan = t;
    entry.serial = ++made_;
    entry.texture = std::move(*texture);
  }
  changed |= std::erase_if(entries_, [](const auto& e) { return e.second.idle > kIdleFrames; }) > 0;
  if (changed) framebuffers_.clear();
  return {};
}

const gl::Texture* TargetPool::texture(std::string_view name) const {
  const auto found = entries_.find(name);
  return found == entries_.end() || found->second.idle > 0 || !found->second.texture ? nullptr : &found->second.texture;
}

std::uint64_t TargetPool::serial(std::string_view name) const { return texture(name) ? entries_.find(name)->second.serial : 0; }

Result<GLuint> TargetPool::framebuffer(std::initializer_list<std::string_view> colors, std::string_view depth) {
  // By what is there: a plan without one of the targets wants a framebuffer without it.
  std::string key(texture(depth) ? depth : std::string_view());
  for (std::string_view c : colors)
    if (texture(c)) key += fmt::format("|{}", c);
  if (const auto found = framebuffers_.find(key); found != framebuffers_.end()) return found->second.id();
  std::vector<gl::Attachment> attachments;
  for (std::string_view c : colors)
    if (const gl::Texture* t = texture(c)) attachments.emplace_back(*t);
  std::optional<gl::Attachment> depthAttachment;
  if (const gl::Texture* t = texture(depth)) depthAttachment = *t;
  auto made = gl::Framebuffer::create(device_, attachments, depthAttachment, key);
  if (!made) return fail(made.error());
  const GLuint id = made->id();
  framebuffers_.emplace(key, std::move(*made));
  return id;
}

Result<GLuint> TargetPool::layerFramebuffer(std::string_view depth, int layer) {
  const std::string key = fmt::format("{} layer {}", depth, layer);
  if (const auto found = framebuffers_.find(key); found != framebuffers_.end()) return found->second.id();
  const gl::Texture* t = texture(depth);
  if (!t) return fail("frame plan", fmt::format("target '{}' is not in it", depth), "report this as a fault of the engine");
  auto made = gl::Framebuffer::create(device_, {}, gl::Attachment(*t, 0, layer), key);
  if (!made) return fail(made.error());
  const GLuint id = made->id();
  framebuffers_.emplace(key, std::move(*made));
  return id;
}

Result<GLuint> TargetPool::levelFramebuffer(std::string_view color, int level) {
  const std::string key = fmt::format("{} level {}", color, level);
  if (const auto found = framebuffers_.find(key); found != framebuffers_.end()) return found->second.id();
  const gl::Texture* t = texture(color);
  if (!t) return fail("frame plan", fmt::format("target '{}' is not in it", color), "report this as a fault of the engine");
  const gl::Attachment attachment(*t, level);
  auto made = gl::Framebuffer::create(device_, {&attachment, 1}, std::nullopt, key);
  if (!made) return fail(made.error());
  const GLuint id = made->id();
  framebuffers_.emplace(key, std::move(*made));
  return id;
}

gl::ProgramSource sourceOf(const ProgramPlan& p) { return {p.name, p.vertex, p.fragment, p.compute, p.defines}; }

Result<void> ProgramSet::prepare(const FramePlan& plan) {
  failed_.reset();
  if (plan.programs == plan_) return {};
  programs_.clear();
  plan_.clear();
  for (const ProgramPlan& p : plan.programs) {
    if (onDemand_) break;
    auto program = cache_.get(sourceOf(p));
    if (!program) return fail(program.error());
    programs_[p.name] = *program;
  }
  plan_ = plan.programs;
  return {};
}

const gl::Program* ProgramSet::find(std::string_view name) const {
  if (const auto found = programs_.find(name); found != programs_.end()) return found->second;
  const auto planned = std::find_if(plan_.begin(), plan_.end(), [&](const ProgramPlan& p) { return p.name == name; });
  if (!onDemand_ || planned == plan_.end()) return nullptr;
  auto program = cache_.get(sourceOf(*planned));
  if (!program) {
    failed_ = program.error();
    return nullptr;
  }
  return programs_[planned->name] = *program;
}

Result<FrameBuffers> FrameBuffers::create(gl::Device& device) {
  FrameBuffers b;
  const std::size_t align = std::size_t(std::max(device.caps.uniformAlignment, 16));
  b.drawStride = (sizeof(DrawData) + align - 1) / align * align;
  auto frame = gl::Buffer::create(device, gl::BufferUse::Stream, sizeof(FrameData), nullptr, "frame data");
  if (!frame) return fail(frame.error());
  b.frame = std::move(*frame);
  return b;
}

Result<GLuint> FrameContext::lightFramebuffer(bool depth) const {
  if (!targets.texture("light")) return output;
  return depth ? targets.framebuffer({"light"}, "depth") : targets.framebuffer({"light"});
}

namespace {
void setRectangle(const gl::Device& device, glm::ivec4 v) {
  device.gl.Viewport(v.x, v.y, v.z, v.w);
  device.gl.Enable(GL_SCISSOR_TEST);
  device.gl.Scissor(v.x, v.y, v.z, v.w);
}
}  // namespace

void FrameContext::setViewport() const { setRectangle(device, view.viewport); }
void FrameContext::setTargetViewport() const { setRectangle(device, view.target); }

Result<void> FrameContext::drawScreen(std::string_view name) const {
  const gl::Program* program = programs.find(name);
  if (!program) return fail("frame plan", fmt::format("program '{}' is not in it", name), "report this as a fault of the engine");
  program->use();
  buffers.noVertices(device).bind();
  device.gl.DrawArrays(GL_TRIANGLES, 0, 3);
  return {};
}

namespace {

void fillRays(FrameData& d, const scene::ViewFrame& v) {
  const glm::dvec3 right = v.axes[0], up = v.axes[1], forward = -v.axes[2];
  const double w = v.viewport.z, h = v.viewport.w, x = v.tanX * (2 * v.jitter.x / w - 1), y = v.tanY * (2 * v.jitter.y / h - 1);
  d.rayX = vec4(glm::vec3(right * (2 * v.tanX / w)), 0);
  d.rayY = vec4(glm::vec3(up * (2 * v.tanY / h)), 0);
  d.rayOrigin = vec4(glm::vec3(right * x + up * y + (v.orthographic ? glm::dvec3(0) : forward)), 0);
  d.forward = vec4(glm::vec3(forward), 0);
  d.depthParams = vec4(float(v.depthParams.x), float(v.depthParams.y), 0, 0);
}

// What fog of any depth shows, by the first two bands of the surroundings' harmonics: band l is scattered as itself times g^l (shading/fog.h). The coefficients are of irradiance/pi,
// in which band 1 counts 2/3.
void fillFog(FrameData& d, FrameContext& c) {
  const Fog fog = scene::fogOf(c.scene, &c.report);
  d.fog = vec4(fog.density, fog.falloff, float(c.view.eye.y - double(fog.height)), fog.start);
  const Ambient rung = c.quality.ambient;
  const float first = rung >= Ambient::ShL1 ? 1.5f * fog.anisotropy : 0;
  for (int i = 0; i < 4; ++i) d.fogLight[i] = d.irradiance[i] * vec4(fog.albedo, 0) * (i == 0 ? 1 : first);
  d.fogLight[4] = vec4(fog.albedo, fog.anisotropy);
}

void fillSun(FrameData& d, const FrameContext& c) {
  const Environment::Sun& sun = *c.scene.environment.sun;
  const auto finite = [](float v, float otherwise) { return std::isfinite(v) ? v : otherwise; };
  d.sun[0] = vec4(sun.toSun, std::clamp(finite(sun.radius, 0.004652f), 1e-5f, 1.5f));
  // Held where its product with a pixel's share still is a number.
  for (int i = 0; i < 3; ++i) d.sun[1][i] = std::clamp(finite(sun.radiance[i], 0) * c.preExposure, 0.0f, 1e30f);
  d.sun[1].w = finite(sun.horizon, -2);
}

/// Pre-exposed light is held here: its product with any lobe (2e6 at most) is a number, and 0 times it is 0.
constexpr float kMostLight = 1e18f;

/// How far off its surface a position that is rebuilt from depth may lie: a share of its distance from the eye, and metres. Floats round by some 2^-24 each, and rasterizers move vertices
/// to a grid of 1/256 of a pixel (GL_SUBPIXEL_BITS of all that are common is 8), a surface with them.
glm::dvec2 positionSlack(const scene::ViewFrame& v) {
  const double pixel = std::max(2 * v.tanX / v.viewport.z, 2 * v.tanY / v.viewport.w) / 256;
  return v.orthographic ? glm::dvec2(1e-5, pixel) : glm::dvec2(1e-5 + pixel, 0);
}

/// What a pass writes to the light buffer at most: half of what it holds, with room for rounding (half floats end at 65504, the blue of R11F_G11F_B10F at 64512). What emits is added to what
/// reflects, and a sum past the end is infinite on chips (llvmpipe holds it).
float largestLight(const TargetPlan* light) { return !light || light->format == "RGBA16F" ? 32500.0f : light->format == "RGBA32F" ? 1.5e38f : 32000.0f; }
}  // namespace

Result<void> uploadFrameData(FrameContext& c, float displayExposure) {
  FrameData d{};
  d.viewProjection = glm::mat4(c.view.viewProjection);
  fillRays(d, c.view);
  d.exposure = vec4(c.preExposure, 1 / c.preExposure, displayExposure / c.preExposure, largestLight(c.plan.target("light")));
  d.eye = vec4(glm::vec3(c.view.eye), 0);
  const Environment& e = c.scene.environment;
  const float scale = std::isfinite(e.scale) ? std::min(std::max(e.scale, 0.0f) * c.preExposure, kMostLight) : 0;
  // As the cube's texels are mended (gpu_environment.cpp): a channel that is not finite or negative is black.
  for (int i = 0; i < 3; ++i) d.background[i] = std::isfinite(e.color[i]) ? std::clamp(e.color[i], 0.0f, 1e30f) * scale : 0.0f;
  d.background.w = scale;
  if (c.environment) {
    d.environment.x = c.environment->lastLevel;
    for (std::size_t i = 0; i < 9; ++i) d.irradiance[i] = vec4(c.environment->irradiance[i] * scale, 0);
  }
  const glm::dvec2 slack = positionSlack(c.view);
  d.probes = vec4(float(c.probes.size()), c.probeLight ? c.probeLight->lastLevel : 0, slack.x, slack.y);
  if (c.plan.on("fog")) fillFog(d, c);
  if (c.plan.on("sun_disc") && c.scene.environment.sun) fillSun(d, c);
  d.environment.y = float(c.lights.local.size());
  d.environment.z = std::isfinite(c.quality.occlusionRadius) ? std::clamp(c.quality.occlusionRadius, 1e-3f, 1e3f) : 1.0f;
  d.environment.w = float(c.view.viewport.w) / 6;
  d.viewport = c.view.viewport;
  d.target = c.view.target;
  for (std::size_t i = 0; i < c.lights.directional.size(); ++i) {
    d.directional[2 * i] = vec4(c.lights.directional[i].toLight, 0);
    d.directional[2 * i + 1] = vec4(glm::min(c.lights.directional[i].illuminance * c.preExposure, glm::vec3(kMostLight)), 0);
  }
  if (auto written = c.buffers.frame.write(std::as_bytes(std::span(&d, 1))); !written) return written;
  c.buffers.frame.bindBase(GL_UNIFORM_BUFFER, BINDING_FRAME);
  return {};
}

Result<void> uploadDraws(FrameContext& c) {
  std::vector<std::byte> bytes(std::max<std::size_t>(c.visible.size(), 1) * c.buffers.drawStride);
  for (std::size_t i = 0; i < c.visible.size(); ++i) {
    const scene::VisibleInstance& v = c.visible[i];
    DrawData d{};
    glm::dmat4 model(1);
    for (int r = 0; r < 3; ++r)
      for (int k = 0; k < 4; ++k) model[k][r] = double(v.model[r][k]);
    d.clip = glm::mat4(c.view.viewProjection * model);
    for (int r = 0; r < 3; ++r) {
      d.model[r] = v.model[r];
      d.normal[r] = vec4(v.normal[r], 0);
    }
    d.normal[0].w = float(v.id.index + 1);
    d.normal[1].w = v.mesh->colors.empty() ? 0 : 1;
    d.normal[2].w = v.flipped ? -1.0f : 1.0f;
    std::memcpy(bytes.data() + i * c.buffers.drawStride, &d, sizeof d);
  }
  if (!c.buffers.draws) {
    auto made = gl::Buffer::create(c.device, gl::BufferUse::Stream, bytes.size(), nullptr, "draw data");
    if (!made) return fail(made.error());
    c.buffers.draws = std::move(*made);
  }
  return c.buffers.draws.write(bytes);
}

gl::VertexArray FrameBuffers::makeArray(gl::Device& device, bool general, bool instanced) {
  std::vector<gl::VertexAttribute> attributes = {{ATTRIBUTE_POSITION, 3, GL_FLOAT, false, false, 0, 0},
                                                 {ATTRIBUTE_NORMAL, 4, GL_SHORT, true, false, 12, 0},
                                                 {ATTRIBUTE_TANGENT, 4, GL_SHORT, true, false, 20, 0},
                                                 {ATTRIBUTE_UV0, 2, GL_FLOAT, false, false, 28, 0}};
  if (general) {
    attributes.push_back({ATTRIBUTE_UV1, 2, GL_FLOAT, false, false, 0, 1});
    attributes.push_back({ATTRIBUTE_COLOR, 4, GL_UNSIGNED_SHORT, true, false, 8, 1});
  }
  if (instanced)
    for (GLuint k = 0; k < DRAW_VECTORS; ++k) attributes.push_back({ATTRIBUTE_DRAW + k, 4, GL_FLOAT, false, false, 16 * k, kDrawBinding});
  return gl::VertexArray::create(device, attributes, {}, 0, fmt::format("vertices{}{}", general ? ", general" : "", instanced ? ", instanced" : ""));
}

const gl::VertexArray& FrameBuffers::array(gl::Device& device, bool general, bool instanced) {
  gl::VertexArray& a = arrays[general][instanced];
  if (!a) a = makeArray(device, general, instanced);
  return a;
}

const gl::VertexArray& FrameBuffers::noVertices(gl::Device& device) {
  if (!none_) none_ = gl::VertexArray::create(device, {}, {}, 0, "no vertices");
  return none_;
}

const GpuMesh* meshOf(FrameContext& c, std::size_t i) {
  const Instance& instance = *c.visible[i].instance;
  const Material* material = c.scene.materials.get(instance.material);
  return c.gpuScene.mesh(c.scene, instance.mesh, material && plan::wantsTangents(*material), c.report);
}

namespace {

bool bindMesh(FrameContext& c, std::size_t i, bool general, bool instanced, BoundInstance& bound) {
  const scene::VisibleInstance& v = c.visible[i];
  const GpuMesh* mesh = meshOf(c, i);
  if (!mesh) return false;
  const GLuint vertices = v.pose ? c.gpuScene.deformation().vertices(v.id, mesh->serial) : mesh->vertices.id();
  if (!vertices) return false;
  const GladGLContext& gl = c.device.gl;
  const gl::VertexArray* wanted = &c.buffers.array(c.device, general, instanced);
  if (wanted != bound.array) wanted->bind();
  if (mesh != bound.mesh || vertices != bound.vertices || wanted != bound.array) {
    const GLuint array = wanted->id();
    gl.VertexArrayVertexBuffer(array, 0, vertices, 0, GpuMesh::kStride);
    // A mesh without extras in a general program: its vertices stand in; DrawData says that there is no colour, and uv set 1 is not asked for.
    if (general) gl.VertexArrayVertexBuffer(array, 1, mesh->extras ? mesh->extras.id() : mesh->vertices.id(), 0, mesh->extras ? GpuMesh::kExtraStride : GpuMesh::kStride);
    gl.VertexArrayElementBuffer(array, mesh->indices.id());
  }
  const MaterialBinding& m = c.gpuScene.material(c.scene, v.instance->material, c.report);
  if (&m != bound.material) {
    c.gpuScene.materials().bindRange(GL_UNIFORM_BUFFER, BINDING_MATERIAL, m.offset, sizeof(MaterialData));
    gl.BindTextures(0, 5, m.texture.data());
    gl.BindSamplers(0, 5, m.sampler.data());
  }
  bound = {mesh, vertices, &m, wanted};
  return true;
}

}  // namespace

bool bindInstance(FrameContext& c, std::size_t i, bool general, BoundInstance& bound) {
  if (!bindMesh(c, i, general, false, bound)) return false;
  c.buffers.draws.bindRange(GL_UNIFORM_BUFFER, BINDING_DRAW, i * c.buffers.drawStride, sizeof(DrawData));
  return true;
}

bool bindInstances(FrameContext& c, scene::Batch batch, bool general, BoundInstance& bound) {
  if (!bindMesh(c, batch.first, general, true, bound)) return false;
  c.device.gl.VertexArrayVertexBuffer(bound.array->id(), kDrawBinding, c.buffers.draws.id(), GLintptr(batch.first * c.buffers.drawStride), GLsizei(c.buffers.drawStride));
  c.device.gl.VertexArrayBindingDivisor(bound.array->id(), kDrawBinding, 1);
  return true;
}

}  // namespace burnish::gpu_scene
