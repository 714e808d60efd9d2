// Shader text: found in an override folder or embedded in the library, includes resolved, definitions put in front,
// errors traced back to files.
#pragma once
#include <burnish/result.h>

#include <filesystem>

#include "gl/embedded_shaders.h"

namespace burnish::gl {

/// One shader ready for glShaderSource. Its `#line N F` directives count files by `files[F]`.
struct ShaderText {
  std::string text;
  std::vector<std::string> files;
};

/// Finds shader files by their path below shaders/. No GL is needed. The embedded table must outlive the library.
class ShaderLibrary {
 public:
  /// overrideFolder is looked into first, anew on every call (live editing); empty: none.
  explicit ShaderLibrary(std::filesystem::path overrideFolder = {},
                         std::span<const EmbeddedShader> embedded = embeddedShaders());
  /// The text of one file. Error when neither place has it.
  [[nodiscard]] Result<std::string> file(std::string_view name) const;
  /// `#version 450 core`, the definitions ("NAME value" or "NAME"), then the file with every `#include "path"` put in,
  /// each file once. A path is tried beside the including file, then from the root. `#include <...>` and whatever
  /// stands under `#ifdef __cplusplus` are C++'s and left out. Errors: a missing file (with the line that asks for it),
  /// a cycle (with its chain), a path that leaves the root, a malformed directive.
  [[nodiscard]] Result<ShaderText> resolve(std::string_view name, std::span<const std::string> defines = {}) const;

 private:
  std::filesystem::path override_;
  std::span<const EmbeddedShader> embedded_;
};

/// A compiler's log with its "F:line" and "F(line)" prefixes written as "file:line".
[[nodiscard]] std::string nameFiles(std::string_view log, std::span<const std::string> files);

}  // namespace burnish::gl
