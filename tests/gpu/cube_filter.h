// What tests of the cube filter share: pictures, sums in double over a source's texels, errors and times.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "gl_fixture.h"
#include "gpu_scene/cube_filter.h"
#include "prefilter/cube.h"
#include "prefilter/irradiance.h"
#include "prefilter/parallel.h"
#include "reference/shading.h"

namespace burnish::test {

using namespace gpu_scene;
using glm::dvec3;
using prefilter::faceTexels;
using prefilter::texelDirection;

inline constexpr double kPi = 3.14159265358979323846;

/// Three inputs in a picture, one a channel.
struct Picture {
  std::array<const char*, 3> names;
  CubeLevel cube;
};
/// Toward suns: beside an edge, in the middle of a face, in a corner.
inline const dvec3 kSuns[3] = {glm::normalize(dvec3(1, 0.21, 0.995)), dvec3(0, 0, -1), glm::normalize(dvec3(-1, 1, 1))};
/// A sky of 1 and a disc of 6e4, little larger than the sun (0.67 degrees) where faces have 256² texels, else so large that it holds some texels' centres.
inline double sunny(const dvec3& d, int sun, int size) { return dot(d, kSuns[sun]) > std::cos(1.5 / size) ? 6e4 : 1.0; }

template <class Radiance>
inline CubeLevel painted(int size, const Radiance& radiance) {
  CubeLevel cube{size, 0, {}};
  cube.texels.reserve(18 * faceTexels(size));
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const dvec3 light = radiance(texelDirection(size, face, x, y));
        for (int c = 0; c < 3; ++c) cube.texels.push_back(float(light[c]));
      }
  return cube;
}

/// Smooth, noise of its own in each texel, a sun.
inline Picture mixed(int size) {
  std::mt19937 random(11);
  return {{"smooth", "noise", "sun"}, painted(size, [&](const dvec3& d) {
            const double noise = std::uniform_real_distribution<double>(0, 1)(random);
            return dvec3(1 + 0.5 * d.x + 0.3 * d.y * d.z + 0.4 * std::sin(3 * d.y + 2 * d.x), 4 * noise * noise, sunny(d, 0, size));
          })};
}
inline Picture suns(int size) {
  return {{"sun in the middle", "sun in a corner", "sun by an edge"}, painted(size, [&](const dvec3& d) { return dvec3(sunny(d, 1, size), sunny(d, 2, size), sunny(d, 0, size)); })};
}
inline CubeLevel picture(int size) { return mixed(size).cube; }

inline gl::Texture cubeTexture(GlFixture& f, int size, int levels) {
  auto made = gl::Texture::create(*f.device, {.target = GL_TEXTURE_CUBE_MAP, .format = GL_RGBA16F, .width = size, .height = size, .levels = levels}, "test cube");
  REQUIRE(made);
  return std::move(*made);
}

inline gl::Texture uploaded(GlFixture& f, const CubeLevel& cube) {
  gl::Texture texture = cubeTexture(f, cube.size, 1);
  for (int face = 0; face < 6; ++face) texture.upload(0, cube.texels.data() + 3 * std::size_t(face) * faceTexels(cube.size), face, GL_RGB, GL_FLOAT);
  return texture;
}

inline CubeLevel readBack(const gl::Texture& texture, int level) {
  const int size = std::max(1, texture.width >> level);
  CubeLevel cube{size, 0, std::vector<float>(18 * faceTexels(size))};
  texture.read(level, std::as_writable_bytes(std::span(cube.texels)), GL_RGB, GL_FLOAT);
  return cube;
}

inline std::vector<CubeLevel> readAll(const gl::Texture& texture) {
  std::vector<CubeLevel> levels;
  for (int k = 0; k < texture.levels; ++k) levels.push_back(readBack(texture, k));
  return levels;
}

inline bool same(const CubeLevel& a, const CubeLevel& b) { return a.texels == b.texels; }

/// A source's texels as points.
struct Points {
  std::vector<dvec3> direction, light;
  std::vector<double> solidAngle;
  explicit Points(const CubeLevel& cube) {
    const float* p = cube.texels.data();
    for (int face = 0; face < 6; ++face)
      for (int y = 0; y < cube.size; ++y)
        for (int x = 0; x < cube.size; ++x, p += 3) {
          direction.push_back(texelDirection(cube.size, face, x, y));
          light.emplace_back(p[0], p[1], p[2]);
          solidAngle.push_back(prefilter::texelSolidAngle(cube.size, x, y));
        }
  }
};

/// Σ light × lobe / Σ lobe, the lobe written out (docs/shading.md, section 5).
inline dvec3 bruteForce(const Points& points, ReflectionLobe shape, double roughness, const dvec3& r) {
  const double alpha2 = std::pow(roughness, 4), power = 2 / alpha2 - 2, nothing = shape == ReflectionLobe::BlinnPhong && power > 0 ? std::pow(1e-14, 2 / power) : 0;
  dvec3 sum(0);
  double total = 0;
  for (std::size_t i = 0; i < points.direction.size(); ++i) {
    const double c = dot(points.direction[i], r), noh2 = (1 + c) / 2;
    if (c <= 0 || noh2 < nothing) continue;
    const double d = noh2 * (alpha2 - 1) + 1;
    const double w = points.solidAngle[i] * c * (shape == ReflectionLobe::Ggx ? 1 / (d * d) : std::exp(power / 2 * std::log(noh2)));
    sum += w * points.light[i];
    total += w;
  }
  return sum / total;
}

