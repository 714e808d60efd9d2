// OSMesa: Mesa's software renderer into memory of ours; needs neither a display nor a device.
#include <GL/osmesa.h>
#include <fmt/format.h>

#include "context/backends.h"
#include "context/library.h"

namespace burnish::context {
namespace {

struct OsMesaApi {
  Library library;
  decltype(&OSMesaCreateContextAttribs) createContextAttribs;
  decltype(&OSMesaDestroyContext) destroyContext;
  decltype(&OSMesaMakeCurrent) makeCurrent;
  decltype(&OSMesaGetProcAddress) getProcAddress;
  decltype(&OSMesaGetCurrentContext) getCurrentContext;
};

Result<OsMesaApi> openApi() {
  static constexpr const char* kNames[] = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
  auto library = Library::open(kNames, "libosmesa6");
  if (!library) return fail(library.error());
  OsMesaApi api{*library,
                library->function<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs"),
                library->function<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext"),
                library->function<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent"),
                library->function<decltype(&OSMesaGetProcAddress)>("OSMesaGetProcAddress"),
                library->function<decltype(&OSMesaGetCurrentContext)>("OSMesaGetCurrentContext")};
  if (!api.createContextAttribs || !api.destroyContext || !api.makeCurrent || !api.getProcAddress ||
      !api.getCurrentContext)
    return fail("OSMesa", "the library lacks OSMesaCreateContextAttribs (Mesa before 12)",
                "install a newer Mesa: apt-get install libosmesa6");
  return api;
}

class OsMesaContextOf final : public Context {
 public:
  OsMesaContextOf(OsMesaApi api, OSMesaContext context, int width, int height)
      : api_(api),
        context_(context),
        width_(width),
        height_(height),
        pixels_(std::size_t(width) * std::size_t(height) * 4) {}
  ~OsMesaContextOf() override {
    release();
    api_.destroyContext(context_);
  }
  Result<void> makeCurrent() override {
    if (!api_.makeCurrent(context_, pixels_.data(), GL_UNSIGNED_BYTE, width_, height_))
      return fail("OSMesa", fmt::format("the context cannot be made current with a {}x{} buffer", width_, height_),
                  "release it on the thread that has it");
    return {};
  }
  void release() override {
    if (api_.getCurrentContext() == context_) api_.makeCurrent(nullptr, nullptr, 0, 0, 0);
  }
  [[nodiscard]] ProcAddress procAddress() const override {
    return [get = api_.getProcAddress](const char* name) { return reinterpret_cast<void*>(get(name)); };
  }
  [[nodiscard]] Backend backend() const override { return Backend::OsMesa; }

 private:
  OsMesaApi api_;
  OSMesaContext context_;
  int width_, height_;
  std::vector<unsigned char> pixels_;  // framebuffer 0
};

OSMesaContext tryCreate(const OsMesaApi& api, int major, int minor) {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            24,
                            OSMESA_STENCIL_BITS,
                            8,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            major,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            minor,
                            0};
  return api.createContextAttribs(attributes, nullptr);
}

/// What the library has in place of 4.5, found by opening its oldest core context.
std::string describeBest(const OsMesaApi& api) {
  OSMesaContext context = tryCreate(api, 3, 2);
  if (!context) return "no OpenGL core context at all";
  OsMesaContextOf owner(api, context, 16, 16);
  return owner.makeCurrent() ? describeCurrent(owner.procAddress()) : "a context that cannot be made current";
}

}  // namespace

Result<std::unique_ptr<Context>> createOsMesa(const ContextOptions& options) {
  if (options.width < 1 || options.height < 1 || options.width > 16384 || options.height > 16384)
    return fail("OSMesa", fmt::format("a {}x{} buffer was asked for", options.width, options.height),
                "use sizes from 1 to 16384");
  auto api = openApi();
  if (!api) return fail(api.error());
  OSMesaContext context = tryCreate(*api, 4, 5);
  if (!context)
    return fail("OSMesa", describeBest(*api) + " found, 4.5 core needed",
                "install a newer Mesa: apt-get install libosmesa6");
  auto owner = std::make_unique<OsMesaContextOf>(*api, context, options.width, options.height);
  if (auto current = owner->makeCurrent(); !current) return fail(current.error());
  return owner;
}

}  // namespace burnish::context
