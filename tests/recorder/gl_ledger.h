// What a recorded program holds and does on its context: objects alive with labels and bytes, and its work (draws, clears, dispatches, blits, uploads, read-backs), each with the
// debug group that it was done in, what it wrote and what it read. It follows direct state access, which is how the engine works; a function that matters and that has no method
// here is named in `unmodelled`.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gl_functions.h"

namespace burnish::test {

enum class ObjectKind : std::uint8_t { Texture, Buffer, Framebuffer, VertexArray, Sampler, Query, Program, Shader, Renderbuffer, Sync };
std::string_view kindName(ObjectKind kind);

struct GlObject {
  ObjectKind kind = ObjectKind::Texture;
  GLuint id = 0;
  std::string label;
  std::string group;        ///< in which it was made
  std::uint64_t call = 0;   ///< number of the call that made it
  GLenum target = 0;        ///< textures, queries, shaders (type)
  std::int64_t bytes = 0;   ///< of storage: textures and renderbuffers as the driver reports their texels, buffers as asked for
};

/// What a piece of work touched: an object of the ledger, or one of the host's (known = false; framebuffer 0 is the host's too).
struct Touched {
  ObjectKind kind = ObjectKind::Texture;
  GLuint id = 0;
  bool known = true;
  friend auto operator<=>(const Touched&, const Touched&) = default;
};

struct Work {
  enum class Kind : std::uint8_t { Draw, Clear, Dispatch, Blit, Mips, Upload, Read };
  Kind kind = Kind::Draw;
  Function function{};
  std::string group;
  std::uint64_t call = 0;
  GLuint program = 0;           ///< draws and dispatches
  GLuint framebuffer = 0;       ///< draws, clears, blits
  std::vector<Touched> writes;  ///< attachments that are drawn to; the object that is filled
  std::vector<Touched> reads;   ///< textures that the program samples; vertex, index, uniform and storage buffers are in `buffers`
  std::vector<Touched> buffers;
};
std::string_view workName(Work::Kind kind);

/// A texture that was bound to a unit, and whether any draw or dispatch sampled it there before it was replaced.
struct TextureBinding {
  GLuint unit = 0, texture = 0;
  std::string group;
  std::uint64_t call = 0;
  bool batch = false;  ///< by glBindTextures
  bool used = false;
};

class Ledger : public Observer {
 public:
  explicit Ledger(std::function<void*(Function)> real) : real_(std::move(real)) {}

  [[nodiscard]] const std::map<std::pair<ObjectKind, GLuint>, GlObject>& alive() const { return alive_; }
  [[nodiscard]] const GlObject* find(ObjectKind kind, GLuint id) const;
  [[nodiscard]] std::size_t count(ObjectKind kind) const;
  [[nodiscard]] std::uint64_t created() const { return created_; }
  [[nodiscard]] std::uint64_t deleted() const { return deleted_; }
  [[nodiscard]] std::int64_t bytes(ObjectKind kind) const;
  [[nodiscard]] std::int64_t bytes() const { return bytes(ObjectKind::Texture) + bytes(ObjectKind::Buffer) + bytes(ObjectKind::Renderbuffer); }
  /// "texture 'gbuffer_a' 921600 bytes", one an object, sorted: equal lists are equal sets.
  [[nodiscard]] std::vector<std::string> inventory() const;
  /// Deletions of names that were not alive (twice, or the host's).
  [[nodiscard]] std::uint64_t strangeDeletions() const { return strange_; }

  /// Work since the last forgetWork().
  [[nodiscard]] const std::vector<Work>& work() const { return work_; }
  /// Bindings since the last forgetWork(), in order; those that are in force at the end are settled by finishBindings().
  [[nodiscard]] const std::vector<TextureBinding>& bindings() const { return bindings_; }
  void forgetWork();
  void keepWork(bool keep) { keepWork_ = keep; }

