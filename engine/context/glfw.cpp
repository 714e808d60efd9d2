// A window through GLFW. GLFW is for the process's main thread: create, present and destroy windows there; other
// threads may only make the context current.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <mutex>

#include "context/backends.h"

namespace burnish::context {
namespace {

std::string glfwProblem() {
  const char* text = nullptr;
  const int code = glfwGetError(&text);
  return code == GLFW_NO_ERROR ? "GLFW gives no reason" : fmt::format("GLFW says: {}", text ? text : "unknown error");
}

/// Initialises GLFW while anyone uses it. GLFW has one state per process, so this count must be per process too: the
/// engine's one exception to "no globals". Where the host had initialised GLFW before, the host goes on owning it.
class GlfwUse {
 public:
  static Result<std::shared_ptr<GlfwUse>> acquire() {
    static std::mutex mutex;
    static std::weak_ptr<GlfwUse> shared;
    const std::scoped_lock lock(mutex);
    if (auto use = shared.lock()) return use;
    glfwGetError(nullptr);
    (void)glfwGetTime();
    const bool ours = glfwGetError(nullptr) == GLFW_NOT_INITIALIZED;
    if (ours && !glfwInit())
      return fail("GLFW", glfwProblem(),
                  "set DISPLAY to a running X server (or start under xvfb-run), or use egl or osmesa");
    auto use = std::shared_ptr<GlfwUse>(new GlfwUse(ours));
    shared = use;
    return use;
  }
  ~GlfwUse() {
    if (ours_) glfwTerminate();
  }
  GlfwUse(const GlfwUse&) = delete;
  GlfwUse& operator=(const GlfwUse&) = delete;

 private:
  explicit GlfwUse(bool ours) : ours_(ours) {}
  bool ours_;
};

class GlfwContextOf final : public Context {
 public:
  GlfwContextOf(std::shared_ptr<GlfwUse> use, GLFWwindow* window) : use_(std::move(use)), window_(window) {}
  ~GlfwContextOf() override {
    release();
    glfwDestroyWindow(window_);
  }
  Result<void> makeCurrent() override {
    release();  // as in egl.cpp: GLX and EGL skip the work when they think that the context is current
    glfwGetError(nullptr);
    glfwMakeContextCurrent(window_);
    if (glfwGetCurrentContext() != window_)
      return fail("GLFW", "the context cannot be made current: " + glfwProblem(),
                  "release it on the thread that has it");
    return {};
  }
  void release() override {
    if (glfwGetCurrentContext() == window_) glfwMakeContextCurrent(nullptr);
  }
  [[nodiscard]] ProcAddress procAddress() const override {
    return [](const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); };
  }
  [[nodiscard]] Backend backend() const override { return Backend::Glfw; }
  bool present() override {
    glfwSwapBuffers(window_);
    glfwPollEvents();
    return !glfwWindowShouldClose(window_);
  }
  [[nodiscard]] void* window() const override { return window_; }

 private:
  std::shared_ptr<GlfwUse> use_;
  GLFWwindow* window_;
};

GLFWwindow* tryCreate(const ContextOptions& options, int major, int minor, bool visible) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_API);
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, options.glfwEgl ? GLFW_EGL_CONTEXT_API : GLFW_NATIVE_CONTEXT_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, major);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, options.debug ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_VISIBLE, visible ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_SAMPLES, 0);
  return glfwCreateWindow(options.width, options.height, options.title ? options.title : "burnish", nullptr, nullptr);
}

}  // namespace

Result<std::unique_ptr<Context>> createGlfw(const ContextOptions& options) {
  if (options.width < 1 || options.height < 1)
    return fail("GLFW", fmt::format("a {}x{} window was asked for", options.width, options.height),
                "use positive sizes");
  auto use = GlfwUse::acquire();
  if (!use) return fail(use.error());
  const std::string place = options.glfwEgl ? "GLFW (EGL)" : "GLFW (GLX)";
  glfwGetError(nullptr);
  if (GLFWwindow* window = tryCreate(options, 4, 5, options.visible)) {
    auto owner = std::make_unique<GlfwContextOf>(std::move(*use), window);
    if (auto current = owner->makeCurrent(); !current) return fail(current.error());
    glfwSwapInterval(0);  // the frame loop decides about pace
    return owner;
  }
  const std::string problem = glfwProblem();
  GLFWwindow* lesser = tryCreate(options, 3, 2, false);
  if (!lesser)
    return fail(place, "no window with an OpenGL core context: " + problem,
                "install a driver (apt-get install libgl1-mesa-dri libegl-mesa0), or use egl or osmesa");
  GlfwContextOf owner(std::move(*use), lesser);
  const std::string found =
      owner.makeCurrent() ? describeCurrent(owner.procAddress()) : "a context that cannot be made current";
  return fail(place, found + " found, 4.5 core needed (" + problem + ")",
              "install a newer driver, or use egl or osmesa");
}

}  // namespace burnish::context
