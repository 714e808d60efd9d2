#include "context/library.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace burnish::context {

Result<Library> Library::open(std::span<const char* const> names, std::string_view package) {
  std::string tried;
  for (const char* name : names) {
    // RTLD_LOCAL keeps the library's gl* symbols out of everyone else's way (OSMesa exports all of OpenGL).
    if (void* handle = dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) return Library(handle);
    const char* why = dlerror();
    tried += fmt::format("{}{}", tried.empty() ? "" : "; ", why ? why : name);
  }
  return fail(names.front(), fmt::format("the library cannot be opened ({})", tried),
              fmt::format("install it: apt-get install {}", package));
}

void* Library::symbol(const char* name) const { return dlsym(handle_, name); }

}  // namespace burnish::context
