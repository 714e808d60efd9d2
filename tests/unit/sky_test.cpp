// The clear sky against published levels: illuminances, luminances, colours, twilight; its numbers at the ends; what setSky makes of a scene.
#include "prefilter/sky.h"

#include <burnish/scene.h>
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <limits>

#include "prefilter/atmosphere.h"

using namespace burnish;
using namespace burnish::prefilter;
using glm::dvec3;

namespace {

constexpr double kPi = 3.14159265358979323846;
double luminance(const dvec3& c) { return glm::dot(c, dvec3(0.2126, 0.7152, 0.0722)); }

SkyModel sunAt(double degrees, double turbidity = 2.5) {
  const double e = degrees * kPi / 180;
  SkyModel m;
  m.toSun = glm::vec3(0, float(std::sin(e)), float(-std::cos(e)));
  m.turbidity = turbidity;
  return m;
}
/// cd/m² at an elevation and an azimuth from the sun (which stands in the centre column), degrees.
dvec3 at(const SkyPicture& p, double elevation, double azimuth) {
  const int x = int((azimuth / 360 + 0.5) * p.map.width) % p.map.width, y = std::min(int((90 - elevation) / 180 * p.map.height), p.map.height - 1);
  const float* f = p.map.f32() + (y * p.map.width + x) * 3;
  return {f[0], f[1], f[2]};
}
double total(const SkyPicture& p, double degrees) { return luminance(p.skyIlluminance) + luminance(p.sunIlluminance) * std::max(std::sin(degrees * kPi / 180), 0.0); }

}  // namespace

TEST_CASE("sunlight above the air: the published solar illuminance", "[sky]") {
  // 127.5 klx (IES 1984, in use since) to 133 klx (ASTM E490); a black body lacks the sun's dip in the ultraviolet and its excess in the green.
  const double lux = luminance(rgbOf(sunlightAbove()));
  CHECK(lux > 123e3);
  CHECK(lux < 135e3);
  // A flat spectrum is near white: equal energy, x = y = 1/3.
  Spectrum flat;
  flat.fill(1);
  const dvec3 white = rgbOf(flat);
  CHECK(white.x / white.y == Approx(1.205 / 0.948).epsilon(0.03));
  CHECK(white.z / white.y == Approx(0.909 / 0.948).epsilon(0.03));
}

TEST_CASE("a clear day's light on the ground is what handbooks give", "[sky]") {
  struct Row {
    double elevation, least, most;  ///< total horizontal illuminance, lux
  };
  // Full daylight 100 to 120 klx with the sun high, some 100 klx at 60°, 50 klx at 30°, 10 klx at 10° (IES clear sky: direct 127.5 klx e^(-0.21/sin h) plus 0.8 + 15.5 sin^0.5 h klx:
  // 100.6, 54.5 and 13.5 klx); 400 to 1000 lx at sunset, 3.4 lx at the end of civil twilight (Schlyter, "Radiometry and photometry in astronomy": 2 to 6 by the haze).
  for (const Row& r : {Row{90, 100e3, 130e3}, Row{60, 90e3, 111e3}, Row{30, 44e3, 60e3}, Row{10, 9e3, 16e3}, Row{0, 400, 1000}, Row{-6, 2, 8}}) {
    const SkyPicture p = skyPicture(sunAt(r.elevation), 256);
    const double lux = total(p, r.elevation);
    std::cout << fmt::format("  sun at {:3g} deg: {:9.3g} lx on level ground, {:9.3g} lx from the sky, zenith {:8.3g} cd/m2\n", r.elevation, lux, luminance(p.skyIlluminance), luminance(at(p, 89.5, 0)));
    CHECK(lux > r.least);
    CHECK(lux < r.most);
  }
  // Clear zeniths have 2 to 8 kcd/m² with the sun at 60°; the sun's mean luminance from the ground is 1.6e9 cd/m² (IES), its disc 0.53°.
  const SkyPicture noon = skyPicture(sunAt(60), 256);
  CHECK(luminance(at(noon, 89.5, 0)) > 2e3);
  CHECK(luminance(at(noon, 89.5, 0)) < 8e3);
  CHECK(luminance(noon.sunRadiance) > 1.1e9);
  CHECK(luminance(noon.sunRadiance) < 1.7e9);
}

