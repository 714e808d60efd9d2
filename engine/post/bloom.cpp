// A pyramid of quadratic B-splines. Down: [1 3 3 1]/8 an axis, up: its transpose, one bilinear lookup (Chaikin's subdivision). Every texel gives away exactly what it has, so
// that what scatters is neither lost nor added; going up, each level is mixed with what comes from below (Burt and Adelson 1983, "The Laplacian Pyramid as a Compact Image
// Code"; Jimenez 2014, "Next Generation Post Processing in Call of Duty: Advanced Warfare", for the chain). Karis's weighted average of the first level, which Jimenez takes
// against single bright pixels, is left out: it takes energy from the very lights that scatter most.
#include "post/bloom.h"

#include <cmath>

#include "plan/bloom.h"
#include "post/screen.h"

namespace burnish::post {
namespace {

using gpu_scene::FrameContext;

constexpr int kMostLevels = 16;
/// sum[k]: weights of level k and all above it.
std::array<float, kMostLevels + 1> sumsOf(int levels, int height) {
  std::array<float, kMostLevels + 1> sum{};
  for (int k = std::min(levels, kMostLevels) - 1; k >= 0; --k) sum[std::size_t(k)] = sum[std::size_t(k) + 1] + plan::bloomWeight(k, height);
  return sum;
}

// A draw from one level into another: only the source can be sampled, as the rules on feedback ask (OpenGL 4.5, section 9.3.1).
Result<void> draw(FrameContext& c, const gl::Texture& chain, std::string_view program, int source, int into) {
  const GladGLContext& gl = c.device.gl;
  auto framebuffer = c.targets.levelFramebuffer("bloom", into);
  if (!framebuffer) return fail(framebuffer.error());
  gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  const glm::ivec2 size = scatteredSize(c, into), from = scatteredSize(c, source);
  gl.Viewport(0, 0, size.x, size.y);
  gl.Scissor(0, 0, size.x, size.y);
  gl.TextureParameteri(chain.id(), GL_TEXTURE_BASE_LEVEL, source);
  gl.TextureParameteri(chain.id(), GL_TEXTURE_MAX_LEVEL, source);
  if (const gl::Program* p = c.programs.find(program)) gl.ProgramUniform2f(p->id(), 0, float(from.x) - 0.5f, float(from.y) - 0.5f);
  return c.drawScreen(program);
}

Result<void> takeLight(FrameContext& c) {
  auto framebuffer = c.targets.levelFramebuffer("bloom", 0);
  if (!framebuffer) return fail(framebuffer.error());
  beginScreen(c, *framebuffer);
  const glm::ivec2 size = scatteredSize(c, 0);
  c.device.gl.Viewport(0, 0, size.x, size.y);
  c.device.gl.Scissor(0, 0, size.x, size.y);
  bindIfThere(c, c.picture, UNIT_LIGHT_BUFFER);
  return c.drawScreen("bloom_first");
}

}  // namespace

glm::ivec2 scatteredSize(const FrameContext& c, int level) {
  const int texel = 2 << level;
  return (glm::ivec2(c.view.viewport.z, c.view.viewport.w) + texel - 1) / texel;
}

float scatteredShare(const FrameContext& c) {
  const float share = std::isfinite(c.quality.bloomShare) ? std::clamp(c.quality.bloomShare, 0.0f, 1.0f) : 0.0f;
  const int height = c.view.viewport.w;
  return share * sumsOf(plan::bloomLevels(height), height)[0] / plan::kBloomOctaves;
}

Result<void> scatter(FrameContext& c) {
  const GladGLContext& gl = c.device.gl;
  const gl::Texture& chain = *c.targets.texture("bloom");
  const int height = c.view.viewport.w, levels = std::min({plan::bloomLevels(height), chain.levels, kMostLevels});
  gl.TextureParameteri(chain.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TextureParameteri(chain.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  if (auto done = takeLight(c); !done) return done;
  chain.bind(UNIT_BLOOM);
  for (int k = 1; k < levels; ++k)
    if (auto done = draw(c, chain, "bloom_down", k - 1, k); !done) return done;
  const auto sum = sumsOf(levels, height);
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
  Result<void> done;
  for (int k = levels - 2; k >= 0 && done; --k) {
    gl.BlendColor(0, 0, 0, sum[std::size_t(k)] > 0 ? sum[std::size_t(k) + 1] / sum[std::size_t(k)] : 0);
    done = draw(c, chain, "bloom_up", k + 1, k);
  }
  gl.Disable(GL_BLEND);
  gl.BlendFunc(GL_ONE, GL_ZERO);
  gl.BlendColor(0, 0, 0, 0);
  gl.TextureParameteri(chain.id(), GL_TEXTURE_BASE_LEVEL, 0);
  gl.TextureParameteri(chain.id(), GL_TEXTURE_MAX_LEVEL, 0);
  return done;
}

}  // namespace burnish::post
