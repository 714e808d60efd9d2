#include "gl/device.h"

#include <fmt/format.h>

#include <algorithm>

namespace burnish::gl {
namespace {

constexpr std::size_t kMaxErrors = 64;  // a driver that complains on every draw must not eat the memory
constexpr int kErrorPolls = 16;         // a lost context returns an error for ever

const char* errorName(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    case GL_STACK_OVERFLOW:
      return "GL_STACK_OVERFLOW";
    case GL_STACK_UNDERFLOW:
      return "GL_STACK_UNDERFLOW";
    case GL_CONTEXT_LOST:
      return "GL_CONTEXT_LOST";
    default:
      return "unknown GL error";
  }
}

}  // namespace

Result<std::unique_ptr<Device>> Device::create(const ProcAddress& getProcAddress, bool debugOutput) {
  auto caps = queryCapabilities(getProcAddress);
  if (!caps) return fail(caps.error());
  const auto load = [](void* user, const char* name) {
    return reinterpret_cast<GLADapiproc>((*static_cast<const ProcAddress*>(user))(name));
  };
  GladGLContext table{};
  if (!gladLoadGLContextUserPtr(&table, load, const_cast<ProcAddress*>(&getProcAddress)) || !table.VERSION_4_5)
    return fail("OpenGL " + caps->version, "the functions of OpenGL 4.5 core cannot be loaded",
                "install a driver with OpenGL 4.5 core");
  auto device = std::unique_ptr<Device>(new Device(table, std::move(*caps)));
  if (debugOutput) device->installCallback();
  return device;
}

Device::Device(const GladGLContext& table, Capabilities capabilities) : gl(table), caps(std::move(capabilities)) {}

Device::~Device() {
  if (!callback_) return;
  gl.DebugMessageCallback(hostCallback_, hostUser_);
  if (!hostDebug_) gl.Disable(GL_DEBUG_OUTPUT);
  if (!hostSynchronous_) gl.Disable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
}

void Device::installCallback() {
  void* pointer = nullptr;
  gl.GetPointerv(GL_DEBUG_CALLBACK_FUNCTION, &pointer);
  hostCallback_ = reinterpret_cast<GLDEBUGPROC>(pointer);
  gl.GetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &pointer);
  hostUser_ = pointer;
  hostDebug_ = gl.IsEnabled(GL_DEBUG_OUTPUT);
  hostSynchronous_ = gl.IsEnabled(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  gl.Enable(GL_DEBUG_OUTPUT);
  gl.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  gl.DebugMessageCallback(&Device::onMessage, this);
  callback_ = true;
}

void GLAD_API_PTR Device::onMessage(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                    const GLchar* text, const void* user) {
  auto& self = *static_cast<Device*>(const_cast<void*>(user));
  if (self.hostCallback_) self.hostCallback_(source, type, id, severity, length, text, self.hostUser_);
  // What the shader compiler says is returned by ProgramCache as an error of its own, with files named.
  if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
  if (type != GL_DEBUG_TYPE_ERROR && severity != GL_DEBUG_SEVERITY_HIGH) return;
  self.keepError(length >= 0 ? std::string(text, std::size_t(length)) : std::string(text));
}

void Device::keepError(std::string text) {
  const std::scoped_lock lock(mutex_);
  if (errors_.size() < kMaxErrors) errors_.push_back(std::move(text));
}

bool Device::ranOutOfMemory() {
  bool out = false;
  for (int i = 0; i < kErrorPolls; ++i) {
    const GLenum error = gl.GetError();
    if (error == GL_NO_ERROR) break;
    if (error == GL_OUT_OF_MEMORY)
      out = true;
    else
      keepError(fmt::format("glGetError: {}", errorName(error)));
  }
  return out;
}

std::vector<std::string> Device::takeErrors() {
  if (ranOutOfMemory()) keepError("glGetError: GL_OUT_OF_MEMORY");
  std::vector<std::string> taken;
  const std::scoped_lock lock(mutex_);
  taken.swap(errors_);
  return taken;
}

void Device::label(GLenum identifier, GLuint name, std::string_view text) const {
  if (!text.empty()) gl.ObjectLabel(identifier, name, GLsizei(std::min<std::size_t>(text.size(), 200)), text.data());
}

void Device::pushGroup(std::string_view name) const {
  gl.PushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, GLsizei(std::min<std::size_t>(name.size(), 200)), name.data());
}

void Device::popGroup() const { gl.PopDebugGroup(); }

}  // namespace burnish::gl