  [[nodiscard]] std::uint64_t calls() const { return calls_; }
  [[nodiscard]] int groupDepth() const { return int(stack_.size()); }
  [[nodiscard]] int unbalancedPops() const { return unbalancedPops_; }
  [[nodiscard]] std::size_t group() const { return group_; }
  [[nodiscard]] const std::vector<std::string>& groupNames() const { return groups_; }

  // For the recorder.
  void beginCall(std::size_t) { ++calls_; }
  [[nodiscard]] std::vector<std::uint64_t> takeNotes() { return std::exchange(notes_, {}); }

  // Observed functions, named as GL's.
  void CreateTextures(GLenum target, GLsizei n, GLuint* ids) { make(ObjectKind::Texture, n, ids, target); }
  void CreateBuffers(GLsizei n, GLuint* ids) { make(ObjectKind::Buffer, n, ids); }
  void CreateFramebuffers(GLsizei n, GLuint* ids) { make(ObjectKind::Framebuffer, n, ids); }
  void CreateVertexArrays(GLsizei n, GLuint* ids) { make(ObjectKind::VertexArray, n, ids); }
  void CreateSamplers(GLsizei n, GLuint* ids) { make(ObjectKind::Sampler, n, ids); }
  void CreateQueries(GLenum target, GLsizei n, GLuint* ids) { make(ObjectKind::Query, n, ids, target); }
  void CreateRenderbuffers(GLsizei n, GLuint* ids) { make(ObjectKind::Renderbuffer, n, ids); }
  void GenTextures(GLsizei n, GLuint* ids) { make(ObjectKind::Texture, n, ids); }
  void GenBuffers(GLsizei n, GLuint* ids) { make(ObjectKind::Buffer, n, ids); }
  void GenFramebuffers(GLsizei n, GLuint* ids) { make(ObjectKind::Framebuffer, n, ids); }
  void GenVertexArrays(GLsizei n, GLuint* ids) { make(ObjectKind::VertexArray, n, ids); }
  void GenSamplers(GLsizei n, GLuint* ids) { make(ObjectKind::Sampler, n, ids); }
  void GenQueries(GLsizei n, GLuint* ids) { make(ObjectKind::Query, n, ids); }
  void GenRenderbuffers(GLsizei n, GLuint* ids) { make(ObjectKind::Renderbuffer, n, ids); }
  void CreateProgram(GLuint id) { make(ObjectKind::Program, 1, &id); }
  void CreateShader(GLuint id, GLenum type) { make(ObjectKind::Shader, 1, &id, type); }
  void FenceSync(GLsync sync, GLenum, GLbitfield);
  void DeleteTextures(GLsizei n, const GLuint* ids) { drop(ObjectKind::Texture, n, ids); }
  void DeleteBuffers(GLsizei n, const GLuint* ids) { drop(ObjectKind::Buffer, n, ids); }
  void DeleteFramebuffers(GLsizei n, const GLuint* ids) { drop(ObjectKind::Framebuffer, n, ids); }
  void DeleteVertexArrays(GLsizei n, const GLuint* ids) { drop(ObjectKind::VertexArray, n, ids); }
  void DeleteSamplers(GLsizei n, const GLuint* ids) { drop(ObjectKind::Sampler, n, ids); }
  void DeleteQueries(GLsizei n, const GLuint* ids) { drop(ObjectKind::Query, n, ids); }
  void DeleteRenderbuffers(GLsizei n, const GLuint* ids) { drop(ObjectKind::Renderbuffer, n, ids); }
  void DeleteProgram(GLuint id) { drop(ObjectKind::Program, 1, &id); }
  void DeleteShader(GLuint id) { drop(ObjectKind::Shader, 1, &id); }
  void DeleteSync(GLsync sync);

