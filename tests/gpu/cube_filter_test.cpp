// The cube filter for refreshes at run time against sums in double over the source's texels (docs/prefilter_gpu.md).
#include "gpu_scene/cube_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "gl/host_state.h"
#include "gl_fixture.h"
#include "prefilter/cube.h"
#include "prefilter/irradiance.h"
#include "prefilter/parallel.h"
#include "reference/shading.h"

using namespace burnish;
using namespace burnish::gpu_scene;
using namespace burnish::test;
using glm::dvec3;
using prefilter::faceTexels;
using prefilter::texelDirection;

namespace {

constexpr const char* kInputs[3] = {"smooth", "noise", "sun"};

/// Red varies smoothly, green is noise of its own in each texel, blue a sky of 1 and a disc of the sun's size, 6e4, beside an edge.
dvec3 radianceAt(const dvec3& d, std::mt19937& random, double sunCosine) {
  static const dvec3 kSun = glm::normalize(dvec3(1, 0.21, 0.995));
  const double smooth = 1 + 0.5 * d.x + 0.3 * d.y * d.z + 0.4 * std::sin(3 * d.y + 2 * d.x);
  const double noise = std::uniform_real_distribution<double>(0, 1)(random);
  return {smooth, noise * noise * 4, dot(d, kSun) > sunCosine ? 6e4 : 1.0};
}

CubeLevel picture(int size) {
  CubeLevel cube{size, 0, std::vector<float>(18 * faceTexels(size))};
  std::mt19937 random(11);
  float* out = cube.texels.data();
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x, out += 3) {
        const dvec3 c = radianceAt(texelDirection(size, face, x, y), random, std::cos(1.0 / size));  // so that some texels' centres lie in it
        for (int k = 0; k < 3; ++k) out[k] = float(c[k]);
      }
  return cube;
}

gl::Texture cubeTexture(GlFixture& f, int size, int levels) {
  auto made = gl::Texture::create(*f.device, {.target = GL_TEXTURE_CUBE_MAP, .format = GL_RGBA16F, .width = size, .height = size, .levels = levels}, "test cube");
  REQUIRE(made);
  return std::move(*made);
}

gl::Texture uploaded(GlFixture& f, const CubeLevel& cube) {
  gl::Texture texture = cubeTexture(f, cube.size, 1);
  for (int face = 0; face < 6; ++face) texture.upload(0, cube.texels.data() + 3 * std::size_t(face) * faceTexels(cube.size), face, GL_RGB, GL_FLOAT);
  return texture;
}

CubeLevel readBack(const gl::Texture& texture, int level) {
  const int size = std::max(1, texture.width >> level);
  CubeLevel cube{size, 0, std::vector<float>(18 * faceTexels(size))};
  texture.read(level, std::as_writable_bytes(std::span(cube.texels)), GL_RGB, GL_FLOAT);
  return cube;
}

std::vector<CubeLevel> readAll(const gl::Texture& texture) {
  std::vector<CubeLevel> levels;
  for (int k = 0; k < texture.levels; ++k) levels.push_back(readBack(texture, k));
  return levels;
}

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
dvec3 bruteForce(const Points& points, ReflectionLobe shape, double roughness, const dvec3& r) {
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

/// Corners and edges, a grid over all faces, and as many near the sun.
std::vector<Texel> texelsToCheck(int size, int count) {
  std::vector<Texel> texels = {{0, 0, 0}, {0, size - 1, 0}, {4, size - 1, size / 2}, {0, 0, size / 2}, {2, size / 2, size - 1}, {5, size / 2, size / 2}};
  std::mt19937 random(5);
  const auto below = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
  // The sun stands at the edge of faces 0 and 4, a tenth above their middle.
  const int near = std::max(2, size / 8), row = int(0.395 * size);
  for (int i = 0; i < count; ++i) {
    texels.push_back({below(6), below(size), below(size)});
    const int aside = below(near), y = std::clamp(row + below(2 * near) - near, 0, size - 1);
    texels.push_back(i % 2 ? Texel{0, aside, y} : Texel{4, size - 1 - aside, y});
  }
  return texels;
}

dvec3 at(const CubeLevel& cube, const Texel& t) {
  const float* p = cube.texels.data() + 3 * (std::size_t(t.face) * faceTexels(cube.size) + std::size_t(t.y) * std::size_t(cube.size) + std::size_t(t.x));
  return {p[0], p[1], p[2]};
}

struct LevelError {
  dvec3 rms{0}, worst{0};  ///< over the reference's rms, over its largest value
};
LevelError errorOf(const CubeLevel& cube, const Points& points, ReflectionLobe shape, double roughness, int count) {
  dvec3 square(0), reference(0), worst(0), largest(0);
  for (const Texel& t : texelsToCheck(cube.size, count)) {
    const dvec3 truth = bruteForce(points, shape, roughness, texelDirection(cube.size, t.face, t.x, t.y)), e = at(cube, t) - truth;
    square += e * e, reference += truth * truth;
    worst = glm::max(worst, glm::abs(e)), largest = glm::max(largest, truth);
  }
  return {glm::sqrt(square / reference), worst / largest};
}

double roughnessOf(int level, int levels) { return shading::f64::environmentRoughness(double(level), double(levels - 1)); }

std::string named(ReflectionLobe lobe) { return lobe == ReflectionLobe::Ggx ? "GGX" : "Blinn-Phong"; }

struct Filter : GlFixture {
  gl::ProgramCache programs{*device, gl::ShaderLibrary(std::filesystem::path())};
};

}  // namespace

TEST_CASE("cube filter: error and cost by effort", "[.cost]") {
  Filter f;
  const int size = std::getenv("CUBE_SIZE") ? std::atoi(std::getenv("CUBE_SIZE")) : 256;
  const gl::Texture source = uploaded(f, picture(size));
  const Points points(readBack(source, 0));
  const gl::Texture target = cubeTexture(f, size, std::countr_zero(unsigned(size)) - 2);
  for (const ReflectionLobe lobe : {ReflectionLobe::BlinnPhong, ReflectionLobe::Ggx})
    for (const double fineness : {1.25, 1.75, 2.5, 3.5}) {
      CubeFilterOptions options;
      options.lobe = lobe;
      options.effort.fineness = fineness;
      options.effort.reach = 2.4 * fineness;
      options.effort.horizon = fineness < 2 ? 32 : 64;
      CubeFilter filter(*f.device, f.programs, options);
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
      std::string text = fmt::format("\n{} fineness {}: grids {:.1f} ms, level 0 {:.1f} ms, {} slices\n", named(lobe), fineness, ms[0], ms[1], filter.slices());
      for (int k = 1; k < target.levels; ++k) {
        const LevelError e = errorOf(readBack(target, k), points, lobe, roughnessOf(k, target.levels), 40);
        text += fmt::format("  level {} r {:.3f} {:3}²: {:6.0f} points, {:7.1f} ms;", k, roughnessOf(k, target.levels), target.width >> k, filter.pointsOf(k), ms[std::size_t(k) + 1]);
        for (int c = 0; c < 3; ++c) text += fmt::format("  {} rms {:.2e} max {:.2e}", kInputs[c], e.rms[c], e.worst[c]);
        text += "\n";
      }
      WARN(text);
    }
}
