#include "stability/shader_cases.h"

#include <fmt/format.h>

#include <algorithm>

#include "gl/embedded_shaders.h"

namespace burnish::stability {
namespace {

constexpr int kWidth = 512, kRows = int(std::tuple_size_v<ShaderCase>);
constexpr std::size_t kChunk = std::size_t(kWidth) * 512;

gl::ProgramSource sourceOf(const std::string& expression) { return {"shader cases", "stability/cases.vert", "stability/cases.frag", {}, {"EVALUATE " + expression}}; }

}  // namespace

ShaderCases::ShaderCases(gl::Device& device, std::filesystem::path shaderOverride) : device_(device), programs_(device, gl::ShaderLibrary(std::move(shaderOverride))) {}

Result<std::vector<glm::vec4>> ShaderCases::evaluate(std::span<const ShaderCase> cases, const std::string& expression) {
  std::vector<glm::vec4> results;
  results.reserve(cases.size());
  auto program = programs_.get(sourceOf(expression));
  if (!program) return fail(program.error());
  const gl::VertexArray none = gl::VertexArray::create(device_, {}, {}, 0, "none");
  while (!cases.empty()) {
    const std::span<const ShaderCase> part = cases.first(std::min(cases.size(), kChunk));
    cases = cases.subspan(part.size());
    const int height = int((part.size() + kWidth - 1) / kWidth);
    // Row k of a block of kRows rows holds the k-th vec4 of every case; the last row is filled up with the last case.
    std::vector<glm::vec4> texels(std::size_t(kWidth) * std::size_t(height) * kRows), values(std::size_t(kWidth) * std::size_t(height));
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t k = 0; k < kRows; ++k) texels[(i / kWidth * kRows + k) * kWidth + i % kWidth] = part[std::min(i, part.size() - 1)][k];
    auto input = gl::Texture::create(device_, {GL_TEXTURE_2D, GL_RGBA32F, kWidth, kRows * height}, "cases");
    auto output = gl::Texture::create(device_, {GL_TEXTURE_2D, GL_RGBA32F, kWidth, height}, "results");
    if (!input) return fail(input.error());
    if (!output) return fail(output.error());
    input->upload(0, texels.data());
    const gl::Attachment color(*output);
    auto framebuffer = gl::Framebuffer::create(device_, {&color, 1}, {}, "results");
    if (!framebuffer) return fail(framebuffer.error());
    framebuffer->bind();
    none.bind();
    (*program)->use();
    input->bind(0);
    device_.gl.Viewport(0, 0, kWidth, height);
    device_.gl.DrawArrays(GL_TRIANGLES, 0, 3);
    device_.gl.UseProgram(0);
    output->read(0, std::as_writable_bytes(std::span(values)));
    results.insert(results.end(), values.begin(), values.begin() + std::ptrdiff_t(part.size()));
  }
  return results;
}

std::string glslOf(const shading::Rungs& k) {
  return fmt::format("Rungs({}, {}, {}, {}, {}, {}, {}, {}, {}, {})", k.specular, k.distribution, k.geometry, k.normalization, k.lobe, k.fresnel, k.diffuse, k.compensation, k.anisotropic, k.roughDiffuse);
}

}  // namespace burnish::stability