  void TextureStorage1D(GLuint id, GLsizei, GLenum, GLsizei) { measureTexture(id); }
  void TextureStorage2D(GLuint id, GLsizei, GLenum, GLsizei, GLsizei) { measureTexture(id); }
  void TextureStorage3D(GLuint id, GLsizei, GLenum, GLsizei, GLsizei, GLsizei) { measureTexture(id); }
  void TextureStorage2DMultisample(GLuint id, GLsizei, GLenum, GLsizei, GLsizei, GLboolean) { measureTexture(id); }
  void TextureStorage3DMultisample(GLuint id, GLsizei, GLenum, GLsizei, GLsizei, GLsizei, GLboolean) { measureTexture(id); }
  void NamedBufferStorage(GLuint id, GLsizeiptr size, const void* data, GLbitfield) { sizeBuffer(Function::NamedBufferStorage, id, size, data); }
  void NamedBufferData(GLuint id, GLsizeiptr size, const void* data, GLenum) { sizeBuffer(Function::NamedBufferData, id, size, data); }
  void NamedBufferSubData(GLuint id, GLintptr, GLsizeiptr, const void*) { fill(Work::Kind::Upload, Function::NamedBufferSubData, {ObjectKind::Buffer, id}); }
  void TextureSubImage2D(GLuint id, GLint, GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, const void*) { fill(Work::Kind::Upload, Function::TextureSubImage2D, {ObjectKind::Texture, id}); }
  void TextureSubImage3D(GLuint id, GLint, GLint, GLint, GLint, GLsizei, GLsizei, GLsizei, GLenum, GLenum, const void*) {
    fill(Work::Kind::Upload, Function::TextureSubImage3D, {ObjectKind::Texture, id});
  }
  void GenerateTextureMipmap(GLuint id) { fill(Work::Kind::Mips, Function::GenerateTextureMipmap, {ObjectKind::Texture, id}); }
  void GetTextureImage(GLuint id, GLint, GLenum, GLenum, GLsizei, void*) { readBack(Function::GetTextureImage, id); }
  void GetTextureSubImage(GLuint id, GLint, GLint, GLint, GLint, GLsizei, GLsizei, GLsizei, GLenum, GLenum, GLsizei, void*) { readBack(Function::GetTextureSubImage, id); }

  void ObjectLabel(GLenum identifier, GLuint name, GLsizei length, const GLchar* text);
  void PushDebugGroup(GLenum source, GLuint id, GLsizei length, const GLchar* message);
  void PopDebugGroup();

  void NamedFramebufferTexture(GLuint framebuffer, GLenum attachment, GLuint texture, GLint) { attach(framebuffer, attachment, texture); }
  void NamedFramebufferTextureLayer(GLuint framebuffer, GLenum attachment, GLuint texture, GLint, GLint) { attach(framebuffer, attachment, texture); }
  void NamedFramebufferDrawBuffer(GLuint framebuffer, GLenum buffer) { NamedFramebufferDrawBuffers(framebuffer, 1, &buffer); }
  void NamedFramebufferDrawBuffers(GLuint framebuffer, GLsizei n, const GLenum* buffers);
  void BindFramebuffer(GLenum target, GLuint id);

