// Handles, framebuffers, vertex arrays, samplers, queries, pixel store. Textures and buffers: texture.cpp, buffer.cpp.
#include "gl/objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace burnish::gl {

Handle& Handle::operator=(Handle&& other) noexcept {
  if (this == &other) return *this;
  reset();
  device_ = std::exchange(other.device_, nullptr);
  bytes_ = std::exchange(other.bytes_, 0);
  id_ = std::exchange(other.id_, 0);
  kind_ = other.kind_;
  return *this;
}

void Handle::reset() {
  if (!id_) return;
  setBytes(0);
  const GladGLContext& gl = device_->gl;
  switch (kind_) {
    case Kind::Texture:
      gl.DeleteTextures(1, &id_);
      break;
    case Kind::Buffer:
      gl.DeleteBuffers(1, &id_);
      break;
    case Kind::Framebuffer:
      gl.DeleteFramebuffers(1, &id_);
      break;
    case Kind::VertexArray:
      gl.DeleteVertexArrays(1, &id_);
      break;
    case Kind::Sampler:
      gl.DeleteSamplers(1, &id_);
      break;
    case Kind::Query:
      gl.DeleteQueries(1, &id_);
      break;
    case Kind::Program:
      gl.DeleteProgram(id_);
      break;
  }
  id_ = 0;
}

void Handle::setBytes(std::int64_t bytes) {
  if (kind_ == Kind::Texture) device_->addTextureBytes(bytes - bytes_);
  if (kind_ == Kind::Buffer) device_->addBufferBytes(bytes - bytes_);
  bytes_ = bytes;
}

namespace {

const char* statusName(GLenum status) {
  switch (status) {
    case GL_FRAMEBUFFER_UNDEFINED:
      return "undefined";
    case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
      return "an attachment is incomplete";
    case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
      return "it has no attachment";
    case GL_FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER:
      return "a draw buffer has no attachment";
    case GL_FRAMEBUFFER_INCOMPLETE_READ_BUFFER:
      return "the read buffer has no attachment";
    case GL_FRAMEBUFFER_UNSUPPORTED:
      return "the driver does not support this combination of formats";
    case GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE:
      return "attachments differ in samples";
    case GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS:
      return "layered and unlayered attachments are mixed";
    default:
      return "unknown status";
  }
}

std::string formatList(std::span<const Attachment> colors, const std::optional<Attachment>& depth) {
  std::string list;
  const auto add = [&](GLenum format) {
    const FormatInfo* info = formatInfo(format);
    list += (list.empty() ? "" : ", ") + (info ? std::string(info->name) : fmt::format("{:#x}", format));
  };
  for (const Attachment& a : colors) add(a.format);
  if (depth) add(depth->format);
  return list;
}

}  // namespace

