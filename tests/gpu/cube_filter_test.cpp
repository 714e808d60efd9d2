// The cube filter for refreshes at run time against sums in double over the source's texels (docs/prefilter_gpu.md).
#include "cube_filter.h"

#include <limits>

#include "gl/host_state.h"
#include "stability/cube_texels.h"

using namespace burnish;
using namespace burnish::test;

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
  // A lobe makes a smaller slope of a slope, the same everywhere.
  for (int k = 1; k < target.levels; ++k) {
    const CubeLevel level = readBack(target, k);
    const double ratio = stability::seamRatio(level);
    WARN("level " << k << ", " << level.size << "²: steps across edges over those inside " << ratio);
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
