// Light of the surroundings: prefiltered levels, irradiance (docs/shading.md, section 5).
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

#include "prefilter/cube.h"
#include "prefilter/environment.h"
#include "reference/shading.h"
#include "sphere.h"

using namespace burnish;
using namespace burnish::prefilter;
using namespace burnish::test;
using glm::dvec3;
using glm::vec3;
namespace f64 = burnish::shading::f64;
namespace f32 = burnish::shading::f32;

namespace {

/// Centre of a lat-long texel; the inverse of how the picture is read.
dvec3 latLongDirection(double x, double y, int width, int height) {
  const double longitude = ((x + 0.5) / width - 0.5) * 2 * kPi, polar = (y + 0.5) / height * kPi;
  return {std::sin(polar) * std::sin(longitude), std::cos(polar), -std::sin(polar) * std::cos(longitude)};
}

/// A picture of radiance(direction), each texel the mean of 4 × 4 samples.
Image latLong(int width, const std::function<dvec3(const dvec3&)>& radiance) {
  const int height = width / 2;
  Image image = makeImage(width, height, 3, PixelType::F32);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      dvec3 sum(0);
      for (int k = 0; k < 16; ++k)
        sum += radiance(latLongDirection(x + (k % 4 - 1.5) / 4, y + (k / 4 - 1.5) / 4, width, height));
      for (int c = 0; c < 3; ++c) image.f32()[(y * width + x) * 3 + c] = float(sum[c] / 16);
    }
  return image;
}

vec3 irradianceAt(const EnvironmentLight& light, const vec3& n) {
  const auto& c = light.irradiance;
  return f32::irradianceSh(n, c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], AMBIENT_SH_L2);
}

double lobeWeight(double cosine, double p) { return cosine > 0 ? std::pow(0.5 * (1 + cosine), 0.5 * p) * cosine : 0; }

/// ∫ lobeWeight dl over the sphere.
double lobeIntegral(double p) {
  double sum = 0;
  constexpr int kSteps = 200'000;
  for (int i = 0; i < kSteps; ++i) {  // c = 1 - t², so that narrow lobes are resolved
    const double t = (i + 0.5) / kSteps;
    sum += lobeWeight(1 - t * t, p) * 2 * t / kSteps;
  }
  return 2 * kPi * sum;
}

}  // namespace

TEST_CASE("texels of a cube cover the sphere once") {
  for (const int size : {1, 2, 7, 16, 64}) {
    double sum = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) sum += 6 * texelSolidAngle(size, x, y);
    CHECK(sum == Approx(4 * kPi).epsilon(1e-12));
  }
  // Near the centre of a face a texel is as large as it looks from distance 1, in a corner 3^-1.5 of that.
  CHECK(texelSolidAngle(1024, 512, 512) == Approx(4.0 / 1024 / 1024).epsilon(1e-4));
  CHECK(texelSolidAngle(1024, 0, 0) == Approx(4.0 / 1024 / 1024 * std::pow(3, -1.5)).epsilon(3e-3));
}

TEST_CASE("a constant environment stays constant at every level and in the irradiance") {
  const vec3 value(0.7f, 20.0f, 3e-3f);
  const EnvironmentLight light = prefilterEnvironment(latLong(64, [&](const dvec3&) { return dvec3(value); }), 64).value();
  REQUIRE(light.levels.size() == 4);
  double worst = 0;
  for (const CubeLevel& cube : light.levels)
    for (std::size_t i = 0; i < cube.texels.size(); ++i) worst = std::fmax(worst, std::abs(double(cube.texels[i]) / double(value[int(i % 3)]) - 1));
  CHECK(worst < 1e-6);
  std::mt19937_64 random(5);
  double worstSh = 0;
  for (int i = 0; i < 1000; ++i) {
    const vec3 e = irradianceAt(light, vec3(randomUnit(random)));
    for (int c = 0; c < 3; ++c) worstSh = std::fmax(worstSh, std::abs(double(e[c] / value[c]) - 1));
  }
  WARN("constant environment: levels off by " << worst << ", irradiance by " << worstSh);
  CHECK(worstSh < 1e-6);
  CHECK(light.meanLuminance == Approx(glm::dot(value, vec3(0.2126f, 0.7152f, 0.0722f))).epsilon(1e-4));
}

