#include "recorder/gl_ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace burnish::test {
namespace {

constexpr std::array<std::string_view, 10> kKinds{"texture", "buffer", "framebuffer", "vertex array", "sampler", "query", "program", "shader", "renderbuffer", "sync"};
constexpr std::array<std::string_view, 7> kWorks{"draw", "clear", "dispatch", "blit", "mipmaps", "upload", "read back"};

std::optional<ObjectKind> kindOf(GLenum identifier) {
  switch (identifier) {
    case GL_TEXTURE: return ObjectKind::Texture;
    case GL_BUFFER: return ObjectKind::Buffer;
    case GL_FRAMEBUFFER: return ObjectKind::Framebuffer;
    case GL_VERTEX_ARRAY: return ObjectKind::VertexArray;
    case GL_SAMPLER: return ObjectKind::Sampler;
    case GL_QUERY: return ObjectKind::Query;
    case GL_PROGRAM: return ObjectKind::Program;
    case GL_SHADER: return ObjectKind::Shader;
    case GL_RENDERBUFFER: return ObjectKind::Renderbuffer;
    default: return std::nullopt;
  }
}

/// The texture target that a sampler uniform of this type reads; 0: not a sampler.
GLenum targetOf(GLenum type) {
  switch (type) {
    case GL_SAMPLER_1D: case GL_INT_SAMPLER_1D: case GL_UNSIGNED_INT_SAMPLER_1D: case GL_SAMPLER_1D_SHADOW: return GL_TEXTURE_1D;
    case GL_SAMPLER_2D: case GL_INT_SAMPLER_2D: case GL_UNSIGNED_INT_SAMPLER_2D: case GL_SAMPLER_2D_SHADOW: return GL_TEXTURE_2D;
    case GL_SAMPLER_3D: case GL_INT_SAMPLER_3D: case GL_UNSIGNED_INT_SAMPLER_3D: return GL_TEXTURE_3D;
    case GL_SAMPLER_CUBE: case GL_INT_SAMPLER_CUBE: case GL_UNSIGNED_INT_SAMPLER_CUBE: case GL_SAMPLER_CUBE_SHADOW: return GL_TEXTURE_CUBE_MAP;
    case GL_SAMPLER_2D_ARRAY: case GL_INT_SAMPLER_2D_ARRAY: case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY: case GL_SAMPLER_2D_ARRAY_SHADOW: return GL_TEXTURE_2D_ARRAY;
    case GL_SAMPLER_CUBE_MAP_ARRAY: case GL_INT_SAMPLER_CUBE_MAP_ARRAY: case GL_UNSIGNED_INT_SAMPLER_CUBE_MAP_ARRAY: case GL_SAMPLER_CUBE_MAP_ARRAY_SHADOW: return GL_TEXTURE_CUBE_MAP_ARRAY;
    case GL_SAMPLER_BUFFER: case GL_INT_SAMPLER_BUFFER: case GL_UNSIGNED_INT_SAMPLER_BUFFER: return GL_TEXTURE_BUFFER;
    case GL_SAMPLER_2D_MULTISAMPLE: case GL_INT_SAMPLER_2D_MULTISAMPLE: case GL_UNSIGNED_INT_SAMPLER_2D_MULTISAMPLE: return GL_TEXTURE_2D_MULTISAMPLE;
    default: return 0;
  }
}

}  // namespace

std::string_view kindName(ObjectKind kind) { return kKinds[std::size_t(kind)]; }
std::string_view workName(Work::Kind kind) { return kWorks[std::size_t(kind)]; }

const GlObject* Ledger::find(ObjectKind kind, GLuint id) const {
  const auto found = alive_.find({kind, id});
  return found == alive_.end() ? nullptr : &found->second;
}

std::size_t Ledger::count(ObjectKind kind) const {
  return std::size_t(std::count_if(alive_.begin(), alive_.end(), [kind](const auto& row) { return row.first.first == kind; }));
}

