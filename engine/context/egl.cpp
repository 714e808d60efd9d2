// EGL without a window. Three ways, in this order (each is tried until one gives OpenGL 4.5 core):
//   EGL_MESA_platform_surfaceless    Mesa, newer NVIDIA
//   EGL_EXT_platform_device          NVIDIA: one display for each device
//   the default display, a pbuffer   everything else (X11, Wayland)
// Where surfaceless gives a software renderer and the machine has a device of its own, the device is preferred (unless
// LIBGL_ALWAYS_SOFTWARE is set). A display is never terminated: EGL shares it with everyone in the process, the host
// included, and eglTerminate would take their contexts too.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>

#include "context/backends.h"
#include "context/library.h"

#ifndef EGL_PLATFORM_SURFACELESS_MESA
#define EGL_PLATFORM_SURFACELESS_MESA 0x31DD
#endif

namespace burnish::context {
namespace {

struct EglApi {
  decltype(&eglGetProcAddress) getProcAddress;
  decltype(&eglGetDisplay) getDisplay;
  decltype(&eglInitialize) initialize;
  decltype(&eglQueryString) queryString;
  decltype(&eglBindAPI) bindApi;
  decltype(&eglQueryAPI) queryApi;
  decltype(&eglChooseConfig) chooseConfig;
  decltype(&eglCreateContext) createContext;
  decltype(&eglDestroyContext) destroyContext;
  decltype(&eglCreatePbufferSurface) createPbuffer;
  decltype(&eglDestroySurface) destroySurface;
  decltype(&eglMakeCurrent) makeCurrent;
  decltype(&eglGetCurrentContext) getCurrentContext;
  decltype(&eglGetError) getError;
};

Result<EglApi> openApi() {
  static constexpr const char* kNames[] = {"libEGL.so.1", "libEGL.so"};
  auto library = Library::open(kNames, "libegl1");
  if (!library) return fail(library.error());
  EglApi api{};
  const char* missing = nullptr;
  const auto load = [&](auto& function, const char* name) {
    function = library->function<std::remove_reference_t<decltype(function)>>(name);
    if (!function) missing = name;
  };
  load(api.getProcAddress, "eglGetProcAddress");
  load(api.getDisplay, "eglGetDisplay");
  load(api.initialize, "eglInitialize");
  load(api.queryString, "eglQueryString");
  load(api.bindApi, "eglBindAPI");
  load(api.queryApi, "eglQueryAPI");
  load(api.chooseConfig, "eglChooseConfig");
  load(api.createContext, "eglCreateContext");
  load(api.destroyContext, "eglDestroyContext");
  load(api.createPbuffer, "eglCreatePbufferSurface");
  load(api.destroySurface, "eglDestroySurface");
  load(api.makeCurrent, "eglMakeCurrent");
  load(api.getCurrentContext, "eglGetCurrentContext");
  load(api.getError, "eglGetError");
  if (missing)
    return fail("EGL", fmt::format("the library lacks {}", missing), "install a current EGL: apt-get install libegl1");
  return api;
}

/// Whether a space-separated list of extensions has one.
bool has(const char* list, std::string_view extension) {
  const std::string_view all = list ? list : "";
  for (std::size_t at = all.find(extension); at != std::string_view::npos; at = all.find(extension, at + 1)) {
    const std::size_t end = at + extension.size();
    if ((at == 0 || all[at - 1] == ' ') && (end == all.size() || all[end] == ' ')) return true;
  }
  return false;
}

class EglContextOf final : public Context {
 public:
  EglContextOf(const EglApi& api, EGLDisplay display, EGLContext context, EGLSurface surface)
      : api_(api), display_(display), context_(context), surface_(surface) {}
  ~EglContextOf() override {
    release();
    if (surface_ != EGL_NO_SURFACE) api_.destroySurface(display_, surface_);
    api_.destroyContext(display_, context_);
  }
  Result<void> makeCurrent() override {
    release();  // EGL skips the work when it thinks that the context is current, which another library (OSMesa) may
                // have changed behind its back
    api_.bindApi(EGL_OPENGL_API);  // per thread
    if (!api_.makeCurrent(display_, surface_, surface_, context_))
      return fail("EGL", fmt::format("the context cannot be made current (EGL error {:#x})", api_.getError()),
                  "release it on the thread that has it");
    return {};
  }
  void release() override {
    api_.bindApi(EGL_OPENGL_API);
    if (api_.getCurrentContext() == context_)
      api_.makeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  [[nodiscard]] ProcAddress procAddress() const override {
    return [get = api_.getProcAddress](const char* name) { return reinterpret_cast<void*>(get(name)); };
  }
  [[nodiscard]] Backend backend() const override { return Backend::Egl; }

 private:
  EglApi api_;
  EGLDisplay display_;
  EGLContext context_;
  EGLSurface surface_;
};

EGLContext tryCreate(const EglApi& api, EGLDisplay display, EGLConfig config, int major, int minor, bool debug) {
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               major,
                               EGL_CONTEXT_MINOR_VERSION,
                               minor,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_CONTEXT_OPENGL_DEBUG,
                               debug ? EGL_TRUE : EGL_FALSE,
                               EGL_NONE};
  return api.createContext(display, config, EGL_NO_CONTEXT, attributes);
}

/// A context on one display. `how` names the way for errors.
Result<std::unique_ptr<Context>> openOn(const EglApi& api, EGLDisplay display, const char* how, bool debug) {
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || !api.initialize(display, &major, &minor))
    return fail(fmt::format("EGL ({})", how), fmt::format("no display (EGL error {:#x})", api.getError()));
  const std::string place = fmt::format("EGL {}.{} ({})", major, minor, how);
  const char* extensions = api.queryString(display, EGL_EXTENSIONS);
  if (!has(extensions, "EGL_KHR_create_context") && (major < 1 || (major == 1 && minor < 5)))
    return fail(place, "neither EGL 1.5 nor EGL_KHR_create_context, which core profiles need");
  if (!api.bindApi(EGL_OPENGL_API)) return fail(place, "desktop OpenGL is missing, OpenGL 4.5 core needed");
  const bool surfaceless = has(extensions, "EGL_KHR_surfaceless_context");
  const EGLint wanted[] = {EGL_SURFACE_TYPE,
                           surfaceless ? 0 : EGL_PBUFFER_BIT,
                           EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_BIT,
                           EGL_RED_SIZE,
                           8,
                           EGL_GREEN_SIZE,
                           8,
                           EGL_BLUE_SIZE,
                           8,
                           EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!api.chooseConfig(display, wanted, &config, 1, &count) || count < 1) {
    if (!surfaceless || !has(extensions, "EGL_KHR_no_config_context"))
      return fail(place, "no configuration for OpenGL with 8-bit colour");
    config = nullptr;  // EGL_NO_CONFIG_KHR
  }
  EGLContext context = tryCreate(api, display, config, 4, 5, debug);
  const bool enough = context != EGL_NO_CONTEXT;
  if (!enough) context = tryCreate(api, display, config, 3, 2, false);  // only to say what there is
  if (context == EGL_NO_CONTEXT)
    return fail(place, fmt::format("no OpenGL core context (EGL error {:#x}), 4.5 core needed", api.getError()));
  EGLSurface surface = EGL_NO_SURFACE;
  if (!surfaceless) {
    const EGLint size[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
    surface = api.createPbuffer(display, config, size);
  }
  auto owner = std::make_unique<EglContextOf>(api, display, context, surface);
  if (auto current = owner->makeCurrent(); !current) return fail(current.error());
  if (!enough) return fail(place, describeCurrent(owner->procAddress()) + " found, 4.5 core needed");
  return owner;
}

bool isSoftware(const Context& context) {
  auto caps = queryCapabilities(context.procAddress());
  return !caps || caps->software;
}

/// The displays of the machine's own devices (software ones left out).
std::vector<EGLDisplay> deviceDisplays(const EglApi& api, const char* clientExtensions) {
  std::vector<EGLDisplay> displays;
  const auto getDisplay =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(api.getProcAddress("eglGetPlatformDisplayEXT"));
  const auto queryDevices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(api.getProcAddress("eglQueryDevicesEXT"));
  const auto queryDeviceString =
      reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(api.getProcAddress("eglQueryDeviceStringEXT"));
  const bool enumerates =
      has(clientExtensions, "EGL_EXT_device_base") || has(clientExtensions, "EGL_EXT_device_enumeration");
  if (!getDisplay || !queryDevices || !enumerates || !has(clientExtensions, "EGL_EXT_platform_device")) return displays;
  EGLDeviceEXT devices[16];
  EGLint count = 0;
  if (!queryDevices(16, devices, &count)) return displays;
  for (EGLint i = 0; i < count; ++i)
    if (!queryDeviceString || !has(queryDeviceString(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software"))
      displays.push_back(getDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
  return displays;
}

}  // namespace

Result<std::unique_ptr<Context>> createEgl(const ContextOptions& options) {
  auto api = openApi();
  if (!api) return fail(api.error());
  const char* client = api->queryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::string tried;
  const auto note = [&](const Error& e) { tried += (tried.empty() ? "" : "; ") + e.message(); };

  std::unique_ptr<Context> software;
  const auto platformDisplay =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(api->getProcAddress("eglGetPlatformDisplayEXT"));
  if (platformDisplay && has(client, "EGL_MESA_platform_surfaceless")) {
    const EGLDisplay display =
        platformDisplay(EGL_PLATFORM_SURFACELESS_MESA, reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY), nullptr);
    auto made = openOn(*api, display, "surfaceless", options.debug);
    if (made && (std::getenv("LIBGL_ALWAYS_SOFTWARE") || !isSoftware(**made))) return made;
    if (made)
      software = std::move(*made);
    else
      note(made.error());
  } else {
    note({"EGL (surfaceless)", "EGL_MESA_platform_surfaceless is missing", ""});
  }
  for (const EGLDisplay display : deviceDisplays(*api, client)) {
    auto made = openOn(*api, display, "device", options.debug);
    if (made) return made;
    note(made.error());
  }
  if (software) {
    if (auto current = software->makeCurrent(); !current) return fail(current.error());
    return software;
  }
  auto made = openOn(*api, api->getDisplay(EGL_DEFAULT_DISPLAY), "default display", options.debug);
  if (made) return made;
  note(made.error());
  return fail("EGL", tried, "install a driver with OpenGL 4.5 (apt-get install libegl-mesa0), or use OSMesa");
}

}  // namespace burnish::context