TEST_CASE("irradiance of a cosine sky against quadrature") {
  const dvec3 axis = glm::normalize(dvec3(0.3, 0.8, -0.5));
  const EnvironmentLight light =
      prefilterEnvironment(latLong(256, [&](const dvec3& d) { return dvec3(std::fmax(dot(d, axis), 0.0)); }), 64).value();
  std::mt19937_64 random(6);
  double worst = 0;
  for (int i = 0; i < 40; ++i) {
    const dvec3 n = i == 0 ? axis : i == 1 ? -axis : randomUnit(random);
    // Symmetric about the plane of n and the axis; there the axis has these coordinates about n.
    const dvec3 a = viewAt(glm::clamp(dot(n, axis), -1.0, 1.0));
    const double truth =
        integrateHemisphere([&](const dvec3& l) { return l.z * std::fmax(dot(l, a), 0.0); }, 200) / kPi;
    worst = std::fmax(worst, std::abs(double(irradianceAt(light, vec3(n)).x) - truth));
  }
  WARN("cosine sky: SH irradiance off by at most " << worst << " of the zenith's radiance");
  // Band 4, which L2 leaves out, holds -1/32 · -1/48 of both lobes: 9/4 · 1/36 · 1/36 · ... under one part in a
  // hundred.
  CHECK(worst < 0.01);
}

TEST_CASE("a small bright disc shows the lobe's own profile at every level") {
  // Off the faces' centres, near an edge of +X and -Z.
  const dvec3 centre = glm::normalize(dvec3(1.0, 0.2, -0.85));
  constexpr double kRadius = 0.02;
  const int width = 1024;
  const Image image =
      latLong(width, [&](const dvec3& d) { return dvec3(angleBetween(d, centre) < kRadius ? 1000 : 0); });
  // The disc as the picture holds it.
  std::vector<std::pair<dvec3, double>> disc;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x)
      if (const double value = double(image.f32()[(y * width + x) * 3]); value > 0) {
        const double polar = kPi / image.height,
                     omega = 2 * kPi / width * (std::cos(polar * y) - std::cos(polar * (y + 1)));
        disc.emplace_back(latLongDirection(x, y, width, image.height), value * omega);
      }
  double flux = 0;
  for (const auto& d : disc) flux += d.second;
  CHECK(flux == Approx(1000 * 2 * kPi * (1 - std::cos(kRadius))).epsilon(0.01));

  const EnvironmentLight light = prefilterEnvironment(image, 128).value();
  const int last = int(light.levels.size()) - 1;
  REQUIRE(last == 4);
  for (int k = 1; k <= last; ++k) {
    const CubeLevel& cube = light.levels[std::size_t(k)];
    const double p = f64::powerFromAlpha(f64::alphaFromRoughness(f64::environmentRoughness(k, last))),
                 total = lobeIntegral(p);
    const double peak = flux / total;
    double worst = 0, worstAnalytic = 0;
    for (int face = 0; face < 6; ++face)
      for (int y = 0; y < cube.size; ++y)
        for (int x = 0; x < cube.size; ++x) {
          const dvec3 r = texelDirection(cube.size, face, x, y);
          const double value = double(cube.texels[3 * ((std::size_t(face) * std::size_t(cube.size) + std::size_t(y)) * std::size_t(cube.size) + std::size_t(x))]);
          double truth = 0;
          for (const auto& [d, weight] : disc) truth += weight * lobeWeight(dot(d, r), p) / total;
          worst = std::fmax(worst, std::abs(value - truth) / peak);
          worstAnalytic = std::fmax(worstAnalytic, std::abs(value / peak - lobeWeight(dot(centre, r), p)));
        }
    WARN("level " << k << " (r " << f64::environmentRoughness(k, last) << ", " << cube.size << "² faces): off by "
                  << worst * 100 << " % of the peak from brute force, " << worstAnalytic * 100
                  << " % from an analytic light's lobe");
    CHECK(worst < 0.02);
    CHECK(worstAnalytic < (k == 1 ? 0.08 : 0.025));  // level 1 sees the disc's own width
  }
}
