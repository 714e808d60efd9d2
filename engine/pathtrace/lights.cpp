#include "pathtrace/lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace burnish::pathtrace {

namespace f32 = shading::f32;
using glm::dvec3;
using glm::ivec3;
using glm::vec3;

namespace {

constexpr int kCellsAlong = 32;
constexpr float kHeld2 = 1e-4f;  // BURNISH_GUARD_DISTANCE2 of shading/constants.h

double rangeOf(const PunctualLight& light) { return std::pow(double(light.invRange4), -0.25); }

}  // namespace

Received receive(const PunctualLight& light, const dvec3& at) {
  if (light.directional) return {light.toLight, light.power, std::numeric_limits<double>::infinity()};
  const dvec3 to = light.position - at;
  const double distance = glm::length(to);
  const float d2 = std::max(float(distance * distance), kHeld2), inverse = 1 / d2;
  Received r{vec3(to * double(std::sqrt(inverse))), light.power * f32::distanceAttenuation(d2, inverse, light.invRange4, 0), distance};
  if (light.spot) r.irradiance *= f32::spotAttenuation(-glm::dot(light.axis, r.toLight), light.spotScale, light.spotOffset);
  return r;
}

LightPicker::LightPicker(std::span<const PunctualLight> lights) : lights_(lights) {
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    if (lights[i].directional) directional_.push_back(i);
    else if (!(lights[i].invRange4 > 0)) endless_.push_back(i);
  }
  build();
}

// Cells over the balls that the lights reach; a light is listed where its ball meets the cell's box.
void LightPicker::build() {
  dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  const auto ends = [](const PunctualLight& l) { return !l.directional && l.invRange4 > 0; };
  for (const PunctualLight& l : lights_)
    if (ends(l)) low = glm::min(low, l.position - rangeOf(l)), high = glm::max(high, l.position + rangeOf(l));
  if (!(low.x <= high.x)) return;
  const dvec3 extent = glm::max(high - low, dvec3(1e-6));
  const double side = std::max({extent.x, extent.y, extent.z}) / kCellsAlong;
  counts_ = glm::max(ivec3(1), ivec3(glm::ceil(extent / side - 1e-9)));
  low_ = low, cell_ = extent / dvec3(counts_);
  for (int z = 0; z < counts_.z; ++z)
    for (int y = 0; y < counts_.y; ++y)
      for (int x = 0; x < counts_.x; ++x) {
        first_.push_back(std::uint32_t(listed_.size()));
        const dvec3 a = low_ + dvec3(x, y, z) * cell_, b = a + cell_;
        listed_.insert(listed_.end(), endless_.begin(), endless_.end());
        for (std::uint32_t i = 0; i < lights_.size(); ++i) {
          if (!ends(lights_[i])) continue;
          const dvec3 off = lights_[i].position - glm::clamp(lights_[i].position, a, b);
          if (glm::dot(off, off) < rangeOf(lights_[i]) * rangeOf(lights_[i]) * (1 + 1e-5)) listed_.push_back(i);
        }
      }
  first_.push_back(std::uint32_t(listed_.size()));
}

std::span<const std::uint32_t> LightPicker::near(const dvec3& at) const {
  if (first_.empty()) return endless_;
  const dvec3 place = glm::floor((at - low_) / cell_);
  if (!(place.x >= 0 && place.y >= 0 && place.z >= 0 && place.x < counts_.x && place.y < counts_.y && place.z < counts_.z)) return endless_;
  const ivec3 c(place);
  const std::size_t i = (std::size_t(c.z) * std::size_t(counts_.y) + std::size_t(c.y)) * std::size_t(counts_.x) + std::size_t(c.x);
  return std::span(listed_).subspan(first_[i], first_[i + 1] - first_[i]);
}

LightPicker::Pick LightPicker::pick(const dvec3& at, const Bsdf& bsdf, float u) const {
  const std::span<const std::uint32_t> all = near(at);
  if (all.empty()) return {};
  // Every stride-th light from a random one on: each is in one of `stride` parts, which are equally likely.
  const std::size_t stride = (all.size() + kLooked - 1) / kLooked;
  const float scaled = u * float(stride);
  const std::size_t part = std::min(std::size_t(scaled), stride - 1);
  u = std::min(scaled - float(part), 0.99999994f);
  std::array<Received, kLooked> received;
  std::array<float, kLooked> sums;
  std::size_t count = 0;
  float sum = 0;
  for (std::size_t i = part; i < all.size(); i += stride, ++count) {
    received[count] = receive(lights_[all[i]], at);
    const float e = luminance(received[count].irradiance);
    if (e > 0) sum += e * bsdf.guess(received[count].toLight);
    sums[count] = sum;
  }
  if (!(sum > 0) || !std::isfinite(sum)) return {};
  const std::size_t chosen = std::min(std::size_t(std::upper_bound(sums.begin(), sums.begin() + std::ptrdiff_t(count), u * sum) - sums.begin()), count - 1);
  const float share = sums[chosen] - (chosen > 0 ? sums[chosen - 1] : 0);
  if (!(share > 0)) return {};
  return {&lights_[all[part + chosen * stride]], received[chosen], share / sum / float(stride)};
}

}  // namespace burnish::pathtrace
