// Evaluates an expression of the shading text for many cases on the GPU, one texel a case: what holds GLSL against C++.
#pragma once
#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "gl/objects.h"
#include "gl/program.h"
#include "reference/shading.h"

namespace burnish::stability {

/// Inputs of one case: the vec4 a, b, c, d, e, f of the expression.
using ShaderCase = std::array<glm::vec4, 6>;

/// Programs and buffers of one context. It must be current in every call.
class ShaderCases {
 public:
  /// shaderOverride: a folder that is looked into before the embedded shaders; empty: none.
  explicit ShaderCases(gl::Device& device, std::filesystem::path shaderOverride = {});
  /// `expression` is GLSL that makes a vec4 of a..f, for example "vec4(lobeStable(a.x, a.y), 0, 0, 0)". The shading text is at hand, and
  ///   vec4 shadeCase(vec4 n_alpha, vec4 l, vec4 v, vec4 albedo_substance, vec4 dfgV_dfgL, vec2 mean, Rungs k): shadeDirection;
  ///   Surface surfaceCase(vec4 n_alpha, vec4 v, vec4 albedo_substance).
  /// Programs are kept. Errors: what the compiler said.
  Result<std::vector<glm::vec4>> evaluate(std::span<const ShaderCase> cases, const std::string& expression);

 private:
  gl::Device& device_;
  gl::ProgramCache programs_;
};

/// The rungs as a GLSL constructor, "Rungs(0, 1, ...)".
std::string glslOf(const shading::Rungs& rungs);

}  // namespace burnish::stability