  void LinkProgram(GLuint id) { samplers_.erase(id); }
  void ProgramBinary(GLuint id, GLenum, const void*, GLsizei) { samplers_.erase(id); }
  void UseProgram(GLuint id) { program_ = id; }
  void ActiveTexture(GLenum unit) { activeUnit_ = unit - GL_TEXTURE0; }
  void BindTexture(GLenum target, GLuint id) { bindTexture(activeUnit_, target, id, false); }
  void BindTextureUnit(GLuint unit, GLuint id) { bindTexture(unit, 0, id, false); }
  void BindTextures(GLuint first, GLsizei n, const GLuint* ids);
  void BindSamplers(GLuint, GLsizei n, const GLuint* ids) { note(std::span(ids, ids ? std::size_t(n) : 0)); }
  void BindImageTexture(GLuint unit, GLuint id, GLint, GLboolean, GLint, GLenum access, GLenum) { images_[unit] = {id, access}; }
  void BindVertexArray(GLuint id) { vertexArray_ = id; }
  void VertexArrayVertexBuffer(GLuint array, GLuint index, GLuint buffer, GLintptr, GLsizei) { vertexArrays_[array].vertices[index] = buffer; }
  void VertexArrayElementBuffer(GLuint array, GLuint buffer) { vertexArrays_[array].elements = buffer; }
  void BindBufferBase(GLenum target, GLuint index, GLuint buffer) { indexed_[{target, index}] = buffer; }
  void BindBufferRange(GLenum target, GLuint index, GLuint buffer, GLintptr, GLsizeiptr) { indexed_[{target, index}] = buffer; }
  void BindBuffersBase(GLenum target, GLuint first, GLsizei n, const GLuint* buffers);
  void BindBuffer(GLenum target, GLuint buffer) { plain_[target] = buffer; }
  void TextureBuffer(GLuint texture, GLenum, GLuint buffer) { behind_[texture] = buffer; }

  void DrawArrays(GLenum, GLint, GLsizei) { draw(Function::DrawArrays, false); }
  void DrawArraysInstanced(GLenum, GLint, GLsizei, GLsizei) { draw(Function::DrawArraysInstanced, false); }
  void DrawArraysInstancedBaseInstance(GLenum, GLint, GLsizei, GLsizei, GLuint) { draw(Function::DrawArraysInstancedBaseInstance, false); }
  void DrawArraysIndirect(GLenum, const void*) { draw(Function::DrawArraysIndirect, false, true); }
  void MultiDrawArrays(GLenum, const GLint*, const GLsizei*, GLsizei) { draw(Function::MultiDrawArrays, false); }
  void MultiDrawArraysIndirect(GLenum, const void*, GLsizei, GLsizei) { draw(Function::MultiDrawArraysIndirect, false, true); }
  void DrawElements(GLenum, GLsizei, GLenum, const void*) { draw(Function::DrawElements, true); }
  void DrawRangeElements(GLenum, GLuint, GLuint, GLsizei, GLenum, const void*) { draw(Function::DrawRangeElements, true); }
  void DrawElementsBaseVertex(GLenum, GLsizei, GLenum, const void*, GLint) { draw(Function::DrawElementsBaseVertex, true); }
  void DrawElementsInstanced(GLenum, GLsizei, GLenum, const void*, GLsizei) { draw(Function::DrawElementsInstanced, true); }
  void DrawElementsInstancedBaseInstance(GLenum, GLsizei, GLenum, const void*, GLsizei, GLuint) { draw(Function::DrawElementsInstancedBaseInstance, true); }
  void DrawElementsInstancedBaseVertex(GLenum, GLsizei, GLenum, const void*, GLsizei, GLint) { draw(Function::DrawElementsInstancedBaseVertex, true); }
  void DrawElementsInstancedBaseVertexBaseInstance(GLenum, GLsizei, GLenum, const void*, GLsizei, GLint, GLuint) { draw(Function::DrawElementsInstancedBaseVertexBaseInstance, true); }
  void DrawElementsIndirect(GLenum, GLenum, const void*) { draw(Function::DrawElementsIndirect, true, true); }
  void MultiDrawElements(GLenum, const GLsizei*, GLenum, const void* const*, GLsizei) { draw(Function::MultiDrawElements, true); }
  void MultiDrawElementsBaseVertex(GLenum, const GLsizei*, GLenum, const void* const*, GLsizei, const GLint*) { draw(Function::MultiDrawElementsBaseVertex, true); }
  void MultiDrawElementsIndirect(GLenum, GLenum, const void*, GLsizei, GLsizei) { draw(Function::MultiDrawElementsIndirect, true, true); }
  void DispatchCompute(GLuint, GLuint, GLuint) { dispatch(Function::DispatchCompute, false); }
  void DispatchComputeIndirect(GLintptr) { dispatch(Function::DispatchComputeIndirect, true); }

