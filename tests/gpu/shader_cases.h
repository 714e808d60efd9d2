// Evaluates an expression of the shading text for many cases on the GPU: one texel per case.
#pragma once
#include <array>
#include <vector>

#include "gl/program.h"
#include "gl_fixture.h"

namespace burnish::test {

inline constexpr gl::EmbeddedShader kCasePrograms[] = {
    {"cases.vert",
     "void main() {\n  vec2 p = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);\n  gl_Position = vec4(p, "
     "0, 1);\n}\n"},
    // Row k of `cases` holds the k-th vec4 of every case. EVALUATE makes a vec4 of a, b, c, d.
    {"cases.frag", R"(#include "shading/bridge.h"
#include "shading/constants.h"
#include "shading/roughness.h"
#include "shading/normals.h"
#include "shading/albedo.h"
#include "shading/substance.h"
#include "shading/fresnel.h"
#include "shading/lobe.h"
#include "shading/distribution.h"
#include "shading/geometry.h"
#include "shading/light.h"
#include "shading/surface.h"
#include "shading/default_path.h"
#include "shading/environment.h"
#include "shading/tonemap.h"
layout(binding = 0) uniform sampler2D cases;
layout(location = 0) out vec4 result;
vec4 shade(vec4 n, vec4 l, vec4 v, vec4 albedo, int geometry, int lobe) {
  return vec4(shadeDirection(makeSurface(n.xyz, v.xyz, albedo.rgb, albedo.a, n.w), l.xyz, geometry, lobe), 0.0);
}
void main() {
  int i = int(gl_FragCoord.x), row = 4 * int(gl_FragCoord.y);
  vec4 a = texelFetch(cases, ivec2(i, row), 0), b = texelFetch(cases, ivec2(i, row + 1), 0);
  vec4 c = texelFetch(cases, ivec2(i, row + 2), 0), d = texelFetch(cases, ivec2(i, row + 3), 0);
  result = EVALUATE;
}
)"},
};

using ShaderCase = std::array<glm::vec4, 4>;

/// Runs EVALUATE over the cases, on the GPU.
inline std::vector<glm::vec4> onGpu(GlFixture& f, std::vector<ShaderCase> cases, const std::string& evaluate) {
  constexpr int kWidth = 512;
  const std::size_t count = cases.size();
  const int height = int((count + kWidth - 1) / kWidth);
  cases.resize(std::size_t(height) * kWidth, cases.back());
  std::vector<glm::vec4> texels(cases.size() * 4), results(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) texels[(i / kWidth * 4 + k) * kWidth + i % kWidth] = cases[i][k];

  std::vector<gl::EmbeddedShader> files(std::begin(kCasePrograms), std::end(kCasePrograms));
  for (const gl::EmbeddedShader& file : gl::embeddedShaders()) files.push_back(file);
  gl::ProgramCache cache(*f.device, gl::ShaderLibrary({}, files));
  auto program = cache.get({"cases", "cases.vert", "cases.frag", "", {"EVALUATE " + evaluate}});
  if (!program) FAIL(program.error().message());
  auto input = gl::Texture::create(*f.device, {GL_TEXTURE_2D, GL_RGBA32F, kWidth, 4 * height}, "cases");
  auto output = gl::Texture::create(*f.device, {GL_TEXTURE_2D, GL_RGBA32F, kWidth, height}, "results");
  REQUIRE(input);
  REQUIRE(output);
  input->upload(0, texels.data());
  const gl::Attachment color(*output);
  auto framebuffer = gl::Framebuffer::create(*f.device, {&color, 1}, {}, "results");
  REQUIRE(framebuffer);
  const gl::VertexArray none = gl::VertexArray::create(*f.device, {}, {}, 0, "none");
  framebuffer->bind();
  none.bind();
  (*program)->use();
  input->bind(0);
  f.gl.Viewport(0, 0, kWidth, height);
  f.gl.DrawArrays(GL_TRIANGLES, 0, 3);
  f.gl.UseProgram(0);
  output->read(0, std::as_writable_bytes(std::span(results)));
  results.resize(count);
  return results;
}

}  // namespace burnish::test
