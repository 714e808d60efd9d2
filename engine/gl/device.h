// One OpenGL context as the engine sees it: the function table, what it can do, what it complained about, and how much
// memory hangs on it.
#pragma once
#include <burnish/context.h>
#include <glad/gl.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace burnish::gl {

/// Per context; nothing is global. Every GL object of the engine keeps a pointer to its Device, so it must outlive them
/// all. All members are for the thread on which the context is current.
class Device {
 public:
  /// The context must be current on this thread. debugOutput installs a KHR_debug callback that collects errors (and
  /// passes every message on to a callback that the host had installed before); the host's comes back when the Device
  /// is destroyed.
  static Result<std::unique_ptr<Device>> create(const ProcAddress& getProcAddress, bool debugOutput);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const GladGLContext gl;  ///< gl.CreateTextures(...): GL's names without the prefix
  const Capabilities caps;

  /// Debug messages of type error or of high severity, and what glGetError still held, since the last call; oldest
  /// first.
  [[nodiscard]] std::vector<std::string> takeErrors();
  /// What the driver was asked to keep for textures and buffers that are alive, in bytes.
  [[nodiscard]] std::int64_t bytesAllocated() const { return textureBytes_ + bufferBytes_; }
  [[nodiscard]] std::int64_t textureBytes() const { return textureBytes_; }
  [[nodiscard]] std::int64_t bufferBytes() const { return bufferBytes_; }

  /// Names an object for RenderDoc, apitrace and debug messages. `identifier`: GL_TEXTURE, GL_BUFFER, GL_PROGRAM, ...
  void label(GLenum identifier, GLuint name, std::string_view text) const;
  void pushGroup(std::string_view name) const;
  void popGroup() const;

  /// Whether the last calls ran out of memory. Other errors that glGetError holds are kept for takeErrors().
  [[nodiscard]] bool ranOutOfMemory();

  /// For the objects of objects.h: books memory of a texture or buffer in or out.
  void addTextureBytes(std::int64_t delta) { textureBytes_ += delta; }
  void addBufferBytes(std::int64_t delta) { bufferBytes_ += delta; }

 private:
  Device(const GladGLContext& table, Capabilities capabilities);
  void installCallback();
  void keepError(std::string text);
  static void GLAD_API_PTR onMessage(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                     const GLchar* text, const void* user);

  std::int64_t textureBytes_ = 0, bufferBytes_ = 0;
  std::mutex mutex_;  ///< a driver may call back from a thread of its own
  std::vector<std::string> errors_;
  bool callback_ = false, hostDebug_ = false, hostSynchronous_ = false;
  GLDEBUGPROC hostCallback_ = nullptr;
  const void* hostUser_ = nullptr;
};

/// A named range of commands in captures.
class DebugGroup {
 public:
  DebugGroup(const Device& device, std::string_view name) : device_(device) { device_.pushGroup(name); }
  ~DebugGroup() { device_.popGroup(); }
  DebugGroup(const DebugGroup&) = delete;
  DebugGroup& operator=(const DebugGroup&) = delete;

 private:
  const Device& device_;
};

}  // namespace burnish::gl
