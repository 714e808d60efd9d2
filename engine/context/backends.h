// The three ways in which the engine opens a context by itself.
#pragma once
#include <burnish/context.h>

namespace burnish::context {

Result<std::unique_ptr<Context>> createEgl(const ContextOptions& options);
Result<std::unique_ptr<Context>> createOsMesa(const ContextOptions& options);
Result<std::unique_ptr<Context>> createGlfw(const ContextOptions& options);

/// "OpenGL 3.3 (Core Profile) Mesa 22.3.6 on llvmpipe" of the context that is current, for errors.
std::string describeCurrent(const ProcAddress& getProcAddress);

}  // namespace burnish::context