std::int64_t Ledger::bytes(ObjectKind kind) const {
  std::int64_t sum = 0;
  for (const auto& [key, object] : alive_)
    if (key.first == kind) sum += object.bytes;
  return sum;
}

std::vector<std::string> Ledger::inventory() const {
  std::vector<std::string> list;
  for (const auto& [key, object] : alive_) list.push_back(fmt::format("{} '{}' {} bytes", kindName(object.kind), object.label, object.bytes));
  std::sort(list.begin(), list.end());
  return list;
}

void Ledger::make(ObjectKind kind, GLsizei n, const GLuint* ids, GLenum target) {
  for (GLsizei i = 0; i < n; ++i) {
    if (!ids[i]) continue;
    ++created_;
    alive_[{kind, ids[i]}] = {kind, ids[i], "", groups_[group_], calls_, target, 0};
    if (kind == ObjectKind::Framebuffer) framebuffers_[ids[i]] = {};
    if (kind == ObjectKind::VertexArray) vertexArrays_[ids[i]] = {};
    if (kind == ObjectKind::Program) samplers_.erase(ids[i]);
  }
}

// What a deleted name was bound to is unbound by GL; a framebuffer keeps its attachments' storage, but the engine never draws to such a one.
void Ledger::drop(ObjectKind kind, GLsizei n, const GLuint* ids) {
  for (GLsizei i = 0; i < n; ++i) {
    if (!ids[i]) continue;
    if (alive_.erase({kind, ids[i]}))
      ++deleted_;
    else
      ++strange_;
    switch (kind) {
      case ObjectKind::Texture:
        std::erase_if(units_, [&](const auto& row) { return row.second.texture == ids[i]; });
        behind_.erase(ids[i]);
        break;
      case ObjectKind::Framebuffer:
        framebuffers_.erase(ids[i]);
        if (drawFramebuffer_ == ids[i]) drawFramebuffer_ = 0;
        if (readFramebuffer_ == ids[i]) readFramebuffer_ = 0;
        break;
      case ObjectKind::VertexArray:
        vertexArrays_.erase(ids[i]);
        if (vertexArray_ == ids[i]) vertexArray_ = 0;
        break;
      case ObjectKind::Buffer: std::erase_if(indexed_, [&](const auto& row) { return row.second == ids[i]; }); break;
      default: break;
    }
  }
}

void Ledger::FenceSync(GLsync sync, GLenum, GLbitfield) {
  const GLuint id = nextSync_++;
  syncs_[sync] = id;
  make(ObjectKind::Sync, 1, &id);
}

void Ledger::DeleteSync(GLsync sync) {
  const auto found = syncs_.find(sync);
  const GLuint id = found == syncs_.end() ? nextSync_++ : found->second;
  if (sync) drop(ObjectKind::Sync, 1, &id);
  syncs_.erase(sync);
}

// The driver's own word on the texels of every level, so that the engine's table of formats is not its own judge.
void Ledger::measureTexture(GLuint id) {
  const auto found = alive_.find({ObjectKind::Texture, id});
  if (found == alive_.end()) return;
  const auto parameter = real<PFNGLGETTEXTUREPARAMETERIVPROC>(Function::GetTextureParameteriv);
  const auto level = real<PFNGLGETTEXTURELEVELPARAMETERIVPROC>(Function::GetTextureLevelParameteriv);
  GLint levels = 0;
  parameter(id, GL_TEXTURE_IMMUTABLE_LEVELS, &levels);
  std::int64_t bytes = 0;
  for (GLint i = 0; i < levels; ++i) {
    const auto of = [&](GLenum name) {
      GLint value = 0;
      level(id, i, name, &value);
      return std::int64_t(value);
    };
    std::int64_t bits = 0;
    for (GLenum name : {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE, GL_TEXTURE_SHARED_SIZE}) bits += of(name);
    if (const std::int64_t depth = of(GL_TEXTURE_DEPTH_SIZE)) bits = depth <= 16 ? 16 : of(GL_TEXTURE_STENCIL_SIZE) && depth == 32 ? 64 : 32;
    // A cube's level reports one face.
    const std::int64_t faces = found->second.target == GL_TEXTURE_CUBE_MAP ? 6 : 1, samples = std::max<std::int64_t>(of(GL_TEXTURE_SAMPLES), 1);
    bytes += (bits + 7) / 8 * of(GL_TEXTURE_WIDTH) * std::max<std::int64_t>(of(GL_TEXTURE_HEIGHT), 1) * std::max<std::int64_t>(of(GL_TEXTURE_DEPTH), 1) * faces * samples;
  }
  found->second.bytes = bytes;
}

