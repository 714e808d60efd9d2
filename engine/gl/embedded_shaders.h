// The text of shaders/, embedded by cmake/embed_shaders.py.
#pragma once
#include <span>
#include <string_view>

namespace burnish::gl {
struct EmbeddedShader {
  std::string_view name;  ///< path below shaders/
  std::string_view text;
};
std::span<const EmbeddedShader> embeddedShaders();
}  // namespace burnish::gl