  void Clear(GLbitfield mask) { clear(Function::Clear, drawFramebuffer_, mask, -1); }
  void ClearBufferfv(GLenum buffer, GLint index, const GLfloat* v) { clearBuffer(Function::ClearBufferfv, drawFramebuffer_, buffer, index, v); }
  void ClearBufferiv(GLenum buffer, GLint index, const GLint* v) { clearBuffer(Function::ClearBufferiv, drawFramebuffer_, buffer, index, v); }
  void ClearBufferuiv(GLenum buffer, GLint index, const GLuint* v) { clearBuffer(Function::ClearBufferuiv, drawFramebuffer_, buffer, index, v); }
  void ClearBufferfi(GLenum, GLint, GLfloat, GLint) { clear(Function::ClearBufferfi, drawFramebuffer_, GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT, -1); }
  void ClearNamedFramebufferfv(GLuint id, GLenum buffer, GLint index, const GLfloat* v) { clearBuffer(Function::ClearNamedFramebufferfv, id, buffer, index, v); }
  void ClearNamedFramebufferiv(GLuint id, GLenum buffer, GLint index, const GLint* v) { clearBuffer(Function::ClearNamedFramebufferiv, id, buffer, index, v); }
  void ClearNamedFramebufferuiv(GLuint id, GLenum buffer, GLint index, const GLuint* v) { clearBuffer(Function::ClearNamedFramebufferuiv, id, buffer, index, v); }
  void ClearNamedFramebufferfi(GLuint id, GLenum, GLint, GLfloat, GLint) { clear(Function::ClearNamedFramebufferfi, id, GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT, -1); }
  void ClearTexImage(GLuint id, GLint, GLenum, GLenum, const void*) { fill(Work::Kind::Clear, Function::ClearTexImage, {ObjectKind::Texture, id}); }
  void ClearTexSubImage(GLuint id, GLint, GLint, GLint, GLint, GLsizei, GLsizei, GLsizei, GLenum, GLenum, const void*) {
    fill(Work::Kind::Clear, Function::ClearTexSubImage, {ObjectKind::Texture, id});
  }
  void ClearNamedBufferData(GLuint id, GLenum, GLenum, GLenum, const void*) { fill(Work::Kind::Clear, Function::ClearNamedBufferData, {ObjectKind::Buffer, id}); }
  void ClearNamedBufferSubData(GLuint id, GLenum, GLintptr, GLsizeiptr, GLenum, GLenum, const void*) {
    fill(Work::Kind::Clear, Function::ClearNamedBufferSubData, {ObjectKind::Buffer, id});
  }
  void BlitNamedFramebuffer(GLuint from, GLuint to, GLint, GLint, GLint, GLint, GLint, GLint, GLint, GLint, GLbitfield mask, GLenum) { blit(Function::BlitNamedFramebuffer, from, to, mask); }
  void BlitFramebuffer(GLint, GLint, GLint, GLint, GLint, GLint, GLint, GLint, GLbitfield mask, GLenum) { blit(Function::BlitFramebuffer, readFramebuffer_, drawFramebuffer_, mask); }
  void CopyImageSubData(GLuint from, GLenum, GLint, GLint, GLint, GLint, GLuint to, GLenum, GLint, GLint, GLint, GLint, GLsizei, GLsizei, GLsizei);
  void CopyNamedBufferSubData(GLuint from, GLuint to, GLintptr, GLintptr, GLsizeiptr);

