// The sun's disc in the background: its light whatever the picture's size and wherever it stands, its edge, its place in the plan; a day's sky lights surfaces as its numbers say.
#include <fmt/format.h>

#include <iostream>

#include "render/scenes.h"

using namespace burnish;
using namespace burnish::test;

namespace {

/// Nothing but a disc before black.
Scene discScene(dvec3 toSun, float radius) {
  Scene s;
  s.environment.color = vec3(1e-6f);
  s.environment.sun = Environment::Sun{vec3(glm::normalize(toSun)), vec3(1000, 500, 250), radius, -2};
  return s;
}

/// Its light at the eye (lux for cd/m²): radiance times the pixels' solid angles.
dvec3 lightOf(const Picture& p, const View& view) {
  dvec3 sum(0);
  const double t = std::tan(double(view.fovY) / 2), side = 2 * t / p.image.height;
  for (int y = 0; y < p.image.height; ++y)
    for (int x = 0; x < p.image.width; ++x) {
      const Ray r = rayThrough(view, {p.image.width, p.image.height}, x + 0.5, y + 0.5);
      sum += p.at(x, y) * (side * side * std::pow(glm::dot(r.direction, -view.axes[2]), 3));
    }
  return sum;
}

double luminance(const dvec3& c) { return glm::dot(c, dvec3(0.2126, 0.7152, 0.0722)); }

}  // namespace

