// Light through glass, by Fresnel's equations and the series of what goes to and fro.
#include <catch2/catch.hpp>

#include "light_scenes.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
using glm::vec3;

namespace {

/// Unpolarized reflectance of a face, from one index to another; 1 beyond the critical angle.
double fresnel(double cosine, double from, double to) {
  const double sine = std::sqrt(1 - cosine * cosine) * from / to;
  if (sine >= 1) return 1;
  const double c = std::sqrt(1 - sine * sine), s = (from * cosine - to * c) / (from * cosine + to * c), p = (to * cosine - from * c) / (to * cosine + from * c);
  return 0.5 * (s * s + p * p);
}

Material glass(float thickness = 0) { return {.name = "glass", .albedo = vec3(1), .substance = 1.0f / 3, .roughness = 0, .transmission = 1, .thickness = thickness, .ior = 1.5f}; }

/// Shows 1 cd/m² and reflects nothing.
Material shining() { return {.name = "shining", .albedo = vec3(1), .twoSided = true, .unlit = true}; }
/// Far below, or far above.
void addEmitter(Setting& s, bool above) { s.add(rectangle({0, above ? 4.0f : -4.0f, 0}, {60, 0, 0}, {0, 0, 60}), shining()); }

pathtrace::PathRay downAt(double cosine) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return rayFrom({-sine, cosine, 0}, {0, 0, 0});
}

/// Directional albedo of the specular lobe, with Schlick's Fresnel.
double lobeReflects(const shading::Rungs& rungs, double cosine, double alpha, double substance) {
  const glm::dvec2 e = reference::lobeAlbedo(rungs, cosine, alpha);
  return shading::f64::substanceDielectricF0(substance) * e.x + e.y;
}

}  // namespace

TEST_CASE("light: a thin pane lets through and reflects what its two faces do between them") {
  for (const bool above : {false, true})
    for (const double cosine : {0.15, 0.4, 0.95}) {
      Setting s;
      Material m = glass();
      m.albedo = {1, 0.7f, 0.3f};
      m.twoSided = true;
      s.add(rectangle(vec3(0), {2, 0, 0}, {0, 0, -2}), m);
      addEmitter(s, above);
      const pathtrace::World world = s.world(Quality{});
      const Seen seen = see(world, downAt(cosine), 32768);
      const double f = fresnel(cosine, 1, 1.5);
      for (std::size_t c = 0; c < 3; ++c) {
        const double a = double(m.albedo[int(c)]), exact = above ? f + (1 - f) * (1 - f) * f * a * a / (1 - f * f * a * a) : (1 - f) * (1 - f) * a / (1 - f * f * a * a);
        CAPTURE(above, cosine, c);
        checkSeen(seen.light[c], exact, 2e-3);
      }
    }
}

TEST_CASE("light: a slab of glass absorbs and reflects inside as the series says, whether a body or a sheet") {
  for (const bool sheet : {false, true})
    for (const bool above : {false, true})
      for (const double cosine : {0.3, 0.8}) {
        Setting s;
        Material m = glass(0.2f);
        m.attenuationColor = {0.8f, 0.4f, 0.9f}, m.attenuationDistance = 0.3f;
        if (sheet) s.add(rectangle(vec3(0), {30, 0, 0}, {0, 0, -30}), m);
        else s.add(box({-30, -0.2f, -30}, {30, 0, 30}, false), m);
        addEmitter(s, above);
        const pathtrace::World world = s.world(Quality{});
        const Seen seen = see(world, downAt(cosine), 131072);
        const double f = fresnel(cosine, 1, 1.5), inside = std::sqrt(1 - (1 - cosine * cosine) / 2.25);
        for (std::size_t c = 0; c < 3; ++c) {
          const double a = std::pow(double(m.attenuationColor[int(c)]), 0.2 / inside / 0.3);
          const double exact = above ? f + (1 - f) * (1 - f) * f * a * a / (1 - f * f * a * a) : (1 - f) * (1 - f) * a / (1 - f * f * a * a);
          CAPTURE(sheet, above, cosine, c);
          checkSeen(seen.light[c], exact, 3e-3);
        }
      }
}

TEST_CASE("light: clear glass in even surroundings is not to be seen, frosted glass loses a little") {
  for (const float roughness : {0.0f, 0.4f})
    for (const int shape : {0, 1, 2, 3}) {
      Setting s;
      s.scene.environment.color = vec3(1);
      Material m = glass(shape == 0 ? 0.0f : 1.0f);
      m.roughness = roughness;
      if (shape < 2) s.add(rectangle(vec3(0), {30, 0, 0}, {0, 0, -30}), m);
      else if (shape == 2) s.add(box({-0.5, -0.6f, -0.5}, {0.5f, 0, 0.5f}, false), m);
      else s.add(ball({0.1f, -0.5f, 0.05f}, 0.5f, 32), m);
      const pathtrace::World world = s.world(Quality{});
      for (const double cosine : {0.3, 0.9}) {
        const Seen seen = see(world, downAt(cosine), 8192);
        CAPTURE(roughness, shape, cosine, seen.error());
        if (roughness == 0) checkSeen(seen.light[0], 1, 4e-3);
        CHECK(seen.value() < 1.002 + 3 * seen.error());
        CHECK(seen.value() > 0.93);
      }
    }
}

TEST_CASE("light: a ball of glass bends light as Snell says") {
  // A ray that misses the middle by b leaves turned by 2 (i - t), sin i = b, sin t = b/n: a small emitter stands where it goes.
  const double b = 0.5, i = std::asin(b), t = std::asin(b / 1.5), turn = 2 * (i - t);
  Setting s;
  s.add(ball(vec3(0), 1, 256), glass(2));
  const dvec3 direction(std::cos(turn), -std::sin(turn), 0);
  // It meets the ball at the angle pi - i from the axis and leaves pi - 2 t farther on.
  const double exitAngle = 2 * t - i;
  const dvec3 exit(std::cos(exitAngle), std::sin(exitAngle), 0), place = exit + direction * 3.0;
  const vec3 u(float(-direction.y * 0.1), float(direction.x * 0.1), 0), v(0, 0, 0.1f);
  s.add(rectangle(vec3(place), u, v), shining());
  const pathtrace::World world = s.world(Quality{});
  const double f = fresnel(std::cos(i), 1, 1.5);
  checkSeen(see(world, rayFrom({-5, b, 0.01}, {0, b, 0.01}), 8192).light[0], (1 - f) * (1 - f), 2e-3);
}

TEST_CASE("light: a blended surface in a white room") {
  Quality q;
  q.diffuse = Diffuse::Coupled;
  for (const float pigment : {0.0f, 0.4f, 1.0f})
    for (const float cover : {0.3f, 1.0f}) {
      Setting s;
      s.scene.environment.color = vec3(1);
      Mesh plane = rectangle(vec3(0), {2, 0, 0}, {0, 0, -2});
      plane.colors.assign(4, {1, 1, 1, cover});
      s.add(plane, {.name = "film", .albedo = vec3(0.6f), .substance = 0.2f, .roughness = 0.4f, .opacity = pigment, .blend = true});
      const pathtrace::World world = s.world(q);
      const double cosine = 0.35, left = 1 - lobeReflects(world.rungs(), cosine, 0.16, 0.2), c = double(cover), a = double(pigment);
      const double exact = c * (1 - left + left * (a * 0.6 + 1 - a)) + 1 - c;
      CAPTURE(pigment, cover);
      checkSeen(see(world, downAt(cosine), 8192).light[0], exact, 2e-3);
    }
}