struct Texel {
  int face, x, y;
};

/// Whose centre is nearest, or nearly.
inline Texel texelToward(const dvec3& d, int size) {
  Texel best{0, 0, 0};
  double most = -1;
  for (int face = 0; face < 6; ++face) {
    const dvec3 axis = prefilter::cubeDirection(face, 0, 0), right = prefilter::cubeDirection(face, 1, 0) - axis, down = prefilter::cubeDirection(face, 0, 1) - axis;
    const double height = dot(d, axis);
    if (height <= most) continue;
    most = height;
    const auto index = [&](double u) { return std::clamp(int((u / height + 1) / 2 * size), 0, size - 1); };
    best = {face, index(dot(d, right)), index(dot(d, down))};
  }
  return best;
}

/// A corner, edges, texels anywhere, and three times as many around the suns.
inline std::vector<Texel> texelsToCheck(int size, int count) {
  std::vector<Texel> texels = {{0, 0, 0}, {0, size - 1, 0}, {4, size - 1, size / 2}, {0, 0, size / 2}, {2, size / 2, size - 1}, {5, size / 2, size / 2}};
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < count; ++i) {
    texels.push_back(texelToward(glm::normalize(dvec3(normal(random), normal(random), normal(random))), size));
    for (const dvec3& sun : kSuns) texels.push_back(texelToward(glm::normalize(sun + std::ldexp(0.3, -(i % 4)) * dvec3(normal(random), normal(random), normal(random))), size));
  }
  return texels;
}

inline dvec3 at(const CubeLevel& cube, const Texel& t) {
  const float* p = cube.texels.data() + 3 * (std::size_t(t.face) * faceTexels(cube.size) + std::size_t(t.y) * std::size_t(cube.size) + std::size_t(t.x));
  return {p[0], p[1], p[2]};
}

struct LevelError {
  dvec3 rms{0}, worst{0};  ///< over the reference's rms, over its largest value
};
inline LevelError errorOf(const CubeLevel& cube, const Points& points, ReflectionLobe shape, double roughness, int count) {
  dvec3 square(0), reference(0), worst(0), largest(0);
  for (const Texel& t : texelsToCheck(cube.size, count)) {
    const dvec3 truth = bruteForce(points, shape, roughness, texelDirection(cube.size, t.face, t.x, t.y)), e = at(cube, t) - truth;
    square += e * e, reference += truth * truth;
    worst = glm::max(worst, glm::abs(e)), largest = glm::max(largest, truth);
  }
  return {glm::sqrt(square / reference), worst / largest};
}

inline double roughnessOf(int level, int levels) { return shading::f64::environmentRoughness(double(level), double(levels - 1)); }

inline std::string named(ReflectionLobe lobe) { return lobe == ReflectionLobe::Ggx ? "GGX" : "Blinn-Phong"; }

/// Of the coefficients, over the mean.
inline double irradianceError(const CubeFilter& filter, const CubeLevel& source) {
  const prefilter::IrradianceSh truth = prefilter::irradianceOf(source);
  const auto irradiance = filter.readIrradiance();
  double worst = 0;
  for (std::size_t k = 0; k < 9; ++k)
    for (int c = 0; c < 3; ++c) worst = std::fmax(worst, std::abs(double(irradiance[k][c]) - truth[k][c]) / truth[0][c]);
  WARN("irradiance of " << source.size << "²: coefficients off by at most " << worst << " of the mean");
  return worst;
}

struct Filter : GlFixture {
  gl::ProgramCache programs{*device, gl::ShaderLibrary(std::filesystem::path())};
};

/// Filters twice, the second time with CPU ms by level (grids and irradiance first).
inline std::vector<double> timed(GlFixture& f, CubeFilter& filter, const gl::Texture& source, const gl::Texture& target) {
  REQUIRE(filter.begin(source, target));
  std::vector<double> ms(std::size_t(target.levels) + 1);
  for (int run = 0; run < 2; ++run) {
    std::fill(ms.begin(), ms.end(), 0.0);
    REQUIRE(filter.begin(source, target));
    for (bool last = false; !last;) {
      const int level = filter.levelOf(filter.slicesDone());
      const double start = prefilter::cpuMilliseconds();
      last = filter.filterSlice().value();
      f.gl.Finish();
      ms[std::size_t(level + 1)] += prefilter::cpuMilliseconds() - start;
    }
  }
  return ms;
}

inline std::string rowOf(ReflectionLobe lobe, int level, int levels, int size, double points, double ms, const LevelError& e, const Picture& shown) {
  std::string text = fmt::format("{} level {} r {:.3f} {}²: {:.0f} points, {:.1f} CPU ms;", named(lobe), level, roughnessOf(level, levels), size, points, ms);
  for (int c = 0; c < 3; ++c) text += fmt::format(" {} {:.1e} {:.1e}", shown.names[std::size_t(c)], e.rms[c], e.worst[c]);
  return text;
}

}  // namespace burnish::test
