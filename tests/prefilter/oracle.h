// The judge: sums over every texel of a source, in double, that share nothing with the filter but the formulas of docs/shading.md; and maps to judge by.
#pragma once
#include <burnish/image.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "stability/cube_texels.h"

namespace burnish::test {

using stability::acrossEdge;
using stability::centreOf;
using stability::kCircle;
using stability::Texel;
using stability::texelAt;

inline constexpr ReflectionLobe kLobes[2] = {ReflectionLobe::BlinnPhong, ReflectionLobe::Ggx};
inline const char* lobeName(ReflectionLobe lobe) { return lobe == ReflectionLobe::Ggx ? "GGX" : "Blinn-Phong"; }

/// Solid angle by Girard's theorem: the angles between the planes through the texel's edges, less 2 π.
inline double girard(int size, int face, int x, int y) {
  const auto corner = [&](int i, int j) {
    const double u = 2.0 * (x + i) / size - 1, v = 2.0 * (y + j) / size - 1;
    const glm::dvec3 all[6] = {{1, -v, -u}, {-1, -v, u}, {u, 1, v}, {u, -1, -v}, {u, -v, 1}, {-u, -v, -1}};
    return glm::normalize(all[face]);
  };
  const glm::dvec3 p[4] = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
  double sum = -kCircle;
  for (int k = 0; k < 4; ++k) {
    const glm::dvec3 before = glm::cross(p[k], p[(k + 3) % 4]), after = glm::cross(p[k], p[(k + 1) % 4]);
    sum += std::atan2(glm::length(glm::cross(before, after)), glm::dot(before, after));
  }
  return sum;
}

struct Points {
  std::vector<glm::dvec3> direction, light;
  std::vector<double> solidAngle;
};

inline Points pointsOf(const CubeLevel& cube) {
  Points p;
  std::size_t i = 0;
  for (int f = 0; f < 6; ++f)
    for (int y = 0; y < cube.size; ++y)
      for (int x = 0; x < cube.size; ++x, i += 3) {
        const double u0 = 2.0 * x / cube.size - 1, u1 = 2.0 * (x + 1) / cube.size - 1, v0 = 2.0 * y / cube.size - 1, v1 = 2.0 * (y + 1) / cube.size - 1;
        const auto a = [](double u, double v) { return std::atan2(u * v, std::sqrt(u * u + v * v + 1)); };
        p.direction.push_back(centreOf(cube.size, f, x, y));
        p.solidAngle.push_back(a(u1, v1) - a(u0, v1) - a(u1, v0) + a(u0, v0));
        p.light.emplace_back(cube.texels[i], cube.texels[i + 1], cube.texels[i + 2]);
      }
  return p;
}

inline Points pointsOf(const Image& latLong) {
  Points p;
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x) {
      const double longitude = ((x + 0.5) / latLong.width - 0.5) * kCircle, polar = (y + 0.5) / latLong.height * kCircle / 2;
      const float* t = latLong.f32() + (std::size_t(y) * std::size_t(latLong.width) + std::size_t(x)) * std::size_t(latLong.channels);
      p.direction.emplace_back(std::sin(polar) * std::sin(longitude), std::cos(polar), -std::sin(polar) * std::cos(longitude));
      p.solidAngle.push_back((std::cos(y * kCircle / 2 / latLong.height) - std::cos((y + 1) * kCircle / 2 / latLong.height)) * kCircle / latLong.width);
      p.light.emplace_back(t[0], t[1], t[2]);
    }
  return p;
}

/// w(l·R) of docs/shading.md, section 5, over its value at l = R.
inline double weightOf(ReflectionLobe lobe, double roughness, double x) {
  if (x >= 1) return 0;
  const double alpha2 = std::pow(roughness, 4);
  if (lobe == ReflectionLobe::Ggx) {
    const double nh2 = 1 - x / 2, d = nh2 * (alpha2 - 1) + 1, peak = 1 / alpha2;
    return alpha2 / (d * d) * (1 - x) / peak;
  }
  return std::pow(1 - x / 2, 1 / alpha2 - 1) * (1 - x);
}

