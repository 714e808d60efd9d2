// The engine's evaluator of shading text on the GPU (engine/stability/shader_cases.h) as the tests call it.
#pragma once
#include "gl_fixture.h"
#include "stability/shader_cases.h"

namespace burnish::test {

using stability::ShaderCase;

/// Runs the expression over the cases, on the GPU.
inline std::vector<glm::vec4> onGpu(GlFixture& f, std::span<const ShaderCase> cases, const std::string& expression) {
  stability::ShaderCases evaluator(*f.device);
  auto results = evaluator.evaluate(cases, expression);
  if (!results) FAIL(results.error().message());
  return std::move(*results);
}

}  // namespace burnish::test