Result<Framebuffer> Framebuffer::create(Device& device, std::span<const Attachment> colors,
                                        const std::optional<Attachment>& depth, std::string_view label) {
  if (colors.size() > 8)
    return fail(fmt::format("framebuffer \"{}\"", label), fmt::format("{} colour attachments", colors.size()),
                "use at most 8");
  const GladGLContext& gl = device.gl;
  GLuint id = 0;
  gl.CreateFramebuffers(1, &id);
  Framebuffer made;
  made.handle_ = Handle(device, Handle::Kind::Framebuffer, id);
  const auto attach = [&](GLenum point, const Attachment& a) {
    if (a.layer < 0)
      gl.NamedFramebufferTexture(id, point, a.texture, a.level);
    else
      gl.NamedFramebufferTextureLayer(id, point, a.texture, a.level, a.layer);
  };
  std::array<GLenum, 8> buffers{};
  for (std::size_t i = 0; i < colors.size(); ++i) {
    buffers[i] = GL_COLOR_ATTACHMENT0 + GLenum(i);
    attach(buffers[i], colors[i]);
  }
  if (depth) {
    const FormatInfo* info = formatInfo(depth->format);
    attach(info && info->stencil() ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, *depth);
  }
  if (colors.empty()) {
    gl.NamedFramebufferDrawBuffer(id, GL_NONE);
    gl.NamedFramebufferReadBuffer(id, GL_NONE);
  } else {
    gl.NamedFramebufferDrawBuffers(id, GLsizei(colors.size()), buffers.data());
  }
  const GLenum status = gl.CheckNamedFramebufferStatus(id, GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    return fail(fmt::format("framebuffer \"{}\"", label),
                fmt::format("incomplete: {} ({})", statusName(status), formatList(colors, depth)),
                "this is a fault of the engine or of the driver: report it with the output of burnish doctor");
  device.label(GL_FRAMEBUFFER, id, label);
  return made;
}

void Framebuffer::bind(GLenum target) const { handle_.device().gl.BindFramebuffer(target, id()); }

VertexArray VertexArray::create(Device& device, std::span<const VertexAttribute> attributes,
                                std::span<const VertexBinding> bindings, GLuint elements, std::string_view label) {
  const GladGLContext& gl = device.gl;
  GLuint id = 0;
  gl.CreateVertexArrays(1, &id);
  VertexArray made;
  made.handle_ = Handle(device, Handle::Kind::VertexArray, id);
  for (const VertexAttribute& a : attributes) {
    gl.EnableVertexArrayAttrib(id, a.location);
    if (a.integer)
      gl.VertexArrayAttribIFormat(id, a.location, a.components, a.type, a.offset);
    else
      gl.VertexArrayAttribFormat(id, a.location, a.components, a.type, a.normalized ? GL_TRUE : GL_FALSE, a.offset);
    gl.VertexArrayAttribBinding(id, a.location, a.binding);
  }
  for (std::size_t i = 0; i < bindings.size(); ++i) made.setBinding(GLuint(i), bindings[i]);
  if (elements) made.setElements(elements);
  device.label(GL_VERTEX_ARRAY, id, label);
  return made;
}

void VertexArray::setBinding(GLuint index, const VertexBinding& b) {
  const GladGLContext& gl = handle_.device().gl;
  gl.VertexArrayVertexBuffer(id(), index, b.buffer, GLintptr(b.offset), b.stride);
  gl.VertexArrayBindingDivisor(id(), index, b.divisor);
}

void VertexArray::setElements(GLuint buffer) { handle_.device().gl.VertexArrayElementBuffer(id(), buffer); }
void VertexArray::bind() const { handle_.device().gl.BindVertexArray(id()); }

Sampler Sampler::create(Device& device, const SamplerDesc& desc, std::string_view label) {
  const GladGLContext& gl = device.gl;
  GLuint id = 0;
  gl.CreateSamplers(1, &id);
  Sampler made;
  made.handle_ = Handle(device, Handle::Kind::Sampler, id);
  gl.SamplerParameteri(id, GL_TEXTURE_MIN_FILTER, GLint(desc.minFilter));
  gl.SamplerParameteri(id, GL_TEXTURE_MAG_FILTER, GLint(desc.magFilter));
  gl.SamplerParameteri(id, GL_TEXTURE_WRAP_S, GLint(desc.wrapS));
  gl.SamplerParameteri(id, GL_TEXTURE_WRAP_T, GLint(desc.wrapT));
  gl.SamplerParameteri(id, GL_TEXTURE_WRAP_R, GLint(desc.wrapR));
  if (desc.anisotropy > 1 && device.caps.anisotropic) {
    GLfloat most = 1;
    gl.GetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &most);
    gl.SamplerParameterf(id, GL_TEXTURE_MAX_ANISOTROPY_EXT, std::min(desc.anisotropy, most));
  }
  if (desc.compare) {
    gl.SamplerParameteri(id, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl.SamplerParameteri(id, GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
  }
  device.label(GL_SAMPLER, id, label);
  return made;
}

void Sampler::bind(GLuint unit) const { handle_.device().gl.BindSampler(unit, id()); }

Query Query::create(Device& device, GLenum target, std::string_view label) {
  GLuint id = 0;
  device.gl.CreateQueries(target, 1, &id);
  Query made;
  made.handle_ = Handle(device, Handle::Kind::Query, id);
  device.label(GL_QUERY, id, label);
  return made;
}

void Query::timestamp() { handle_.device().gl.QueryCounter(id(), GL_TIMESTAMP); }

bool Query::available() const {
  GLint ready = 0;
  handle_.device().gl.GetQueryObjectiv(id(), GL_QUERY_RESULT_AVAILABLE, &ready);
  return ready != 0;
}

std::uint64_t Query::result() const {
  GLuint64 value = 0;
  handle_.device().gl.GetQueryObjectui64v(id(), GL_QUERY_RESULT, &value);
  return value;
}

namespace {

constexpr std::array<GLenum, 16> kPixelStore = {
    GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST,   GL_UNPACK_ROW_LENGTH,  GL_UNPACK_IMAGE_HEIGHT,
    GL_UNPACK_SKIP_ROWS,  GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_IMAGES, GL_UNPACK_ALIGNMENT,
    GL_PACK_SWAP_BYTES,   GL_PACK_LSB_FIRST,     GL_PACK_ROW_LENGTH,    GL_PACK_IMAGE_HEIGHT,
    GL_PACK_SKIP_ROWS,    GL_PACK_SKIP_PIXELS,   GL_PACK_SKIP_IMAGES,   GL_PACK_ALIGNMENT};

}  // namespace

PixelStoreScope::PixelStoreScope(const Device& device) : device_(device) {
  const GladGLContext& gl = device.gl;
  for (std::size_t i = 0; i < kPixelStore.size(); ++i) {
    gl.GetIntegerv(kPixelStore[i], &values_[i]);
    gl.PixelStorei(kPixelStore[i],
                   kPixelStore[i] == GL_UNPACK_ALIGNMENT || kPixelStore[i] == GL_PACK_ALIGNMENT ? 4 : 0);
  }
  gl.GetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &packBuffer_);
  gl.GetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &unpackBuffer_);
  gl.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

PixelStoreScope::~PixelStoreScope() {
  const GladGLContext& gl = device_.gl;
  for (std::size_t i = 0; i < kPixelStore.size(); ++i) gl.PixelStorei(kPixelStore[i], values_[i]);
  gl.BindBuffer(GL_PIXEL_PACK_BUFFER, GLuint(packBuffer_));
  gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, GLuint(unpackBuffer_));
}

}  // namespace burnish::gl
