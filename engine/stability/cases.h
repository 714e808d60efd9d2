// The hard cases as a data table: what is evaluated, how it is judged, and the bound.
#pragma once
#include <burnish/measure.h>
#include <burnish/renderer.h>

#include <cmath>
#include <filesystem>

#include "gl/program.h"
#include "stability/shader_cases.h"

namespace burnish::stability {

/// What a judge finds: a value to hold against the bound, and where it was found.
struct Finding {
  double value = 0;
  std::string where;
  /// Keeps the larger; what is not finite is larger than anything.
  void worse(double other, const std::string& place) {
    if (!std::isfinite(value) || (std::isfinite(other) && !(other > value))) return;
    value = other;
    where = place;
  }
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
std::vector<TextCase> textCases();       ///< of surfaces and lights
std::vector<TextCase> modelTextCases();  ///< of closed forms: Fresnel, widths, codes, tone curves
std::vector<TextCase> probeTextCases();  ///< of captured places and of occlusion

/// A case of what the CPU computes: the double oracle, tables, filters, lattices.
struct OracleCase {
  std::string id, what;
  double bound = 0;
  std::function<Finding()> measure;
  bool slow = false;  ///< left out of quick runs
};
std::vector<OracleCase> oracleCases();
std::vector<OracleCase> filterOracleCases();  ///< of prefiltering and of lattices

/// What picture cases draw with: one context, one renderer, whose programs are kept from case to case.
struct Studio {
  const ProcAddress& gl;
  gl::Device& device;
  gl::ProgramCache& programs;  ///< of `device`
  Renderer& renderer;
};
/// A case that is a picture, or a few of them.
struct PictureCase {
  std::string id, what;
  double bound = 0;
  std::function<Result<Finding>(Studio&)> measure;
  bool slow = false;
};
std::vector<PictureCase> pictureCases();        ///< of surfaces, lights and hostile input
std::vector<PictureCase> placePictureCases();   ///< of captured places
std::vector<PictureCase> bakePictureCases();    ///< of captures and bakes
std::vector<PictureCase> filterPictureCases();  ///< of surroundings: cubes filtered on the GPU, bad texels
std::vector<PictureCase> screenPictureCases();  ///< of depth, occlusion and motion
std::vector<PictureCase> surfacePictureCases(); ///< of transparent surfaces, tables and stored highlights

}  // namespace burnish::stability
