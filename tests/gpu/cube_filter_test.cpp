// The cube filter for refreshes at run time against sums in double over the source's texels (docs/prefilter_gpu.md).
#include "gpu_scene/cube_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <random>

#include "gl/host_state.h"
#include "gl_fixture.h"
#include "gpu_scene/layout.h"
#include "prefilter/cube.h"
#include "prefilter/irradiance.h"
#include "prefilter/parallel.h"
#include "reference/shading.h"
#include "temporary_folder.h"

using namespace burnish;
using namespace burnish::gpu_scene;
using namespace burnish::test;
using glm::dvec3;
using prefilter::faceTexels;
using prefilter::texelDirection;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Three inputs in a picture, one a channel.
struct Picture {
  std::array<const char*, 3> names;
  CubeLevel cube;
};
/// Toward suns: beside an edge, in the middle of a face, in a corner.
const dvec3 kSuns[3] = {glm::normalize(dvec3(1, 0.21, 0.995)), dvec3(0, 0, -1), glm::normalize(dvec3(-1, 1, 1))};
/// A sky of 1 and a disc of 6e4, little larger than the sun (0.67 degrees) where faces have 256² texels, else so large that it holds some texels' centres.
double sunny(const dvec3& d, int sun, int size) { return dot(d, kSuns[sun]) > std::cos(1.5 / size) ? 6e4 : 1.0; }

