#include "pathtrace/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace burnish::pathtrace {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kLimit = 65000;  // gpu_environment.cpp

float luminance(const float* c) { return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]; }
float mended(float v) { return std::isfinite(v) ? std::clamp(v, 0.0f, kLimit) : 0.0f; }

// u = 1/2 looks along -Z, u grows toward +X; the first row is the zenith.
glm::vec2 placeOf(const glm::vec3& d) { return {0.5f + std::atan2(d.x, -d.z) / (2 * kPi), std::acos(std::clamp(d.y, -1.0f, 1.0f)) / kPi}; }

}  // namespace

Result<Surroundings> Surroundings::create(const Environment& e) {
  if (!e.map.empty() && (e.map.type != PixelType::F32 || e.map.channels < 3 || e.map.data.size() != e.map.byteSize()))
    return fail("environment", "the map is not a float picture with 3 or 4 channels", "load it with loadEnvironment");
  Surroundings s;
  const float scale = std::isfinite(e.scale) ? std::max(e.scale, 0.0f) : 0;
  s.picture_ = e.map.empty() ? makeImage(8, 4, 3, PixelType::F32) : makeImage(e.map.width, e.map.height, 3, PixelType::F32);
  for (std::size_t i = 0; i < s.picture_.pixelCount(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const float v = mended(e.map.empty() ? e.color[int(c)] : e.map.f32()[i * std::size_t(e.map.channels) + c]) * scale;
      s.picture_.f32()[i * 3 + c] = v;
      s.lit_ |= v > 0;
    }
  if (s.lit_) s.makeDistributions();
  return s;
}

void Surroundings::makeDistributions() {
  const int w = picture_.width, h = picture_.height;
  for (int y = 0; y <= h; ++y) cosines_.push_back(y == 0 ? 1.0f : y == h ? -1.0f : float(std::cos(std::numbers::pi * y / h)));
  std::vector<float> bright(picture_.pixelCount()), along(picture_.pixelCount()), row(static_cast<std::size_t>(w)), rows;
  for (std::size_t i = 0; i < bright.size(); ++i) bright[i] = luminance(picture_.f32() + 3 * i);
  const auto at = [w](int x, int y) { return std::size_t(y) * std::size_t(w) + std::size_t(x); };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) along[at(x, y)] = std::max({bright[at((x + w - 1) % w, y)], bright[at(x, y)], bright[at((x + 1) % w, y)]});
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) row[std::size_t(x)] = std::max({along[at(x, std::max(y - 1, 0))], along[at(x, y)], along[at(x, std::min(y + 1, h - 1))]});
    columns_.emplace_back(row);
    rows.push_back(float(columns_.back().total() * double(cosines_[std::size_t(y)] - cosines_[std::size_t(y) + 1])));
  }
  rows_ = Distribution(rows);
}

glm::vec3 Surroundings::texel(int x, int y) const {
  const float* t = picture_.f32() + 3 * (std::size_t(y) * std::size_t(picture_.width) + std::size_t(x));
  return {t[0], t[1], t[2]};
}

glm::vec3 Surroundings::radiance(const glm::vec3& d) const {
  if (!lit_) return glm::vec3(0);
  const int w = picture_.width, h = picture_.height;
  const glm::vec2 p = placeOf(d) * glm::vec2(w, h) - 0.5f, f = glm::floor(p), share = p - f;
  const int x0 = (int(f.x) % w + w) % w, x1 = (x0 + 1) % w, y0 = std::clamp(int(f.y), 0, h - 1), y1 = std::clamp(int(f.y) + 1, 0, h - 1);
  return glm::mix(glm::mix(texel(x0, y0), texel(x1, y0), share.x), glm::mix(texel(x0, y1), texel(x1, y1), share.x), share.y);
}

EnvironmentSample Surroundings::sample(const glm::vec2& place) const {
  EnvironmentSample s;
  if (rows_.empty()) return s;
  const Distribution::Pick row = rows_.at(place.y), column = columns_[row.index].at(place.x);
  const float y = glm::mix(cosines_[row.index], cosines_[row.index + 1], row.rest), sine = std::sqrt(std::max(1 - y * y, 0.0f));
  const float turn = ((float(column.index) + column.rest) / float(picture_.width) - 0.5f) * 2 * kPi;
  s.direction = {sine * std::sin(turn), y, -sine * std::cos(turn)};
  s.radiance = radiance(s.direction);
  s.density = density(s.direction);
  return s;
}

float Surroundings::density(const glm::vec3& d) const {
  if (rows_.empty()) return 0;
  const glm::vec2 p = placeOf(d);
  const int w = picture_.width, h = picture_.height;
  const std::size_t x = std::size_t(std::clamp(int(p.x * float(w)), 0, w - 1)), y = std::size_t(std::clamp(int(p.y * float(h)), 0, h - 1));
  const float solid = 2 * kPi / float(w) * (cosines_[y] - cosines_[y + 1]);
  return rows_.probability(y) * columns_[y].probability(x) / std::max(solid, 1e-30f);
}

}  // namespace burnish::pathtrace
