// GL objects with an owner: created through direct state access (nothing is bound by creating or filling them), deleted
// with their C++ object. All are move-only; a default-constructed one is empty (id 0). A `label` names the object in
// captures and debug messages.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "gl/device.h"
#include "gl/formats.h"

namespace burnish::gl {

/// Owns one GL name.
class Handle {
 public:
  enum class Kind : std::uint8_t { Texture, Buffer, Framebuffer, VertexArray, Sampler, Query, Program };
  Handle() = default;
  Handle(Device& device, Kind kind, GLuint id) : device_(&device), id_(id), kind_(kind) {}
  Handle(Handle&& other) noexcept { *this = std::move(other); }
  Handle& operator=(Handle&& other) noexcept;
  ~Handle() { reset(); }
  void reset();
  /// Books the object's memory with the device (textures and buffers).
  void setBytes(std::int64_t bytes);
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }
  [[nodiscard]] GLuint id() const { return id_; }
  [[nodiscard]] Device& device() const { return *device_; }
  [[nodiscard]] explicit operator bool() const { return id_ != 0; }

 private:
  Device* device_ = nullptr;
  std::int64_t bytes_ = 0;
  GLuint id_ = 0;
  Kind kind_ = Kind::Texture;
};

struct TextureDesc {
  GLenum target = GL_TEXTURE_2D;  ///< GL_TEXTURE_2D, _CUBE_MAP, _2D_ARRAY, _CUBE_MAP_ARRAY
  GLenum format = GL_RGBA8;       ///< one of formats()
  int width = 1, height = 1;
  int layers = 1;  ///< array targets: layers (cube arrays: 6 a cube)
  int levels = 1;  ///< mip levels; 0: the full chain
};
/// Immutable storage. New textures: contents undefined, min/mag nearest (nearest mip when levels > 1), wrap clamp to
/// edge.
class Texture {
 public:
  Texture() = default;
  /// Errors: unknown format, size beyond the device's limit, out of memory.
  static Result<Texture> create(Device& device, const TextureDesc& desc, std::string_view label);
  [[nodiscard]] GLuint id() const { return handle_.id(); }
  [[nodiscard]] explicit operator bool() const { return bool(handle_); }
  /// Replaces a whole level (of one layer or cube face). Rows tight, in the format's own external format and type
  /// unless given. Pixel store must be at GL's defaults (PixelStoreScope or HostStateGuard); alignment is handled here.
  void upload(int level, const void* pixels, int layer = 0, GLenum external = 0, GLenum type = 0);
  /// Part of a level, the same way. Rectangle in texels of that level.
  void uploadRect(int level, int x, int y, int w, int h, const void* pixels, int layer = 0, GLenum external = 0,
                  GLenum type = 0);
  /// Reads a whole level back (all layers), tight rows. Waits for the GPU. `out` must be large enough: bytes of the
  /// level in external × type.
  void read(int level, std::span<std::byte> out, GLenum external = 0, GLenum type = 0) const;
  void generateMips();
  /// Every level and layer to one value (floats; depth formats take x).
  void clear(const std::array<float, 4>& value = {0, 0, 0, 0});
  void setFilter(GLenum minFilter, GLenum magFilter);
  void setWrap(GLenum s, GLenum t);
  void setAnisotropy(float ratio);  ///< clamped to what the device has; nothing when it has none
  void setParameter(GLenum name, GLint value);
  void bind(GLuint unit) const;

  GLenum target = 0, format = 0;
  int width = 0, height = 0, layers = 1, levels = 0;
  std::int64_t bytes = 0;

 private:
  Handle handle_;
};

enum class BufferUse : std::uint8_t {
  Static,   ///< immutable, filled on creation, never written by the CPU again
  Dynamic,  ///< immutable size, subData allowed
  Stream,   ///< write() replaces it whole each frame (orphaned, so the GPU is not waited for) and may grow it
};
class Buffer {
 public:
  Buffer() = default;
  /// bytes 0 gives a buffer of 4 bytes, so that it can be bound. data may be nullptr except with Static.
  static Result<Buffer> create(Device& device, BufferUse use, std::size_t bytes, const void* data,
                               std::string_view label);
  template <class T>
  static Result<Buffer> create(Device& device, BufferUse use, std::span<const T> data, std::string_view label) {
    return create(device, use, data.size_bytes(), data.data(), label);
  }
  [[nodiscard]] GLuint id() const { return handle_.id(); }
  [[nodiscard]] std::size_t size() const { return size_; }  ///< bytes
  [[nodiscard]] explicit operator bool() const { return bool(handle_); }
  /// Dynamic and Stream: replaces a range inside the buffer.
  void subData(std::size_t offset, std::span<const std::byte> data);
  /// Stream: new contents, growing as needed (never shrinking). Error when memory runs out.
  Result<void> write(std::span<const std::byte> data);
  void bindBase(GLenum target, GLuint index) const;  ///< GL_UNIFORM_BUFFER, GL_SHADER_STORAGE_BUFFER
  void bindRange(GLenum target, GLuint index, std::size_t offset, std::size_t bytes) const;

 private:
  Handle handle_;
  std::size_t size_ = 0;
  BufferUse use_ = BufferUse::Static;
};