template <class Radiance>
CubeLevel painted(int size, const Radiance& radiance) {
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
Picture mixed(int size) {
  std::mt19937 random(11);
  return {{"smooth", "noise", "sun"}, painted(size, [&](const dvec3& d) {
            const double noise = std::uniform_real_distribution<double>(0, 1)(random);
            return dvec3(1 + 0.5 * d.x + 0.3 * d.y * d.z + 0.4 * std::sin(3 * d.y + 2 * d.x), 4 * noise * noise, sunny(d, 0, size));
          })};
}
Picture suns(int size) {
  return {{"sun in the middle", "sun in a corner", "sun by an edge"}, painted(size, [&](const dvec3& d) { return dvec3(sunny(d, 1, size), sunny(d, 2, size), sunny(d, 0, size)); })};
}
CubeLevel picture(int size) { return mixed(size).cube; }

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

bool same(const CubeLevel& a, const CubeLevel& b) { return a.texels == b.texels; }

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

/// Whose centre is nearest, or nearly.
Texel texelToward(const dvec3& d, int size) {
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
std::vector<Texel> texelsToCheck(int size, int count) {
  std::vector<Texel> texels = {{0, 0, 0}, {0, size - 1, 0}, {4, size - 1, size / 2}, {0, 0, size / 2}, {2, size / 2, size - 1}, {5, size / 2, size / 2}};
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < count; ++i) {
    texels.push_back(texelToward(glm::normalize(dvec3(normal(random), normal(random), normal(random))), size));
    for (const dvec3& sun : kSuns) texels.push_back(texelToward(glm::normalize(sun + std::ldexp(0.3, -(i % 4)) * dvec3(normal(random), normal(random), normal(random))), size));
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

/// Of the coefficients, over the mean.
double irradianceError(const CubeFilter& filter, const CubeLevel& source) {
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
std::vector<double> timed(GlFixture& f, CubeFilter& filter, const gl::Texture& source, const gl::Texture& target) {
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

std::string rowOf(ReflectionLobe lobe, int level, int levels, int size, double points, double ms, const LevelError& e, const Picture& shown) {
  std::string text = fmt::format("{} level {} r {:.3f} {}²: {:.0f} points, {:.1f} CPU ms;", named(lobe), level, roughnessOf(level, levels), size, points, ms);
  for (int c = 0; c < 3; ++c) text += fmt::format(" {} {:.1e} {:.1e}", shown.names[std::size_t(c)], e.rms[c], e.worst[c]);
  return text;
}

}  // namespace

TEST_CASE("cube filter: every level against sums in double") {
  Filter f;
  const int size = 128;
  for (const Picture& shown : {mixed(size), suns(size)}) {
    const gl::Texture source = uploaded(f, shown.cube), target = cubeTexture(f, size, 0);  // down to 1²
    const Points points(readBack(source, 0));
    for (const ReflectionLobe lobe : {ReflectionLobe::BlinnPhong, ReflectionLobe::Ggx}) {
      CubeFilterOptions options;
      options.lobe = lobe;
      CubeFilter filter(*f.device, f.programs, options);
      const std::vector<double> ms = timed(f, filter, source, target);
      CHECK(same(readBack(target, 0), readBack(source, 0)));
      for (int k = 1; k < target.levels; ++k) {
        const CubeLevel level = readBack(target, k);
        const LevelError e = errorOf(level, points, lobe, roughnessOf(k, target.levels), 20);
        WARN(rowOf(lobe, k, target.levels, level.size, filter.pointsOf(k), ms[std::size_t(k) + 1], e, shown));
        for (int c = 0; c < 3; ++c) {
          CAPTURE(shown.names[std::size_t(c)]);
          // Half floats round by 2e-4 rms, 4.9e-4 at most. Lobes that the horizon cuts off while they are high have a kink there, which a sun that stands on it shows.
          const double bound = roughnessOf(k, target.levels) > 0.7 ? 4e-3 : 1e-3;
          CHECK(e.rms[c] < bound);
          CHECK(e.worst[c] < bound);
        }
      }
    }
  }
}

TEST_CASE("cube filter: constant in, constant out to the last bit") {
  Filter f;
  CubeLevel cube{64, 0, std::vector<float>(18 * faceTexels(64))};
  for (std::size_t i = 0; i < cube.texels.size(); ++i) cube.texels[i] = std::array{0.7f, 20.0f, 3e-3f}[i % 3];
  const gl::Texture source = uploaded(f, cube);
  const CubeLevel stored = readBack(source, 0);
  for (const int width : {64, 32})
    for (const ReflectionLobe lobe : {ReflectionLobe::BlinnPhong, ReflectionLobe::Ggx}) {
      const gl::Texture target = cubeTexture(f, width, 0);
      CubeFilterOptions options;
      options.lobe = lobe;
      CubeFilter filter(*f.device, f.programs, options);
      REQUIRE(filter.filter(source, target));
      std::size_t off = 0;
      for (const CubeLevel& level : readAll(target))
        for (std::size_t i = 0; i < level.texels.size(); ++i) off += level.texels[i] != stored.texels[i % 3];
      CHECK(off == 0);
      const auto irradiance = filter.readIrradiance();
      for (int c = 0; c < 3; ++c) {
        CHECK(double(irradiance[0][c]) == Approx(double(stored.texels[std::size_t(c)])).epsilon(1e-6));
        for (std::size_t k = 1; k < 9; ++k) CHECK(std::abs(double(irradiance[k][c])) < 2e-6 * double(stored.texels[std::size_t(c)]));
      }
    }
}

TEST_CASE("cube filter: steps across the twelve edges are those inside faces") {
  Filter f;
  const int size = 128;
  const gl::Texture source = uploaded(f, painted(size, [](const dvec3& d) { return 1.0 + 0.9 * d; })), target = cubeTexture(f, size, 5);
  CubeFilter filter(*f.device, f.programs);
  REQUIRE(filter.filter(source, target));
  // A lobe makes a smaller slope of a slope, the same everywhere: least squares over pairs of neighbours.
  for (int k = 1; k < target.levels; ++k) {
    const CubeLevel level = readBack(target, k);
    const int n = level.size;
    std::vector<Texel> border;
    for (int face = 0; face < 6; ++face)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
          if (x == 0 || y == 0 || x == n - 1 || y == n - 1) border.push_back({face, x, y});
    struct Slope {
      double top = 0, bottom = 0;
    } across, inside;
    const auto add = [&](Slope& s, const Texel& a, const Texel& b) {
      const dvec3 way = texelDirection(n, b.face, b.x, b.y) - texelDirection(n, a.face, a.x, a.y), step = at(level, b) - at(level, a);
      s.top += dot(step, way), s.bottom += dot(way, way);
    };
    for (const Texel& a : border) {
      const dvec3 d = texelDirection(n, a.face, a.x, a.y);
      const Texel* nearest = nullptr;
      double best = -2;
      for (const Texel& b : border)
        if (const double c = dot(d, texelDirection(n, b.face, b.x, b.y)); b.face != a.face && c > best) best = c, nearest = &b;
      add(across, a, *nearest);
    }
    for (int face = 0; face < 6; ++face)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x + 1 < n; ++x) {
          add(inside, {face, x, y}, {face, x + 1, y});
          add(inside, {face, y, x}, {face, y, x + 1});
        }
    const double ratio = across.top / across.bottom / (inside.top / inside.bottom);
    WARN("level " << k << ", " << n << "²: steps across edges over those inside " << ratio);
    CHECK(ratio == Approx(1).margin(0.02));
  }
}

TEST_CASE("cube filter: slices in any size and every run give the same bytes, and leave no state behind") {
  Filter f;
  const gl::Texture source = uploaded(f, picture(64)), small = uploaded(f, picture(32));
  const gl::StateSnapshot before = gl::captureState(*f.device);
  std::vector<std::vector<CubeLevel>> results;
  std::vector<std::array<glm::vec3, 9>> irradiance;
  for (const double work : {1e12, 1e12, 1e5}) {
    const gl::Texture target = cubeTexture(f, 64, 4), other = cubeTexture(f, 16, 1);
    CubeFilterOptions options;
    options.sliceWork = work;
    CubeFilter filter(*f.device, f.programs, options);
    // A refresh that is given up in the middle leaves nothing.
    REQUIRE(filter.begin(small, other));
    REQUIRE(filter.filterSlice());
    REQUIRE(filter.begin(source, target));
    CHECK(filter.slices() == (work > 1e6 ? 2 + 4 * 6 : filter.slices()));
    if (work < 1e6) CHECK(filter.slices() > 2 + 4 * 6 + 20);
    for (bool last = false; !last;) {
      last = filter.filterSlice().value();
      gl::Texture between = cubeTexture(f, 16, 1);  // other work of a frame
      between.clear({1, 2, 3, 4});
    }
    CHECK(filter.slicesDone() == filter.slices());
    CHECK_FALSE(filter.filterSlice());
    results.push_back(readAll(target));
    irradiance.push_back(filter.readIrradiance());
  }
  for (std::size_t i = 1; i < results.size(); ++i) {
    for (std::size_t k = 0; k < results[0].size(); ++k) CHECK(same(results[i][k], results[0][k]));
    CHECK((irradiance[i] == irradiance[0]));
  }
  const gl::StateSnapshot after = gl::captureState(*f.device);
  for (std::size_t i = 0; i < before.size(); ++i) {
    CAPTURE(gl::stateTable()[i].name);
    CHECK(before[i] == after[i]);
  }
}

TEST_CASE("cube filter: what is no number is black, what is infinite or negative is held") {
  Filter f;
  CubeLevel cube = picture(32), mended = cube;
  const float inf = std::numeric_limits<float>::infinity();
  const std::size_t at[5] = {0, 100, 3 * 1024 + 17, 9 * 1024, 17 * 1024 + 5};
  const float bad[5] = {std::nanf(""), inf, -inf, -3, 65504}, good[5] = {0, 65024, 0, 0, 65024};
  for (int i = 0; i < 5; ++i) cube.texels[at[i]] = bad[i], mended.texels[at[i]] = good[i];
  const gl::Texture source = uploaded(f, cube), whole = uploaded(f, mended), target = cubeTexture(f, 32, 0), expected = cubeTexture(f, 32, 0);
  CubeFilter filter(*f.device, f.programs);
  REQUIRE(filter.filter(source, target));
  REQUIRE(filter.filter(whole, expected));
  for (int k = 0; k < target.levels; ++k) {
    const CubeLevel level = readBack(target, k);
    CHECK(same(level, readBack(expected, k)));
    CHECK(std::all_of(level.texels.begin(), level.texels.end(), [](float v) { return v >= 0 && v <= 65504; }));
  }
}

TEST_CASE("cube filter: irradiance, smaller targets, and clear errors") {
  Filter f;
  const gl::Texture source = uploaded(f, picture(128)), half = cubeTexture(f, 64, 4);
  const CubeLevel stored = readBack(source, 0);
  CubeFilter filter(*f.device, f.programs);
  CHECK(filter.slices() == 0);
  REQUIRE(filter.filter(source, half));
  CHECK(irradianceError(filter, stored) < 5e-5);
  // The least that is taken: one grid, and texels whose solid angles show what the series leaves out.
  const gl::Texture least = uploaded(f, picture(16)), leastTarget = cubeTexture(f, 16, 0);
  const CubeLevel leastStored = readBack(least, 0);
  REQUIRE(filter.filter(least, leastTarget));
  CHECK(irradianceError(filter, leastStored) < 5e-5);
  for (int k = 1; k < leastTarget.levels; ++k) {
    const LevelError e = errorOf(readBack(leastTarget, k), Points(leastStored), ReflectionLobe::BlinnPhong, roughnessOf(k, leastTarget.levels), 20);
    for (int c = 0; c < 3; ++c) CHECK(e.rms[c] < 1e-3);
  }

  const CubeLevel mean = prefilter::resized(stored, 64), zero = readBack(half, 0);
  double off = 0;
  for (std::size_t i = 0; i < mean.texels.size(); ++i) off = std::fmax(off, std::abs(double(zero.texels[i] / mean.texels[i]) - 1));
  CHECK(off < 5e-4);
  const Points points(stored);
  for (int k = 1; k < half.levels; ++k) {
    const LevelError e = errorOf(readBack(half, k), points, ReflectionLobe::BlinnPhong, roughnessOf(k, half.levels), 20);
    for (int c = 0; c < 3; ++c) CHECK(e.rms[c] < 5e-4);
  }

  CHECK_FALSE(filter.begin(half, source));
  CHECK_FALSE(filter.filterSlice());
  CHECK_FALSE(filter.begin(cubeTexture(f, 24, 1), half));
  CHECK_FALSE(filter.begin(cubeTexture(f, 8, 1), cubeTexture(f, 8, 1)));
  auto flat = gl::Texture::create(*f.device, {.format = GL_RGBA16F, .width = 64, .height = 64}, "flat");
  REQUIRE(flat);
  CHECK_FALSE(filter.begin(source, *flat));
  CHECK_FALSE(filter.begin(*flat, half));
}

// The usual way, for comparison: directions drawn from the lobe, each looked up in a mip level as coarse as its share of the sphere (Křivánek and Colbert 2008, "Real-time Shading with Filtered
// Importance Sampling"; with the bias of one level of GPU Gems 3, chapter 20).
TEST_CASE("cost of filtered importance sampling", "[.cost]") {
  Filter f;
  const int size = 256;
  const Picture shown = mixed(size);
  gl::Texture source = cubeTexture(f, size, 0);
  for (int face = 0; face < 6; ++face) source.upload(0, shown.cube.texels.data() + 3 * std::size_t(face) * faceTexels(size), face, GL_RGB, GL_FLOAT);
  source.generateMips();
  source.setFilter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
  const Points points(readBack(source, 0));
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path / "prefilter");
  std::ofstream(folder.path / "prefilter/sampled.frag") << R"(
#include "prefilter/cube.glsl"
layout(binding = UNIT_CUBE_FILTER) uniform samplerCube source;
layout(location = 0) uniform ivec3 target;
layout(std140, binding = BINDING_CUBE_FILTER) uniform Samples { vec4 samples[1024]; };
layout(location = 0) out vec4 outLight;
void main() {
  vec3 r = texelDirection(target.x, target.y), t = normalize(abs(r.y) < 0.9 ? cross(r, vec3(0.0, 1.0, 0.0)) : cross(r, vec3(1.0, 0.0, 0.0))), b = cross(r, t), sum = vec3(0.0);
  for (int i = 0; i < target.z; ++i) sum += textureLod(source, t * samples[i].x + b * samples[i].y + r * samples[i].z, samples[i].w).rgb;
  outLight = vec4(rounded(sum / float(target.z)), 1.0);
}
)";
  gl::ProgramCache programs(*f.device, gl::ShaderLibrary(folder.path));
  auto program = programs.get({"sampled", "post/screen.vert", "prefilter/sampled.frag", {}, {}});
  if (!program) FAIL(program.error().message());
  const gl::VertexArray none = gl::VertexArray::create(*f.device, {}, {}, 0, "none");
  f.gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  const gl::Texture target = cubeTexture(f, size, 6);
  for (const int count : {64, 256, 1024})
    for (int k = 1; k < target.levels; ++k) {
      const prefilter::Lobe lobe = prefilter::Lobe::of(ReflectionLobe::BlinnPhong, roughnessOf(k, target.levels));
      // The lobe's integral up to x, tabulated in the square root of x.
      constexpr int kSteps = 20'000;
      std::vector<double> integral(kSteps + 1);
      for (int i = 0; i < kSteps; ++i) integral[std::size_t(i) + 1] = integral[std::size_t(i)] + lobe(std::pow((i + 0.5) / kSteps, 2)) * 2 * (i + 0.5) / kSteps / kSteps;
      std::vector<glm::vec4> samples;
      for (int i = 0; i < count; ++i) {
        const auto at = std::lower_bound(integral.begin(), integral.end(), (i + 0.5) / count * integral.back());
        const double x = std::pow(double(at - integral.begin()) / kSteps, 2), sine = std::sqrt(x * (2 - x)), azimuth = i * 2.39996322972865332;
        const double density = std::max(lobe(x), 1e-6) / (2 * kPi * integral.back()), texel = 4 * kPi / 6 / size / size;
        samples.emplace_back(sine * std::cos(azimuth), sine * std::sin(azimuth), 1 - x, std::fmax(0.5 * std::log2(1 / (count * density * texel)) + 1, 0.0));
      }
      samples.resize(1024);
      auto buffer = gl::Buffer::create(*f.device, gl::BufferUse::Static, std::span<const glm::vec4>(samples), "samples");
      REQUIRE(buffer);
      buffer->bindBase(GL_UNIFORM_BUFFER, BINDING_CUBE_FILTER);
      source.bind(UNIT_CUBE_FILTER);
      none.bind();
      (*program)->use();
      double ms = 0;
      for (int run = 0; run < 2; ++run) {
        const double start = prefilter::cpuMilliseconds();
        for (int face = 0; face < 6; ++face) {
          const gl::Attachment color(target, k, face);
          auto framebuffer = gl::Framebuffer::create(*f.device, {&color, 1}, {}, "sampled");
          REQUIRE(framebuffer);
          framebuffer->bind();
          f.gl.Viewport(0, 0, size >> k, size >> k);
          f.gl.ProgramUniform3i((*program)->id(), 0, face, size >> k, count);
          f.gl.DrawArrays(GL_TRIANGLES, 0, 3);
          f.gl.Finish();
        }
        ms = prefilter::cpuMilliseconds() - start;
      }
      f.gl.UseProgram(0);
      WARN("importance sampling, " << rowOf(ReflectionLobe::BlinnPhong, k, target.levels, size >> k, count, ms, errorOf(readBack(target, k), points, ReflectionLobe::BlinnPhong, roughnessOf(k, target.levels), 20), shown));
    }
}

TEST_CASE("cost of the cube filter by effort", "[.cost]") {
  Filter f;
  const char* wanted = std::getenv("BURNISH_CUBE_SIZE");
  const int size = wanted ? std::atoi(wanted) : 256;
  const Picture shown = mixed(size);
  const gl::Texture source = uploaded(f, shown.cube);
  const Points points(readBack(source, 0));
  const gl::Texture target = cubeTexture(f, size, std::countr_zero(unsigned(size)) - 2);
  for (const ReflectionLobe lobe : {ReflectionLobe::BlinnPhong, ReflectionLobe::Ggx})
    for (const double fineness : {0.75, 1.0, 1.5, 2.0}) {
      CubeFilterOptions options;
      options.lobe = lobe;
      options.effort.fineness = fineness;
      options.effort.far *= std::pow(1.5 / fineness, 6);
      CubeFilter filter(*f.device, f.programs, options);
      const std::vector<double> ms = timed(f, filter, source, target);
      WARN(fmt::format("{} fineness {}: grids and irradiance {:.1f} CPU ms, level 0 {:.1f}, all {:.1f}, {} slices", named(lobe), fineness, ms[0], ms[1], std::accumulate(ms.begin(), ms.end(), 0.0), filter.slices()));
      for (int k = 1; k < target.levels; ++k) {
        const CubeLevel level = readBack(target, k);
        WARN(rowOf(lobe, k, target.levels, level.size, filter.pointsOf(k), ms[std::size_t(k) + 1], errorOf(level, points, lobe, roughnessOf(k, target.levels), 20), shown));
      }
    }
  // Other numbers of levels have other roughnesses, and so other places between two grids.
  for (const ReflectionLobe lobe : {ReflectionLobe::BlinnPhong, ReflectionLobe::Ggx}) {
    double rms = 0, worst = 0;
    for (int levels = 2; levels <= 9; ++levels) {
      const gl::Texture few = cubeTexture(f, size, levels);
      CubeFilterOptions options;
      options.lobe = lobe;
      CubeFilter filter(*f.device, f.programs, options);
      REQUIRE(filter.filter(source, few));
      for (int k = 1; k < levels; ++k) {
        const LevelError e = errorOf(readBack(few, k), points, lobe, roughnessOf(k, levels), 10);
        for (int c = 0; c < 3; ++c) rms = std::fmax(rms, e.rms[c]), worst = std::fmax(worst, e.worst[c]);
      }
    }
    WARN(named(lobe) << ", 2 to 9 levels: rms " << rms << ", at most " << worst << " of the level's largest value");
  }
}