void Ledger::sizeBuffer(Function f, GLuint id, GLsizeiptr size, const void* data) {
  if (const auto found = alive_.find({ObjectKind::Buffer, id}); found != alive_.end()) found->second.bytes = size;
  if (data) fill(Work::Kind::Upload, f, {ObjectKind::Buffer, id});
}

void Ledger::ObjectLabel(GLenum identifier, GLuint name, GLsizei length, const GLchar* text) {
  const std::string label = !text ? "" : length < 0 ? std::string(text) : std::string(text, std::size_t(length));
  notes_.push_back(std::hash<std::string>{}(label));
  const auto kind = kindOf(identifier);
  if (!kind) return;
  if (const auto found = alive_.find({*kind, name}); found != alive_.end()) found->second.label = label;
}

void Ledger::enterGroup() {
  std::string path;
  for (const std::string& part : stack_) path += (path.empty() ? "" : "/") + part;
  const auto [row, isNew] = groupIndex_.try_emplace(path, groups_.size());
  if (isNew) groups_.push_back(path);
  group_ = row->second;
}

void Ledger::PushDebugGroup(GLenum, GLuint, GLsizei length, const GLchar* message) {
  stack_.push_back(length < 0 ? std::string(message) : std::string(message, std::size_t(length)));
  enterGroup();
}

void Ledger::PopDebugGroup() {
  if (stack_.empty())
    ++unbalancedPops_;
  else
    stack_.pop_back();
  enterGroup();
}

void Ledger::attach(GLuint framebuffer, GLenum attachment, GLuint texture) {
  std::map<GLenum, GLuint>& points = framebuffers_[framebuffer].attachments;
  const auto set = [&](GLenum point) { texture ? void(points[point] = texture) : void(points.erase(point)); };
  if (attachment == GL_DEPTH_STENCIL_ATTACHMENT) {
    set(GL_DEPTH_ATTACHMENT);
    set(GL_STENCIL_ATTACHMENT);
  } else {
    set(attachment);
  }
}

void Ledger::NamedFramebufferDrawBuffers(GLuint framebuffer, GLsizei n, const GLenum* buffers) {
  if (framebuffer && find(ObjectKind::Framebuffer, framebuffer)) framebuffers_[framebuffer].drawBuffers.assign(buffers, buffers + n);
}

void Ledger::BindFramebuffer(GLenum target, GLuint id) {
  if (target != GL_READ_FRAMEBUFFER) drawFramebuffer_ = id;
  if (target != GL_DRAW_FRAMEBUFFER) readFramebuffer_ = id;
}

// target 0: the texture's own (glBindTextureUnit); id 0 then unbinds every target of the unit.
void Ledger::bindTexture(GLuint unit, GLenum target, GLuint id, bool batch) {
  if (id == 0) {
    std::erase_if(units_, [&](const auto& row) { return row.first.first == unit && (target == 0 || row.first.second == target); });
    return;
  }
  if (target == 0) {
    const GlObject* object = find(ObjectKind::Texture, id);
    target = object ? object->target : GLenum(GL_TEXTURE_2D);
  }
  Slot slot{id, -1};
  if (keepWork_) {
    slot.binding = std::ptrdiff_t(bindings_.size());
    bindings_.push_back({unit, id, groups_[group_], calls_, batch, false});
  }
  units_[{unit, target}] = slot;
}