TEST_CASE("the picture's light is the light that it says", "[sky]") {
  for (const double e : {60.0, 20.0}) {
    const SkyPicture p = skyPicture(sunAt(e), 512);
    dvec3 sum(0);
    for (int y = 0; y < p.map.height / 2; ++y)
      for (int x = 0; x < p.map.width; ++x) {
        const double t = kPi * (y + 0.5) / p.map.height;
        const float* f = p.map.f32() + (y * p.map.width + x) * 3;
        sum += dvec3(f[0], f[1], f[2]) * (std::cos(t) * std::sin(t) * (kPi / p.map.height) * (2 * kPi / p.map.width));
      }
    for (int c = 0; c < 3; ++c) CHECK(sum[c] == Approx(p.skyIlluminance[c]).epsilon(0.01));
  }
}

TEST_CASE("the sky's colours: blue away from the sun, white haze, a red sun and horizon at sunset, symmetric", "[sky]") {
  const SkyPicture noon = skyPicture(sunAt(60), 256), low = skyPicture(sunAt(3), 256), hazy = skyPicture(sunAt(60, 8), 256);
  const auto blueness = [](const dvec3& c) { return c.z / std::max(c.x, 1e-9); };
  CHECK(blueness(at(noon, 45, 180)) > 1.5);
  CHECK(blueness(at(hazy, 45, 180)) < blueness(at(noon, 45, 180)));
  CHECK(blueness(at(noon, 3, 180)) < blueness(at(noon, 60, 180)));       // whiter at the horizon
  CHECK(luminance(at(noon, 3, 180)) > luminance(at(noon, 60, 180)));     // and brighter
  CHECK(blueness(low.sunIlluminance) < 0.1);                             // a red sun
  CHECK(blueness(at(low, 1, 0)) < 0.2);                                  // in a red glow
  CHECK(luminance(at(low, 3, 0)) > 5 * luminance(at(low, 3, 180)));
  CHECK(blueness(at(low, 80, 0)) > 1.5);                                 // under a blue zenith: ozone
  for (const double az : {20.0, 90.0, 150.0})
    for (int c = 0; c < 3; ++c) CHECK(at(noon, 30, az)[c] == Approx(at(noon, 30, -az)[c]).epsilon(0.02));
}

TEST_CASE("what is scattered never passes what comes in", "[sky]") {
  // Over a black ground less light leaves the sky on the ground, per unit above, than 1 in any band; over a white one no more than 1/(1 - what the sky sends back).
  for (const double turbidity : {1.0, 3.0, 10.0})
    for (const double sine : {1.0, 0.5, 0.1}) {
      const Atmosphere air(turbidity, 0);
      const Spectrum direct = air.sunThrough(0, sine);
      Spectrum sum{};
      for (int j = 0; j < 24; ++j)
        for (int i = 0; i < 24; ++i) {
          const double e = 0.5 * kPi * (j + 0.5) / 24, up = std::sin(e), c = up * sine + std::cos(e) * std::sqrt(1 - sine * sine) * std::cos(kPi * (i + 0.5) / 24);
          const RayLight ray = air.alongRay(1, up, c, sine);
          // The mean of haze's narrow phase function over these directions would want many more: 1/4 pi stands in for both, which keeps the energy over the sphere.
          for (std::size_t k = 0; k < kBands; ++k)
            sum[k] += ((ray.air[k] + ray.haze[k]) / (4 * kPi) + ray.multiple[k]) * up * std::cos(e) * (0.5 * kPi / 24) * (2 * kPi / 24);
        }
      for (std::size_t k = 0; k < kBands; ++k) {
        CHECK(sum[k] + direct[k] * sine < sine * 1.02);
        CHECK(sum[k] > 0);
      }
    }
}

