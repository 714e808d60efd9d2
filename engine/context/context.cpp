#include <burnish/context.h>

#include "context/backends.h"

namespace burnish {

Result<std::unique_ptr<Context>> Context::create(const ContextOptions& options) {
  Result<std::unique_ptr<Context>> made = fail("context", "unknown backend", "use egl, osmesa or glfw");
  switch (options.backend) {
    case Backend::Egl:
      made = context::createEgl(options);
      break;
    case Backend::OsMesa:
      made = context::createOsMesa(options);
      break;
    case Backend::Glfw:
      made = context::createGlfw(options);
      break;
  }
  if (!made) return made;
  // A driver may hand out a context and still lack what the engine needs; better to say so here than in the first
  // frame.
  if (auto caps = queryCapabilities((*made)->procAddress()); !caps) return fail(caps.error());
  return made;
}

std::string_view backendName(Backend b) {
  switch (b) {
    case Backend::Egl:
      return "egl";
    case Backend::OsMesa:
      return "osmesa";
    case Backend::Glfw:
      return "glfw";
  }
  return "unknown";
}

}  // namespace burnish