void Ledger::BindTextures(GLuint first, GLsizei n, const GLuint* ids) {
  for (GLsizei i = 0; i < n; ++i) bindTexture(first + GLuint(i), 0, ids ? ids[i] : 0, true);
  note(std::span(ids, ids ? std::size_t(n) : 0));
}

void Ledger::BindBuffersBase(GLenum target, GLuint first, GLsizei n, const GLuint* buffers) {
  for (GLsizei i = 0; i < n; ++i) indexed_[{target, first + GLuint(i)}] = buffers ? buffers[i] : 0;
  note(std::span(buffers, buffers ? std::size_t(n) : 0));
}

void Ledger::forgetWork() {
  work_.clear();
  bindings_.clear();
  for (auto& [key, slot] : units_) slot.binding = -1;
}

std::vector<Touched> Ledger::attachmentsOf(GLuint framebuffer, GLbitfield mask, GLint colorIndex) const {
  const auto found = framebuffers_.find(framebuffer);
  if (framebuffer == 0 || found == framebuffers_.end()) return {{ObjectKind::Framebuffer, framebuffer, false}};
  std::vector<Touched> list;
  const auto add = [&](GLenum point) {
    if (const auto a = found->second.attachments.find(point); a != found->second.attachments.end()) list.push_back(touched(ObjectKind::Texture, a->second));
  };
  if (mask & GL_COLOR_BUFFER_BIT)
    for (std::size_t i = 0; i < found->second.drawBuffers.size(); ++i)
      if (colorIndex < 0 || std::size_t(colorIndex) == i) add(found->second.drawBuffers[i]);
  if (mask & GL_DEPTH_BUFFER_BIT) add(GL_DEPTH_ATTACHMENT);
  if (mask & GL_STENCIL_BUFFER_BIT) add(GL_STENCIL_ATTACHMENT);
  return list;
}

// Asked of the driver once a program: units may come from `layout(binding)` or from uniforms that were set before the first draw.
const std::vector<Ledger::Sampled>& Ledger::samplersOf(GLuint program) {
  if (const auto found = samplers_.find(program); found != samplers_.end()) return found->second;
  std::vector<Sampled>& list = samplers_[program];
  GLint count = 0;
  real<PFNGLGETPROGRAMIVPROC>(Function::GetProgramiv)(program, GL_ACTIVE_UNIFORMS, &count);
  for (GLint i = 0; i < count; ++i) {
    GLint size = 0;
    GLenum type = 0;
    GLchar name[256] = {};
    real<PFNGLGETACTIVEUNIFORMPROC>(Function::GetActiveUniform)(program, GLuint(i), sizeof name, nullptr, &size, &type, name);
    const GLenum target = targetOf(type);
    if (!target) continue;
    const GLint location = real<PFNGLGETUNIFORMLOCATIONPROC>(Function::GetUniformLocation)(program, name);
    for (GLint k = 0; k < size && location >= 0; ++k) {
      GLint unit = 0;
      real<PFNGLGETUNIFORMIVPROC>(Function::GetUniformiv)(program, location + k, &unit);
      list.push_back({GLuint(unit), target});
    }
  }
  return list;
}

std::vector<Touched> Ledger::sampled() {
  std::vector<Touched> list;
  if (!program_) return list;
  for (const Sampled& s : samplersOf(program_)) {
    const auto slot = units_.find({s.unit, s.target});
    if (slot == units_.end()) continue;
    if (slot->second.binding >= 0) bindings_[std::size_t(slot->second.binding)].used = true;
    list.push_back(touched(ObjectKind::Texture, slot->second.texture));
  }
  return list;
}

