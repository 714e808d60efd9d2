// OpenGL 4.5 core contexts without or with a window, and what they can do. A host that has its own context needs only ProcAddress.
#pragma once
#include <burnish/result.h>

#include <cstdint>
#include <functional>
#include <memory>

namespace burnish {

/// Returns the address of a GL function, or nullptr. The function must stay valid while the context lives.
using ProcAddress = std::function<void*(const char* name)>;

enum class Backend : std::uint8_t { Egl, OsMesa, Glfw };

struct ContextOptions {
  Backend backend = Backend::Egl;
  int width = 64, height = 64;  ///< window size (Glfw)
  bool debug = false;           ///< ask for a debug context
  bool visible = true;          ///< Glfw: show the window
  bool glfwEgl = false;         ///< Glfw: create the context through EGL in place of GLX
  const char* title = "burnish";
};

/// A context that the engine opened. Current on one thread at a time. Several may live in one process, one current on each thread.
/// Contexts of different backends do not know of each other: before one is made current (create() does it), release() the other on that thread.
/// Glfw: create, present and destroy on the process's main thread, as GLFW demands; GLFW stays initialised while a window lives, longer if the host did it.
class BURNISH_API Context {
 public:
  /// Opens it and makes it current on this thread. Errors name the library or feature that is missing and what was found.
  static Result<std::unique_ptr<Context>> create(const ContextOptions& options);
  virtual ~Context() = default;
  virtual Result<void> makeCurrent() = 0;
  virtual void release() = 0;  ///< no context current on this thread afterwards
  [[nodiscard]] virtual ProcAddress procAddress() const = 0;
  [[nodiscard]] virtual Backend backend() const = 0;
  /// Shows framebuffer 0 and handles events; false once the window was closed. Headless contexts return true.
  virtual bool present() { return true; }
  /// The GLFWwindow*, for Backend::Glfw; else nullptr.
  [[nodiscard]] virtual void* window() const { return nullptr; }
};

BURNISH_API std::string_view backendName(Backend b);  ///< "egl", "osmesa", "glfw"

/// What a current context can do. All that makePlan knows of the machine.
struct Capabilities {
  std::string vendor, renderer, version;
  int major = 0, minor = 0;
  bool software = false;  ///< llvmpipe, softpipe, swrast or SwiftShader
  bool anisotropic = false, programBinary = false, debugOutput = false, parallelCompile = false, drawParameters = false, timerQueries = false;
  int maxTextureSize = 0, maxTextureUnits = 0, maxUniformBlockBytes = 0, maxTextureBufferTexels = 0, uniformAlignment = 256;
  float maxPointSize = 1;
  std::int64_t maxStorageBlockBytes = 0;
  std::vector<std::string> extensions;  ///< sorted
};
/// Reads the capabilities of the context that is current on this thread. Error when it is under 4.5 core or lacks what the engine needs, with what was found.
BURNISH_API Result<Capabilities> queryCapabilities(const ProcAddress& getProcAddress);

}  // namespace burnish