 private:
  struct FramebufferState {
    std::map<GLenum, GLuint> attachments;  // by attachment point
    std::vector<GLenum> drawBuffers{GL_COLOR_ATTACHMENT0};
  };
  struct ArrayState {
    std::map<GLuint, GLuint> vertices;
    GLuint elements = 0;
  };
  struct Sampled {
    GLuint unit;
    GLenum target;
  };
  struct ImageBinding {
    GLuint texture = 0;
    GLenum access = GL_READ_ONLY;
  };
  void make(ObjectKind kind, GLsizei n, const GLuint* ids, GLenum target = 0);
  void drop(ObjectKind kind, GLsizei n, const GLuint* ids);
  void measureTexture(GLuint id);
  void sizeBuffer(Function f, GLuint id, GLsizeiptr size, const void* data);
  void attach(GLuint framebuffer, GLenum attachment, GLuint texture);
  void bindTexture(GLuint unit, GLenum target, GLuint id, bool batch);
  [[nodiscard]] Touched touched(ObjectKind kind, GLuint id) const { return {kind, id, find(kind, id) != nullptr}; }
  [[nodiscard]] std::vector<Touched> attachmentsOf(GLuint framebuffer, GLbitfield mask, GLint colorIndex) const;
  const std::vector<Sampled>& samplersOf(GLuint program);
  [[nodiscard]] std::vector<Touched> sampled();
  [[nodiscard]] std::vector<Touched> buffersOf(bool elements, bool vertices, bool indirect) const;
  Work& add(Work::Kind kind, Function f);
  void draw(Function f, bool elements, bool indirect = false);
  void dispatch(Function f, bool indirect);
  void clear(Function f, GLuint framebuffer, GLbitfield mask, GLint colorIndex);
  template <class T>
  void clearBuffer(Function f, GLuint framebuffer, GLenum buffer, GLint index, const T* values) {
    for (int i = 0; i < (buffer == GL_COLOR ? 4 : 1); ++i) notes_.push_back(std::bit_cast<std::uint32_t>(values[i]));
    clear(f, framebuffer, buffer == GL_COLOR ? GL_COLOR_BUFFER_BIT : buffer == GL_DEPTH ? GL_DEPTH_BUFFER_BIT : GL_STENCIL_BUFFER_BIT, index);
  }
  void fill(Work::Kind kind, Function f, Touched what);
  void readBack(Function f, GLuint texture);
  void blit(Function f, GLuint from, GLuint to, GLbitfield mask);
  void enterGroup();
  void note(std::span<const GLuint> names) { notes_.insert(notes_.end(), names.begin(), names.end()); }
  template <class Pointer>
  [[nodiscard]] Pointer real(Function f) const {
    return reinterpret_cast<Pointer>(real_(f));
  }

  std::function<void*(Function)> real_;
  std::map<std::pair<ObjectKind, GLuint>, GlObject> alive_;
  std::map<GLsync, GLuint> syncs_;
  GLuint nextSync_ = 1;
  std::uint64_t calls_ = 0, created_ = 0, deleted_ = 0, strange_ = 0;
  std::vector<std::uint64_t> notes_;
  std::vector<std::string> stack_, groups_{""};
  std::map<std::string, std::size_t, std::less<>> groupIndex_{{"", 0}};
  std::size_t group_ = 0;
  int unbalancedPops_ = 0;
  bool keepWork_ = true;
  std::vector<Work> work_;
  std::vector<TextureBinding> bindings_;
  Work scratch_;

  std::map<GLuint, FramebufferState> framebuffers_;
  GLuint drawFramebuffer_ = 0, readFramebuffer_ = 0, program_ = 0, vertexArray_ = 0, activeUnit_ = 0;
  struct Slot {
    GLuint texture = 0;
    std::ptrdiff_t binding = -1;  // index into bindings_
  };
  std::map<std::pair<GLuint, GLenum>, Slot> units_;
  std::map<GLuint, ImageBinding> images_;
  std::map<GLuint, ArrayState> vertexArrays_;
  std::map<std::pair<GLenum, GLuint>, GLuint> indexed_;
  std::map<GLenum, GLuint> plain_;
  std::map<GLuint, GLuint> behind_;  // buffer textures
  std::map<GLuint, std::vector<Sampled>> samplers_;
};

}  // namespace burnish::test
