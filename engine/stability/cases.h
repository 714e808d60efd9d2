// The hard cases as a data table: what is evaluated, how it is judged, and the bound.
#pragma once
#include <burnish/measure.h>
#include <burnish/renderer.h>

#include "stability/shader_cases.h"

namespace burnish::stability {

/// What a judge finds: a value to hold against the bound, and where it was found.
struct Finding {
  double value = 0;
  std::string where;
};

/// One expression of the shading text in its three languages.
struct TextVariant {
  std::string name;  ///< for findings; may be empty
  std::string glsl;  ///< an expression that makes a vec4 of a..f
  std::function<glm::dvec4(const ShaderCase&)> inDouble;
  std::function<glm::vec4(const ShaderCase&)> inFloat;
};
/// A case of the shading text: the same inputs through every variant; the worst one counts.
struct TextCase {
  std::string id, what;
  double bound = 0;
  std::vector<ShaderCase> inputs;
  std::vector<TextVariant> variants;
  std::function<Finding(std::span<const ShaderCase>, std::span<const glm::dvec4>)> judge;
};
std::vector<TextCase> textCases();

/// A case of the double oracle or of a table: CPU alone.
struct OracleCase {
  std::string id, what;
  double bound = 0;
  std::function<Finding()> measure;
};
std::vector<OracleCase> oracleCases();

/// A case that is a picture, or a few of them.
struct PictureCase {
  std::string id, what;
  double bound = 0;
  std::function<Result<Finding>(const ProcAddress&, Renderer&)> measure;
};
std::vector<PictureCase> pictureCases();

}  // namespace burnish::stability
