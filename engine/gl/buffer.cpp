#include <fmt/format.h>

#include <algorithm>

#include "gl/objects.h"

namespace burnish::gl {
namespace {

Error noMemory(std::string_view label, std::size_t bytes) {
  return {fmt::format("buffer \"{}\"", label), fmt::format("no memory for {} MiB", bytes >> 20), "use a smaller scene"};
}

}  // namespace

Result<Buffer> Buffer::create(Device& device, BufferUse use, std::size_t bytes, const void* data,
                              std::string_view label) {
  const GladGLContext& gl = device.gl;
  const std::size_t size = std::max<std::size_t>(bytes, 4);
  const void* const contents = bytes >= 4 ? data : nullptr;
  GLuint id = 0;
  gl.CreateBuffers(1, &id);
  Buffer made;
  made.handle_ = Handle(device, Handle::Kind::Buffer, id);
  made.size_ = size;
  made.use_ = use;
  if (use == BufferUse::Stream)
    gl.NamedBufferData(id, GLsizeiptr(size), contents, GL_STREAM_DRAW);
  else
    gl.NamedBufferStorage(id, GLsizeiptr(size), contents,
                          use == BufferUse::Dynamic || !contents ? GL_DYNAMIC_STORAGE_BIT : 0);
  if (device.ranOutOfMemory()) return fail(noMemory(label, size));
  if (!contents && data && bytes) gl.NamedBufferSubData(id, 0, GLsizeiptr(bytes), data);  // under 4 bytes
  made.handle_.setBytes(std::int64_t(size));
  device.label(GL_BUFFER, id, label);
  return made;
}

void Buffer::subData(std::size_t offset, std::span<const std::byte> data) {
  if (!data.empty())
    handle_.device().gl.NamedBufferSubData(id(), GLintptr(offset), GLsizeiptr(data.size()), data.data());
}

Result<void> Buffer::write(std::span<const std::byte> data) {
  const GladGLContext& gl = handle_.device().gl;
  if (data.size() > size_) {
    const std::size_t grown = std::max(data.size(), size_ + size_ / 2);
    gl.NamedBufferData(id(), GLsizeiptr(grown), nullptr, GL_STREAM_DRAW);
    if (handle_.device().ranOutOfMemory()) return fail(noMemory("stream", grown));
    size_ = grown;
    handle_.setBytes(std::int64_t(grown));
  } else {
    gl.NamedBufferData(id(), GLsizeiptr(size_), nullptr,
                       GL_STREAM_DRAW);  // orphan: the GPU keeps the old store while it reads it
  }
  subData(0, data);
  return {};
}

void Buffer::bindBase(GLenum target, GLuint index) const { handle_.device().gl.BindBufferBase(target, index, id()); }
void Buffer::bindRange(GLenum target, GLuint index, std::size_t offset, std::size_t bytes) const {
  handle_.device().gl.BindBufferRange(target, index, id(), GLintptr(offset), GLsizeiptr(bytes));
}

Result<TextureBuffer> TextureBuffer::create(Device& device, GLenum format, BufferUse use, std::size_t bytes,
                                            const void* data, std::string_view label) {
  const FormatInfo* info = formatInfo(format);
  if (!info)
    return fail(fmt::format("buffer texture \"{}\"", label),
                fmt::format("format {:#x} is not in the engine's list", format), "add it to engine/gl/formats.cpp");
  TextureBuffer made;
  made.texelBytes_ = info->bytes;
  made.label_ = label;
  made.format_ = format;
  GLuint id = 0;
  device.gl.CreateTextures(GL_TEXTURE_BUFFER, 1, &id);
  made.handle_ = Handle(device, Handle::Kind::Texture, id);
  if (auto fits = made.checkSize(bytes); !fits) return fail(fits.error());
  // At least one texel, so that a fetch in a shader that needs none is still defined.
  auto buffer = bytes >= std::size_t(info->bytes)
                    ? Buffer::create(device, use, bytes, data, label)
                    : Buffer::create(device, use == BufferUse::Static ? BufferUse::Dynamic : use,
                                     std::size_t(info->bytes), nullptr, label);
  if (!buffer) return fail(buffer.error());
  made.buffer_ = std::move(*buffer);
  device.gl.TextureBuffer(id, format, made.buffer_.id());
  device.label(GL_TEXTURE, id, label);
  return made;
}

Result<void> TextureBuffer::checkSize(std::size_t bytes) const {
  const auto texels = bytes / std::size_t(texelBytes_);
  const auto most = std::size_t(handle_.device().caps.maxTextureBufferTexels);
  if (texels > most)
    return fail(fmt::format("buffer texture \"{}\"", label_),
                fmt::format("{} texels; this device has at most {}", texels, most), "use a smaller scene");
  return {};
}

Result<void> TextureBuffer::write(std::span<const std::byte> data) {
  if (auto fits = checkSize(data.size()); !fits) return fits;
  const std::size_t before = buffer_.size();
  auto done = buffer_.write(data);
  // A buffer texture covers its buffer's store; some drivers keep the size of the moment of attaching, so attach a
  // grown one again.
  if (done && buffer_.size() != before) handle_.device().gl.TextureBuffer(id(), format_, buffer_.id());
  return done;
}

void TextureBuffer::bind(GLuint unit) const { handle_.device().gl.BindTextureUnit(unit, id()); }

}  // namespace burnish::gl