/// A buffer read through samplerBuffer / usamplerBuffer.
class TextureBuffer {
 public:
  TextureBuffer() = default;
  /// format: GL_RGBA32F, GL_R32UI, ... Errors: more texels than the device allows, out of memory.
  static Result<TextureBuffer> create(Device& device, GLenum format, BufferUse use, std::size_t bytes, const void* data,
                                      std::string_view label);
  [[nodiscard]] GLuint id() const { return handle_.id(); }  ///< of the texture
  [[nodiscard]] const Buffer& buffer() const { return buffer_; }
  [[nodiscard]] explicit operator bool() const { return bool(handle_); }
  Result<void> write(std::span<const std::byte> data);  ///< Stream
  void subData(std::size_t offset, std::span<const std::byte> data) { buffer_.subData(offset, data); }
  void bind(GLuint unit) const;

 private:
  Result<void> checkSize(std::size_t bytes) const;
  Buffer buffer_;  // destroyed after the texture that reads it
  Handle handle_;
  GLenum format_ = 0;
  int texelBytes_ = 0;
  std::string label_;
};

/// What a framebuffer draws to. From a Texture, or from a texture of the host.
struct Attachment {
  GLuint texture = 0;
  GLenum format = 0;  ///< decides depth or depth-stencil
  int level = 0;
  int layer = -1;  ///< array layer or cube face; -1: the whole texture
  Attachment() = default;
  Attachment(const Texture& t, int mip = 0, int layerOrFace = -1)
      : texture(t.id()), format(t.format), level(mip), layer(layerOrFace) {}
};
class Framebuffer {
 public:
  Framebuffer() = default;
  /// Draw buffers follow the colours in order; no colours: GL_NONE. Error when incomplete, with GL's reason.
  static Result<Framebuffer> create(Device& device, std::span<const Attachment> colors,
                                    const std::optional<Attachment>& depth, std::string_view label);
  [[nodiscard]] GLuint id() const { return handle_.id(); }
  [[nodiscard]] explicit operator bool() const { return bool(handle_); }
  void bind(GLenum target = GL_FRAMEBUFFER) const;

 private:
  Handle handle_;
};

struct VertexAttribute {
  GLuint location = 0;
  int components = 3;
  GLenum type = GL_FLOAT;
  bool normalized = false;
  bool integer = false;  ///< ivec/uvec in the shader
  GLuint offset = 0;     ///< bytes within the binding's element
  GLuint binding = 0;
};
struct VertexBinding {
  GLuint buffer = 0;
  std::size_t offset = 0;  ///< bytes
  int stride = 0;          ///< bytes
  GLuint divisor = 0;
};
class VertexArray {
 public:
  VertexArray() = default;
  /// bindings[i] is binding i. Neither list: an array for attribute-less draws. elements 0: no index buffer.
  static VertexArray create(Device& device, std::span<const VertexAttribute> attributes,
                            std::span<const VertexBinding> bindings, GLuint elements, std::string_view label);
  [[nodiscard]] GLuint id() const { return handle_.id(); }
  [[nodiscard]] explicit operator bool() const { return bool(handle_); }
  void setBinding(GLuint index, const VertexBinding& binding);
  void setElements(GLuint buffer);
  void bind() const;

 private:
  Handle handle_;
};

struct SamplerDesc {
  GLenum minFilter = GL_LINEAR, magFilter = GL_LINEAR;
  GLenum wrapS = GL_CLAMP_TO_EDGE, wrapT = GL_CLAMP_TO_EDGE, wrapR = GL_CLAMP_TO_EDGE;
  float anisotropy = 1;  ///< clamped to what the device has
  bool compare = false;  ///< depth comparison: reference >= texel passes (depth is reversed)
  friend bool operator==(const SamplerDesc&, const SamplerDesc&) = default;
};
class Sampler {
 public:
  Sampler() = default;
  static Sampler create(Device& device, const SamplerDesc& desc, std::string_view label);
  [[nodiscard]] GLuint id() const { return handle_.id(); }
  [[nodiscard]] explicit operator bool() const { return bool(handle_); }
  void bind(GLuint unit) const;

 private:
  Handle handle_;
};

class Query {
 public:
  Query() = default;
  /// target: GL_TIMESTAMP, GL_TIME_ELAPSED, GL_SAMPLES_PASSED, ...
  static Query create(Device& device, GLenum target, std::string_view label);
  [[nodiscard]] GLuint id() const { return handle_.id(); }
  [[nodiscard]] explicit operator bool() const { return bool(handle_); }
  void timestamp();                            ///< GL_TIMESTAMP: takes the time when everything before is done
  [[nodiscard]] bool available() const;        ///< never waits
  [[nodiscard]] std::uint64_t result() const;  ///< waits unless available()

 private:
  Handle handle_;
};

/// Pixel store and pixel buffer bindings at GL's defaults (alignment 4) for this scope, then as they were: for uploads
/// and reads outside a HostStateGuard.
class PixelStoreScope {
 public:
  explicit PixelStoreScope(const Device& device);
  ~PixelStoreScope();
  PixelStoreScope(const PixelStoreScope&) = delete;
  PixelStoreScope& operator=(const PixelStoreScope&) = delete;

 private:
  const Device& device_;
  std::array<GLint, 16> values_{};
  GLint packBuffer_ = 0, unpackBuffer_ = 0;
};

}  // namespace burnish::gl
