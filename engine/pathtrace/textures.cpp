#include "pathtrace/textures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "image/convert.h"
#include "scene/texture_levels.h"

namespace burnish::pathtrace {
namespace {

// Table 8.20: the texel that a wrapped index stands for.
int wrapped(int i, int size, Wrap wrap) {
  if (wrap == Wrap::ClampToEdge) return std::clamp(i, 0, size - 1);
  const int period = wrap == Wrap::Repeat ? size : 2 * size;
  int r = i % period;
  if (r < 0) r += period;
  return r < size ? r : period - 1 - r;
}

// Whole turns do not count; what is left is small enough for a float's digits and for an int.
float held(float uv, Wrap wrap) {
  if (!std::isfinite(uv)) return 0;
  if (wrap == Wrap::ClampToEdge) return std::clamp(uv, -1.0f, 2.0f);
  return uv - 2 * std::floor(uv * 0.5f);
}

}  // namespace

MapSampler::MapSampler(std::vector<Image> levels, const burnish::Sampler& sampler, bool srgb) : levels_(std::move(levels)), sampler_(sampler), srgb_(srgb), single_(size() == glm::ivec2(1)) {
  if (single_) only_ = texel(levels_[0], 0, 0);
}

glm::vec4 MapSampler::texel(const Image& level, int x, int y) const {
  const std::size_t n = std::size_t(level.channels);
  const std::uint8_t* t = level.u8() + (std::size_t(y) * std::size_t(level.width) + std::size_t(x)) * n;
  constexpr float k = 1.0f / 255;
  if (n == 4 && srgb_) {
    const std::array<float, 256>& linear = image::srgbToLinearTable();
    return {linear[t[0]], linear[t[1]], linear[t[2]], float(t[3]) * k};
  }
  glm::vec4 out(0, 0, 0, 1);
  for (std::size_t c = 0; c < n; ++c) out[int(c)] = float(t[c]) * k;
  return out;
}

glm::vec4 MapSampler::inLevel(const Image& level, const glm::vec2& uv, bool linear) const {
  const float u = held(uv.x, sampler_.wrapU) * float(level.width), v = held(uv.y, sampler_.wrapV) * float(level.height);
  if (!linear) return texel(level, wrapped(int(std::floor(u)), level.width, sampler_.wrapU), wrapped(int(std::floor(v)), level.height, sampler_.wrapV));
  const float fu = std::floor(u - 0.5f), fv = std::floor(v - 0.5f), a = u - 0.5f - fu, b = v - 0.5f - fv;
  const int x0 = wrapped(int(fu), level.width, sampler_.wrapU), x1 = wrapped(int(fu) + 1, level.width, sampler_.wrapU);
  const int y0 = wrapped(int(fv), level.height, sampler_.wrapV), y1 = wrapped(int(fv) + 1, level.height, sampler_.wrapV);
  const glm::vec4 low = texel(level, x0, y0) * (1 - a) + texel(level, x1, y0) * a, high = texel(level, x0, y1) * (1 - a) + texel(level, x1, y1) * a;
  return low * (1 - b) + high * b;
}

glm::vec4 MapSampler::atLevel(const glm::vec2& uv, float level) const {
  if (single_) return only_;
  // Between magnifying and minifying filter: 0, but 1/2 where the one is linear and the other nearest in the nearest level (section 8.15).
  const bool late = sampler_.magnifyLinear && !sampler_.minifyLinear && sampler_.mips;
  if (!(level > (late ? 0.5f : 0.0f))) return inLevel(levels_[0], uv, sampler_.magnifyLinear);
  if (levels_.size() == 1) return inLevel(levels_[0], uv, sampler_.minifyLinear);
  const float last = float(levels_.size() - 1), lambda = std::min(level, last);
  if (!sampler_.mipLinear) return inLevel(levels_[std::size_t(std::max(std::ceil(lambda + 0.5f) - 1, 0.0f))], uv, sampler_.minifyLinear);
  const float low = std::floor(lambda), share = lambda - low;
  const glm::vec4 first = inLevel(levels_[std::size_t(low)], uv, sampler_.minifyLinear);
  if (share <= 0) return first;
  return first * (1 - share) + inLevel(levels_[std::size_t(low) + 1], uv, sampler_.minifyLinear) * share;
}

glm::vec4 MapSampler::at(const glm::vec2& uv, const Footprint& footprint) const {
  if (single_) return only_;
  const glm::vec2 texels(size()), x = footprint.x * texels, y = footprint.y * texels;
  const float rho2 = std::max(glm::dot(x, x), glm::dot(y, y));
  return atLevel(uv, rho2 > 0 ? 0.5f * std::log2(rho2) : -1.0f);
}

Maps::Maps() {
  for (int slot = 0; slot < 5; ++slot) {
    Image one = makeImage(1, 1, 4, PixelType::U8);
    std::copy_n(scene::kDefaultTexels[slot], 4, one.u8());
    std::vector<Image> levels;
    levels.push_back(std::move(one));
    defaults_[std::size_t(slot)] = std::make_unique<MapSampler>(std::move(levels), burnish::Sampler{}, slot == 0 || slot == 4);
  }
}

const MapSampler* Maps::of(const Scene& scene, const Material& material, int slot, bool packed, Report& report) {
  const Id<Texture> maps[] = {material.mapA, material.mapB, material.mapC, material.metalRoughMap, material.emissiveMap};
  const Texture* texture = scene.textures.get(maps[slot]);
  const Texture* occlusion = packed && slot == 1 ? scene.textures.get(material.mapC) : nullptr;
  if (!texture || (packed && slot == 2)) return defaults_[std::size_t(slot)].get();
  const auto [place, fresh] = made_.try_emplace({maps[slot].index, occlusion ? material.mapC.index : ~0u});
  if (fresh) {
    auto levels = scene::levelsOf(*texture, occlusion);
    if (levels) place->second = std::make_unique<MapSampler>(std::move(*levels), texture->sampler, texture->kind == MapKind::AlbedoSubstance || texture->kind == MapKind::Emissive);
    else report.warn(levels.error().place, levels.error().what + ": the material goes on without it");
  }
  return place->second ? place->second.get() : defaults_[std::size_t(slot)].get();
}

}  // namespace burnish::pathtrace
