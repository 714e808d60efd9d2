// A light shown by its reflection in prefiltered levels and by direct lighting: one and the same highlight (H27 of docs/hard_cases.md). Through GL: tests/gpu/environment_test.cpp.
#include "disc.h"

#include <catch2/catch.hpp>

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;

namespace {

template <class F>
void eachTexel(const CubeLevel& level, const F& f) {
  std::size_t i = 0;
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < level.size; ++y)
      for (int x = 0; x < level.size; ++x, i += 3) f(centreOf(level.size, face, x, y), double(level.texels[i]));
}

}  // namespace

TEST_CASE("level and environmentLevel agree on roughness") {
  namespace f32 = shading::f32;
  for (const int size : {16, 64, 256}) {
    const Cubemap cube = prefilterCubemap(cubeOf(16, [](const dvec3&) { return dvec3(1); }), {.size = size, .threads = 1}).value();
    const double last = double(cube.levels.size()) - 1;
    CHECK(cube.levels.front().roughness == 0);
    CHECK(cube.levels.back().roughness == Approx(1).epsilon(1e-12));
    for (std::size_t k = 0; k < cube.levels.size(); ++k) {
      INFO("level " << k << " from " << size << "²");
      CHECK(shading::f64::environmentLevel(cube.levels[k].roughness, last) == Approx(double(k)).margin(1e-6));
      CHECK(double(f32::environmentLevel(float(cube.levels[k].roughness), float(last))) == Approx(double(k)).margin(1e-6));
    }
  }
}

TEST_CASE("a disc of 0.53 degrees: levels hold the analytic light's highlight (H27)") {
  // Beside the edge of +X and -Z. Texels of the source an eighth of a degree: drawn on 256² faces, the disc is two texels across and as wide as they make it.
  Disc disc;
  disc.centre = glm::normalize(dvec3(1, 0.3, -0.97));
  const CubeLevel source = discCube(1024, disc);
  double flux = 0;
  const Points points = pointsOf(source);
  for (std::size_t i = 0; i < points.light.size(); ++i) flux += points.light[i].x * points.solidAngle[i];
  CHECK(flux == Approx(disc.radiance * disc.solidAngle()).epsilon(3e-4));
  for (const ReflectionLobe lobe : kLobes) {
    const Cubemap cube = prefilterCubemap(source, {.lobe = lobe, .size = 256}).value();
    for (std::size_t k = 1; k < cube.levels.size(); ++k) {
      const CubeLevel& level = cube.levels[k];
      const DiscProfile profile(disc, lobe, level.roughness);
      REQUIRE(profile.halfWidth() > disc.radius);  // the default levels are all wider than the disc
      const double peak = profile.peak();
      double worst = 0, worstOfPoint = 0, largest = 0;
      eachTexel(level, [&](const dvec3& r, double value) {
        worst = std::max(worst, std::abs(value - profile(r)) / peak);
        worstOfPoint = std::max(worstOfPoint, std::abs(value - profile.ofPoint(r)) / peak);
        largest = std::max(largest, value / peak);
      });
      WARN(lobeName(lobe) << ", level " << k << " (" << level.size << "², half-width " << profile.halfWidth() / kCircle * 360 << " degrees): off the disc by " << 100 * worst << " % of the peak, off a point light by "
                        << 100 * worstOfPoint << " %; the largest texel has " << 100 * largest << " %");
      CHECK(worst < 1e-3);
      CHECK(largest > 0.5);  // there is a highlight
      if (profile.halfWidth() > 20 * disc.radius) CHECK(worstOfPoint < 1e-3);
    }
  }
}

TEST_CASE("texels of a 256² source are lights of their own: levels hold the sum of their highlights (H27)") {
  Disc disc;
  disc.centre = glm::normalize(dvec3(1, 0.3, -0.97));
  const CubeLevel source = discCube(256, disc);
  const Points points = pointsOf(source);
  std::vector<std::size_t> bright;
  for (std::size_t i = 0; i < points.light.size(); ++i)
    if (points.light[i].x > 0) bright.push_back(i);
  REQUIRE(bright.size() > 1);
  for (const ReflectionLobe lobe : kLobes) {
    const Cubemap cube = prefilterCubemap(source, {.lobe = lobe, .size = 256, .threads = 1}).value();
    for (std::size_t k = 1; k < cube.levels.size(); ++k) {
      const CubeLevel& level = cube.levels[k];
      std::vector<DiscProfile> lights;
      for (const std::size_t i : bright) {
        Disc one{points.direction[i], 1e-4, 0};
        one.radiance = points.light[i].x * points.solidAngle[i] / one.solidAngle();
        lights.emplace_back(one, lobe, level.roughness);
      }
      const DiscProfile drawn(disc, lobe, level.roughness);
      double worst = 0, worstOfDisc = 0;
      eachTexel(level, [&](const dvec3& r, double value) {
        double truth = 0;
        for (const DiscProfile& light : lights) truth += light.ofPoint(r);
        worst = std::max(worst, std::abs(value - truth) / drawn.peak());
        worstOfDisc = std::max(worstOfDisc, std::abs(value - drawn(r)) / drawn.peak());
      });
      WARN(lobeName(lobe) << ", level " << k << ": off its texels' highlights by " << 100 * worst << " % of the peak, off the disc's by " << 100 * worstOfDisc << " %");
      CHECK(worst < 1e-3);
    }
  }
}