TEST_CASE("the sun's disc brings the same light at every size of the picture and wherever it stands") {
  Stage stage;
  for (const float radius : {0.004652f, 0.05f})
    for (const glm::ivec2 size : {glm::ivec2(640, 360), glm::ivec2(160, 90), glm::ivec2(48, 27)})
      for (int k = 0; k < 6; ++k) {
        // Somewhere in the inner half of the view, at another place in its pixel each time.
        const dvec3 to(0.11 * k - 0.27 + 0.0013 * k, 0.05 * ((k * 3) % 5) - 0.1 + 0.0007 * k, -1);
        const View view = lookAt({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.8f);
        const Scene scene = discScene(to, radius);
        const dvec3 seen = lightOf(stage.linear(scene, view, size), view), exact = dvec3(1000, 500, 250) * (kPi * std::sin(double(radius)) * std::sin(double(radius)));
        CAPTURE(radius, size.x, k);
        CHECK(seen.x == Approx(exact.x).epsilon(0.08));  // a disc of a pixel, cut by the pixels' square grid
        CHECK(seen.y / seen.x == Approx(0.5).epsilon(1e-3));
        if (double(radius) * size.y / 0.8 > 6) CHECK(seen.x == Approx(exact.x).epsilon(0.01));
      }
}

TEST_CASE("the disc is round, has a smooth edge, ends at its horizon and lies behind what is drawn") {
  Stage stage;
  const View view = lookAt({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.3f);
  constexpr glm::ivec2 kSize{121, 121};
  Scene scene = discScene({0, 0, -1}, 0.05f);
  const Picture whole = stage.linear(scene, view, kSize);
  const double pixel = 2 * std::tan(0.15) / 121;
  for (int y = 0; y < 121; ++y)
    for (int x = 0; x < 121; ++x) {
      const Ray r = rayThrough(view, kSize, x + 0.5, y + 0.5);
      const double angle = std::acos(std::min(-r.direction.z, 1.0));
      if (angle < 0.05 - 1.5 * pixel) REQUIRE(whole.at(x, y).x == Approx(1000));
      if (angle > 0.05 + 1.5 * pixel) REQUIRE(whole.at(x, y).x < 1e-3);
    }
  scene.environment.sun->horizon = 0;
  const Picture half = stage.linear(scene, view, kSize);
  CHECK(half.at(60, 55).x == Approx(1000));
  CHECK(half.at(60, 65).x < 1e-3);
  Material wall;
  wall.albedo = vec3(0);
  place(scene, quad({0.5f, 0, -4}, {0.5f, 0, 0}, {0, 5, 0}), wall);
  const Picture hidden = stage.linear(scene, view, kSize);
  CHECK(hidden.at(50, 55).x == Approx(1000));
  CHECK(hidden.at(70, 55).x < 1);
}

TEST_CASE("the disc is planned where a view sees it, and nowhere else") {
  Scene scene = discScene({0, 0.3, -1}, 0.004652f);
  const auto effect = [&](const View& view, const PlanOptions& options = {.size = {64, 64}}) {
    const FramePlan plan = makePlan(scene, {&view, 1}, {}, Capabilities{}, options);
    bool defined = false;
    for (const ProgramPlan& p : plan.programs) defined |= std::find(p.defines.begin(), p.defines.end(), "SUN 1") != p.defines.end();
    const EffectPlan& e = *std::find_if(plan.effects.begin(), plan.effects.end(), [](const EffectPlan& x) { return x.name == "sun_disc"; });
    CHECK(defined == e.on);
    return e;
  };
  const View to = lookAt({0, 0, 0}, {0, 0.3, -1}), away = lookAt({0, 0, 0}, {0, 0.3, 1}), beside = lookAt({0, 0, 0}, {1, 0.3, -1}, {0, 1, 0}, 0.5f);
  CHECK(effect(to).on);
  CHECK(effect(to).passes == std::vector<std::string>{"background"});
  CHECK(!effect(away).on);
  CHECK(effect(away).reason == "out of view: the environment's sun");
  CHECK(!effect(beside).on);
  PlanOptions whole{.size = {64, 64}};
  whole.wholeScene = true;
  CHECK(effect(away, whole).on);
  View parallel = to;
  parallel.orthographic = true;
  CHECK(!effect(parallel).on);
  scene.environment.background = false;
  CHECK(effect(to).reason == "the environment is not shown as background");
  scene.environment.sun.reset();
  CHECK(effect(to).reason == "an environment with a sun would call for it");
}

TEST_CASE("a grey floor under a clear sky shows what sun and sky bring, and the sun once") {
  Stage stage;
  Scene scene;
  Report report;
  SunSky sky;
  sky.toSun = {0, 1, 0.6f};
  setSky(scene, sky, report);
  CHECK(report.warnings().empty());
  Material floor;
  floor.albedo = vec3(0.5f);
  floor.roughness = 1;
  place(scene, quad({0, 0, 0}, {0, 0, 50}, {50, 0, 0}), floor);
  Quality lambert;
  lambert.diffuse = Diffuse::Lambert;
  const View down = lookAt({0, 10, 0}, {0, 0, -0.01}, {0, 0, -1}, 0.3f);
  const Picture p = stage.linear(scene, down, {32, 32}, lambert);
  // Horizontal illuminance: of the sun, E sin h; of the sky, what its picture sums to (the harmonics of three bands keep that within 3 %).
  const Light& sun = *scene.lights.get(scene.lights.at(0));
  const double sine = 1 / std::sqrt(1 + 0.36);
  dvec3 lux = dvec3(sun.color) * double(sun.intensity) * sine;
  const Image& map = scene.environment.map;
  for (int y = 0; y < map.height / 2; ++y)
    for (int x = 0; x < map.width; ++x) {
      const double t = kPi * (y + 0.5) / map.height;
      const float* f = map.f32() + (y * map.width + x) * 3;
      lux += dvec3(f[0], f[1], f[2]) * (double(scene.environment.scale) * std::cos(t) * std::sin(t) * (kPi / map.height) * (2 * kPi / map.width));
    }
  const dvec3 diffuse = lux * (0.5 / kPi);
  std::cout << fmt::format("  a grey floor under a clear sky: {:.0f} cd/m2, {:.0f} expected of its diffuse part\n", luminance(p.at(16, 16)), luminance(diffuse));
  // A dielectric at roughness 1 adds some four per cent of reflection.
  for (int c = 0; c < 3; ++c) {
    CHECK(p.at(16, 16)[c] > diffuse[c] * 0.98);
    CHECK(p.at(16, 16)[c] < diffuse[c] * 1.12);
  }
  // A smooth mirror that looks at the sun's place shows the light's highlight, and no disc of the picture beside it: the map holds none.
  float brightest = 0;
  for (std::size_t i = 0; i < map.pixelCount() * 3; ++i) brightest = std::max(brightest, map.f32()[i] * scene.environment.scale);
  CHECK(double(brightest) < 1e-3 * luminance(dvec3(scene.environment.sun->radiance)));
}
