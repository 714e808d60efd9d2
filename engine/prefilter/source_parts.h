// What the sources of cubes and of lat-long pictures share.
#pragma once
#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "prefilter/harmonics.h"
#include "prefilter/kernels.h"

namespace burnish::prefilter {

// A texel is bright where it is over kBright times the mean; of more than kMostBright the brightest are taken.
inline constexpr double kBright = 64;
inline constexpr std::size_t kMostBright = 192;

/// Of rows of texels: radiance × solid angle, by row, summed up in the order of rows.
struct RowSum {
  glm::dvec3 light{0};
  double solidAngle = 0;
};

/// Which texels are bright, by their largest channel over the mean's. `value(i)`: a texel's largest channel.
template <class Value>
std::vector<std::uint32_t> brightOf(std::size_t count, double mean, const Value& value) {
  std::vector<std::uint32_t> found;
  double threshold = kBright * mean;
  if (!(mean > 0)) return found;
  for (std::size_t i = 0; i < count; ++i)
    if (double(value(i)) > threshold) found.push_back(std::uint32_t(i));
  if (found.size() > kMostBright) {
    const auto brighter = [&](std::uint32_t a, std::uint32_t b) { return value(a) != value(b) ? value(a) > value(b) : a < b; };
    std::nth_element(found.begin(), found.begin() + std::ptrdiff_t(kMostBright), found.end(), brighter);
    found.resize(kMostBright);
    std::sort(found.begin(), found.end());
  }
  return found;
}

inline float largest(const float* rgb) { return std::max({rgb[0], rgb[1], rgb[2]}); }

/// All texels must be set.
struct TexelArrays {
  Buffer<float> v;
  TexelsView view;
  void make(std::size_t count) {
    const std::size_t stride = count + 16;
    v.resize(7 * stride);
    const float** members[7] = {&view.x, &view.y, &view.z, &view.r, &view.g, &view.b, &view.solidAngle};
    for (std::size_t k = 0; k < 7; ++k) {
      *members[k] = v.data() + k * stride;
      std::fill_n(v.begin() + std::ptrdiff_t(k * stride + count), stride - count, 0.0f);
    }
  }
  void set(std::size_t i, const glm::dvec3& direction, const glm::dvec3& rest, double solidAngle) {
    const std::size_t stride = v.size() / 7;
    const double values[7] = {direction.x, direction.y, direction.z, rest.x, rest.y, rest.z, solidAngle};
    for (std::size_t k = 0; k < 7; ++k) v[k * stride + i] = float(values[k]);
  }
};

}  // namespace burnish::prefilter
