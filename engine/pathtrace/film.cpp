#include "pathtrace/film.h"

#include <algorithm>
#include <cmath>

namespace burnish::pathtrace {
namespace {

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void put(Image& image, std::size_t i, const glm::dvec3& v) {
  for (std::size_t c = 0; c < 3; ++c) image.f32()[i * 3 + c] = float(v[int(c)]);
}

}  // namespace

// Welford 1962, for groups of several.
void Pixel::take(const glm::dvec3& value, double count) {
  whole += count;
  const glm::dvec3 before = value - mean;
  mean += before * (count / whole);
  spread += count * before * (value - mean);
}

bool Pixel::add(std::uint32_t index, const FilmSample& s) {
  constexpr std::uint32_t kGroup = Sampler::kGroup;
  const bool good = finite(s.radiance) && finite(s.direct) && finite(glm::dvec3(s.features.albedo)) && finite(glm::dvec3(s.features.normal));
  if (good) {
    direct += s.direct;
    albedo += glm::dvec3(s.features.albedo);
    normal += glm::dvec3(s.features.normal);
  }
  if (index < kGroup) {
    if (good) take(s.radiance, 1);
    return good;
  }
  if (good) {
    group += s.radiance;
    open += 1;
  }
  if (index % kGroup == kGroup - 1) {
    if (index / kGroup == 1) spread = glm::dvec3(0);
    if (open > 0) take(group / open, open);
    group = glm::dvec3(0);
    open = 0;
  }
  return good;
}

glm::dvec3 Pixel::radiance() const { return whole + open > 0 ? (mean * whole + group) / (whole + open) : glm::dvec3(0); }

glm::dvec3 Pixel::variance(int samples) const {
  if (whole + open <= 1) return radiance() * radiance();
  const double parts = samples < 2 * Sampler::kGroup ? whole : samples / Sampler::kGroup;
  return spread / std::max(parts - 1, 1.0) / (whole + open);
}

double Film::error() const {
  double noise = 0, light = 0;
  for (const Pixel& p : pixels_) {
    const glm::dvec3 r = p.radiance(), v = p.variance(samples);
    noise += v.x + v.y + v.z;
    light += glm::dot(r, r);
  }
  return light > 0 ? std::sqrt(noise / light) : 0;
}

ReferencePicture Film::picture() const {
  ReferencePicture out;
  for (Image* image : {&out.radiance, &out.direct, &out.albedo, &out.normal, &out.variance}) *image = makeImage(size_.x, size_.y, 3, PixelType::F32);
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel& p = pixels_[i];
    const double n = std::max(p.whole + p.open, 1.0);
    put(out.radiance, i, p.radiance());
    put(out.direct, i, p.direct / n);
    put(out.albedo, i, glm::clamp(p.albedo / n, 0.0, 1.0));
    put(out.normal, i, p.normal / n);
    put(out.variance, i, p.variance(samples));
  }
  out.samples = samples;
  out.error = error();
  return out;
}

}  // namespace burnish::pathtrace