inline glm::dvec3 integrated(const Points& p, const glm::dvec3& r, ReflectionLobe lobe, double roughness) {
  glm::dvec3 sum(0);
  double total = 0;
  for (std::size_t i = 0; i < p.direction.size(); ++i) {
    const glm::dvec3 d = p.direction[i] - r;
    const double x = glm::dot(d, d) / 2;
    if (x >= 1) continue;
    const double w = weightOf(lobe, roughness, x) * p.solidAngle[i];
    sum += p.light[i] * w;
    total += w;
  }
  return sum / total;
}

/// A cube of radiance(direction), `samples`² points a texel.
inline CubeLevel cubeOf(int size, const std::function<glm::dvec3(const glm::dvec3&)>& radiance, int samples = 1) {
  CubeLevel c{size, 0, {}};
  for (int f = 0; f < 6; ++f)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        glm::dvec3 sum(0);
        for (int k = 0; k < samples * samples; ++k) sum += radiance(centreOf(size * samples, f, x * samples + k % samples, y * samples + k / samples));
        for (int k = 0; k < 3; ++k) c.texels.push_back(float(sum[k] / (samples * samples)));
      }
  return c;
}

/// Sky 1 and a disc of 1e5, 0.5 degrees across.
inline CubeLevel sunCube(int size, const glm::dvec3& toSun) {
  const double edge = std::cos(0.25 / 360 * kCircle);
  const glm::dvec3 sun = glm::normalize(toSun);
  return cubeOf(size, [&](const glm::dvec3& d) { return glm::dvec3(glm::dot(d, sun) > edge ? 1e5 : 1); }, 4);
}

struct LevelError {
  double rms = 0;    ///< of the errors over that of the reference
  double worst = 0;  ///< max |e|/max(reference, 1e-6 of the level's mean)
  double edge = 0;   ///< the same at texels along edges and in corners
};

/// Errors of a level at all texels, or at `samples` of them: a third along edges and in corners, and a third around `interest`.
inline LevelError errorOf(const CubeLevel& level, const Points& source, ReflectionLobe lobe, int samples, const glm::dvec3& interest, unsigned seed = 3) {
  std::mt19937 random(seed);
  const int n = level.size;
  double mean = 0;
  for (const float v : level.texels) mean += double(v) / double(level.texels.size());
  std::vector<std::array<int, 3>> texels;
  if (6 * n * n <= samples)
    for (int i = 0; i < 6 * n * n; ++i) texels.push_back({i / (n * n), i % n, i / n % n});
  else {
    std::vector<std::pair<double, int>> near;
    for (int i = 0; i < 6 * n * n; ++i) near.emplace_back(-glm::dot(centreOf(n, i / (n * n), i % n, i / n % n), interest), i);
    std::sort(near.begin(), near.end());
    for (int k = 0; k < samples; ++k) {
      int i = int(random() % unsigned(6 * n * n));
      if (k % 3 == 2) i = near[std::size_t(k) * std::size_t(k) / 9 * 8 % (near.size() / 4 + 1)].second;
      int x = i % n, y = i / n % n;
      if (k % 3 == 1) x = k % 2 ? 0 : n - 1;
      if (k % 12 == 1) y = k % 24 == 1 ? 0 : n - 1;
      texels.push_back({i / (n * n), x, y});
    }
  }
  LevelError e;
  double squares = 0, reference = 0;
  for (const auto& [f, x, y] : texels) {
    const glm::dvec3 truth = integrated(source, centreOf(n, f, x, y), lobe, level.roughness);
    for (int c = 0; c < 3; ++c) {
      const double off = std::abs(double(level.texels[3 * ((std::size_t(f) * std::size_t(n) + std::size_t(y)) * std::size_t(n) + std::size_t(x)) + std::size_t(c)]) - truth[c]);
      const double relative = off / std::max(truth[c], 1e-6 * mean);
      squares += off * off;
      reference += truth[c] * truth[c];
      e.worst = std::max(e.worst, relative);
      if (x == 0 || y == 0 || x == n - 1 || y == n - 1) e.edge = std::max(e.edge, relative);
    }
  }
  e.rms = std::sqrt(squares / reference);
  return e;
}

}  // namespace burnish::test