TEST_CASE("skies at the ends of their ranges are finite and never jump", "[sky]") {
  for (const double turbidity : {1.0, 10.0})
    for (const double degrees : {90.0, 0.3, 0.0, -0.3, -18.0, -60.0, -90.0})
      for (const double altitude : {1.0, 3000.0, 50000.0}) {
        SkyModel m = sunAt(degrees, turbidity);
        m.altitude = altitude;
        const SkyPicture p = skyPicture(m, 64);
        CAPTURE(turbidity, degrees, altitude);
        for (std::size_t i = 0; i < p.map.pixelCount() * 3; ++i) {
          REQUIRE(std::isfinite(p.map.f32()[i]));
          REQUIRE(p.map.f32()[i] >= 0);
        }
        REQUIRE(std::isfinite(luminance(p.sunIlluminance) + luminance(p.sunRadiance) + luminance(p.skyIlluminance)));
        if (degrees < -10) CHECK(luminance(p.sunIlluminance) == 0);
      }
  // The sun's light fades while it sets: no step larger than what a twentieth of its disc brings.
  double before = luminance(skyPicture(sunAt(0.4), 16).sunIlluminance);
  const double whole = before;
  for (double e = 0.38; e > -0.5; e -= 0.02) {
    const double now = luminance(skyPicture(sunAt(e), 16).sunIlluminance);
    CHECK(now <= before);
    CHECK(before - now < 0.15 * whole);
    before = now;
  }
  CHECK(before == 0);
}

TEST_CASE("setSky gives a scene its environment and its sun, and says what it holds", "[sky]") {
  Scene scene;
  Report report;
  SunSky sky;
  sky.toSun = {3, 4, 0};
  const Id<Light> sun = setSky(scene, sky, report);
  CHECK(report.warnings().empty());
  REQUIRE(scene.lights.has(sun));
  const Light& light = *scene.lights.get(sun);
  CHECK(light.kind == LightKind::Directional);
  CHECK(light.intensity > 8e4f);
  const glm::dmat4 world = scene.world(light.node);
  CHECK(glm::length(dvec3(world[2]) - dvec3(0.6, 0.8, 0)) < 1e-6);
  REQUIRE(scene.environment.sun);
  CHECK(glm::length(dvec3(scene.environment.sun->toSun) - dvec3(0.6, 0.8, 0)) < 1e-6);
  // Disc and light are the same: radiance times solid angle is the illuminance.
  const double omega = discSolidAngle(double(scene.environment.sun->radius));
  CHECK(luminance(dvec3(scene.environment.sun->radiance)) * omega == Approx(luminance(dvec3(light.color)) * double(light.intensity)).epsilon(1e-4));
  float largest = 0;
  for (std::size_t i = 0; i < scene.environment.map.pixelCount() * 3; ++i) largest = std::max(largest, scene.environment.map.f32()[i]);
  CHECK(largest <= 8192);
  CHECK(largest > 4000);
  // The same light again, by night: it stays and is off; the disc goes.
  const std::uint64_t revision = scene.environment.revision;
  sky.toSun = {0, -1, 0.2f};
  CHECK(setSky(scene, sky, report, sun) == sun);
  CHECK(scene.lights.size() == 1);
  CHECK(!scene.lights.get(sun)->enabled);
  CHECK(!scene.environment.sun);
  CHECK(scene.environment.revision > revision);
  sky.turbidity = 40;
  sky.altitude = std::numeric_limits<float>::quiet_NaN();
  sky.toSun = glm::vec3(0);
  setSky(scene, sky, report, sun);
  REQUIRE(report.warnings().size() == 3);
  CHECK(report.warnings()[0].message().find("zenith") != std::string::npos);
  CHECK(report.warnings()[1].message().find("turbidity is 40: 10 is taken") != std::string::npos);
  CHECK(report.warnings()[2].message().find("altitude") != std::string::npos);
}