std::vector<Touched> Ledger::buffersOf(bool elements, bool vertices, bool indirect) const {
  std::vector<Touched> list;
  const auto add = [&](GLuint buffer) {
    if (buffer) list.push_back(touched(ObjectKind::Buffer, buffer));
  };
  if (const auto array = vertexArrays_.find(vertexArray_); vertices && array != vertexArrays_.end()) {
    for (const auto& [index, buffer] : array->second.vertices) add(buffer);
    if (elements) add(array->second.elements);
  }
  for (const auto& [key, buffer] : indexed_) add(buffer);
  if (indirect)
    if (const auto found = plain_.find(vertices ? GL_DRAW_INDIRECT_BUFFER : GL_DISPATCH_INDIRECT_BUFFER); found != plain_.end()) add(found->second);
  return list;
}

Work& Ledger::add(Work::Kind kind, Function f) {
  Work work;
  work.kind = kind;
  work.function = f;
  work.group = groups_[group_];
  work.call = calls_;
  if (!keepWork_) return scratch_ = work;
  work_.push_back(std::move(work));
  return work_.back();
}

void Ledger::draw(Function f, bool elements, bool indirect) {
  if (!keepWork_) return;
  Work& w = add(Work::Kind::Draw, f);
  w.program = program_;
  w.framebuffer = drawFramebuffer_;
  w.writes = attachmentsOf(drawFramebuffer_, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT, -1);
  w.reads = sampled();
  w.buffers = buffersOf(elements, true, indirect);
}

void Ledger::dispatch(Function f, bool indirect) {
  if (!keepWork_) return;
  Work& w = add(Work::Kind::Dispatch, f);
  w.program = program_;
  w.reads = sampled();
  w.buffers = buffersOf(false, false, indirect);
  for (const auto& [unit, image] : images_) {
    if (!image.texture) continue;
    if (image.access != GL_READ_ONLY) w.writes.push_back(touched(ObjectKind::Texture, image.texture));
    if (image.access != GL_WRITE_ONLY) w.reads.push_back(touched(ObjectKind::Texture, image.texture));
  }
}

void Ledger::clear(Function f, GLuint framebuffer, GLbitfield mask, GLint colorIndex) {
  if (!keepWork_) return;
  Work& w = add(Work::Kind::Clear, f);
  w.framebuffer = framebuffer;
  w.writes = attachmentsOf(framebuffer, mask, colorIndex);
}

void Ledger::fill(Work::Kind kind, Function f, Touched what) {
  if (keepWork_) add(kind, f).writes = {touched(what.kind, what.id)};
}

void Ledger::readBack(Function f, GLuint texture) {
  if (keepWork_) add(Work::Kind::Read, f).reads = {touched(ObjectKind::Texture, texture)};
}

void Ledger::blit(Function f, GLuint from, GLuint to, GLbitfield mask) {
  if (!keepWork_) return;
  Work& w = add(Work::Kind::Blit, f);
  w.framebuffer = to;
  w.writes = attachmentsOf(to, mask, -1);
  w.reads = attachmentsOf(from, mask, -1);
}

void Ledger::CopyImageSubData(GLuint from, GLenum, GLint, GLint, GLint, GLint, GLuint to, GLenum, GLint, GLint, GLint, GLint, GLsizei, GLsizei, GLsizei) {
  if (!keepWork_) return;
  Work& w = add(Work::Kind::Blit, Function::CopyImageSubData);
  w.writes = {touched(ObjectKind::Texture, to)};
  w.reads = {touched(ObjectKind::Texture, from)};
}

void Ledger::CopyNamedBufferSubData(GLuint from, GLuint to, GLintptr, GLintptr, GLsizeiptr) {
  if (!keepWork_) return;
  Work& w = add(Work::Kind::Blit, Function::CopyNamedBufferSubData);
  w.writes = {touched(ObjectKind::Buffer, to)};
  w.buffers = {touched(ObjectKind::Buffer, from)};
}

}  // namespace burnish::test
