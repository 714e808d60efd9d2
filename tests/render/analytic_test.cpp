// Scenes whose radiance is known in closed form, through the whole pipeline, against double precision.
// Bounds follow from the formats: albedo's 8-bit square root errs by half a step of 1/255 (0.6 % at albedo 0.5), the 12-bit octahedral normal by 5e-4 rad,
// the roughness code by 1.6 % in alpha (3.2 % in a lobe's peak).
#include <fmt/format.h>

#include <iostream>

#include "render/scenes.h"
#include "shading/test_rungs.h"

using namespace burnish;
using namespace burnish::test;
namespace f64 = burnish::shading::f64;

namespace {

const shading::Rungs kRungs = defaultRungs();

Material plain(vec3 albedo, float roughness, float substance = 1.0f / 3) {
  Material m;
  m.albedo = albedo;
  m.roughness = roughness;
  m.substance = substance;
  return m;
}

double relative(dvec3 got, dvec3 wanted, double absolute) {
  double worst = 0;
  for (int c = 0; c < 3; ++c) worst = std::max(worst, std::max(std::abs(got[c] - wanted[c]) - absolute, 0.0) / std::max(std::abs(wanted[c]), 1e-12));
  return worst;
}

/// Per-pixel error of a unit sphere at the origin. Pixels where n·v < 0.2 are silhouette: the tessellation shows there.
template <class Oracle>
Errors compareSphere(const Picture& p, const View& view, double bound, double absolute, Oracle&& oracle) {
  Errors e;
  for (int y = 0; y < p.image.height; ++y)
    for (int x = 0; x < p.image.width; ++x) {
      const Ray r = rayThrough(view, {p.image.width, p.image.height}, x + 0.5, y + 0.5);
      const double b = glm::dot(r.origin, r.direction), c = glm::dot(r.origin, r.origin) - 1, d = b * b - c;
      if (d <= 0) continue;
      const dvec3 n = r.origin + r.direction * (-b - std::sqrt(d)), v = -r.direction;
      if (glm::dot(n, v) < 0.2) continue;
      e.add(relative(p.at(x, y), oracle(n, v), absolute), bound);
    }
  return e;
}

void say(std::string_view what, const Errors& e, double bound) {
  std::cout << fmt::format("  {}: {:.3f} % of {} pixels within {:.2f} %, largest {:.3f} %\n", what, 100 * e.share(), e.count, 100 * bound, 100 * e.largest);
}

Picture emissivePicture(Stage& stage, vec3 emission, const Quality& quality, Output output) {
  Scene scene;
  Material m;
  m.emission = emission;
  place(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), m);
  const View view = lookAt({0, 0, 2}, {0, 0, 0});
  RenderRequest request;
  request.output = output;
  return stage.draw(scene, {&view, 1}, {4, 4}, quality, request);
}

}  // namespace

TEST_CASE("sphere under a directional light: Lambert and lobe, every pixel") {
  Stage stage;
  const View view = lookAt({0, 0.5, 4}, {0, 0, 0}, {0, 1, 0}, 0.6f);
  struct Case {
    const char* name;
    Material material;
    double bound, largest, absolute;
  };
  const Case cases[] = {{"rough plastic", plain({0.5f, 0.3f, 0.1f}, 1), 0.015, 0.03, 0.2},
                        {"plastic r 0.5", plain({0.5f, 0.3f, 0.1f}, 0.5f), 0.015, 0.03, 0.5},
                        {"gold r 0.4", plain({1.0f, 0.77f, 0.34f}, 0.4f, 1), 0.03, 0.05, 15}};
  const dvec3 toLight = glm::normalize(dvec3(0.6, 0.7, 0.8));
  for (const Case& k : cases) {
    INFO(k.name);
    Scene scene;
    place(scene, sphere(1, 192, 384), k.material);
    addLight(scene, light(LightKind::Directional, {1, 0.9f, 0.8f}, 1000), {0, 0, 0}, -toLight);
    const Picture p = stage.linear(scene, view, {240, 240});
    const double alpha = double(k.material.roughness) * k.material.roughness;
    // Where n·l grazes, the normal's step is all there is; and a code's 1.6 % in alpha is far more in a lobe's tail: there the bound is half a percent of the peak.
    const Errors e = compareSphere(p, view, k.bound, k.absolute, [&](dvec3 n, dvec3 v) {
      return f64::shadeDirection(f64::makeSurface(n, v, dvec3(k.material.albedo), k.material.substance, alpha), toLight, glm::dvec2(0), kRungs) * dvec3(1000.0, 900.0, 800.0);
    });
    say(k.name, e, k.bound);
    CHECK(e.count > 10000);
    CHECK(e.share() > 0.995);
    CHECK(e.largest < k.largest);
  }
}

TEST_CASE("the lobe is finite where the half vector lies in the surface") {
  for (float p : {0.0f, 1.0f, 100.0f, 1.25e7f}) CHECK(std::isfinite(burnish::shading::f32::lobeStable(1.0f, p)));
  const vec3 n(0, 1, 0), v = glm::normalize(vec3(1, 0.5f, 0)), l = glm::normalize(vec3(1, -0.5f, 0));
  namespace f32 = burnish::shading::f32;
  CHECK(f32::shadeDirection(f32::makeSurface(n, v, vec3(0.5f), 1, 1), l, glm::vec2(0), kRungs) == vec3(0));
}

TEST_CASE("the middle of a rough sphere lit from the eye, by hand") {
  // n = l = v, r = 1: alpha 1, power 0, D = 1/pi, V = 1/4, F = F0: L = E (albedo (1 - F0) + F0/4) / pi with the diffuse rung lambert-fresnel.
  Stage stage;
  Scene scene;
  place(scene, sphere(1, 64, 128), plain(vec3(0.25f), 1, 1.0f / 3));
  addLight(scene, light(LightKind::Directional, vec3(1), 100), {0, 0, 0}, {0, 0, -1});
  Quality quality;
  quality.diffuse = Diffuse::LambertFresnel;
  const Picture p = stage.linear(scene, lookAt({0, 0, 4}, {0, 0, 0}), {65, 65}, quality);
  CHECK(p.at(32, 32).x == Approx(100 * (0.25 * 0.96 + 0.01) / kPi).epsilon(0.01));
}

TEST_CASE("point light on a plane: inverse square, with and without a range") {
  Stage stage;
  const View view = lookAt({0, 4, 3}, {0, 0, 0});
  const dvec3 at(0.3, 1.0, -0.2);
  for (float range : {0.0f, 3.0f}) {
    INFO("range " << range);
    Scene scene;
    place(scene, quad({0, 0, 0}, {0, 0, 8}, {8, 0, 0}), plain(vec3(0.5f), 1));
    addLight(scene, light(LightKind::Point, {1, 0.5f, 0.25f}, 200, range), at);
    Quality quality;
    quality.lightThreshold = 0.1f;
    const Picture p = stage.linear(scene, view, {200, 160}, quality);
    Errors e;
    std::size_t dark = 0;
    for (int y = 0; y < 160; ++y)
      for (int x = 0; x < 200; ++x) {
        const Ray r = rayThrough(view, {200, 160}, x + 0.5, y + 0.5);
        const dvec3 hit = r.origin + r.direction * (-r.origin.y / r.direction.y);
        if (r.direction.y >= 0 || std::abs(hit.x) > 7.9 || std::abs(hit.z) > 7.9) continue;
        const dvec3 l = at - hit;
        const double d2 = glm::dot(l, l);
        // Without a range: minus the stated bias, threshold over peak. With one: Karis' window.
        const double window = range > 0 ? std::pow(std::max(0.0, 1 - std::pow(std::sqrt(d2) / range, 4)), 2) : 1;
        const double irradiance = std::max(window / d2 - (range > 0 ? 0 : 0.1 / 200), 0.0);
        const dvec3 wanted = f64::shadeDirection(f64::makeSurface({0, 1, 0}, -r.direction, dvec3(0.5), 1.0 / 3, 1), l / std::sqrt(d2), glm::dvec2(0), kRungs) * dvec3(200.0, 100.0, 50.0) * irradiance;
        if (irradiance == 0) {
          ++dark;
          CHECK(p.at(x, y) == dvec3(0));
        } else {
          e.add(relative(p.at(x, y), wanted, 2e-4), 0.015);
        }
      }
    say(range > 0 ? "point light, range 3 m" : "point light, no range", e, 0.015);
    CHECK(e.count > 8000);
    CHECK(e.share() > 0.995);
    CHECK(e.largest < 0.03);
    CHECK((dark > 1000) == (range > 0));
  }
  bool told = false;
  for (const Warning& w : stage.renderer->report().warnings()) told |= w.what.find("no range") != std::string::npos;
  CHECK(told);  // the loss is reported
}

TEST_CASE("spot light: the cone's edge and its falloff") {
  Stage stage;
  Scene scene;
  place(scene, quad({0, 0, 0}, {0, 0, 8}, {8, 0, 0}), plain(vec3(0.5f), 1));
  Light spot = light(LightKind::Spot, vec3(1), 500, 50);
  spot.innerCone = 0.3f;
  spot.outerCone = 0.5f;
  addLight(scene, spot, {0, 3, 0}, {0, -1, 0});
  View view = lookAt({0, 10, 0}, {0, 0, 0}, {0, 0, -1});
  view.orthographic = true;
  view.height = 4;
  view.far = 20;
  const int n = 400;  // 10 mm a pixel
  const Picture p = stage.linear(scene, view, {n, n});
  double edge = 0, worst = 0;
  for (int x = n / 2; x < n; ++x) {
    const double r = (x + 0.5 - n / 2.0) * 0.01, z = 0.005, d2 = r * r + z * z + 9, d = std::sqrt(d2);
    const double got = p.at(x, n / 2).x, t = std::clamp((3 / d - std::cos(0.5)) / (std::cos(0.3) - std::cos(0.5)), 0.0, 1.0);
    if (got > 0) edge = r;
    const double window = std::pow(1 - d2 * d2 / std::pow(50.0, 4), 2);
    const double wanted = f64::shadeDirection(f64::makeSurface({0, 1, 0}, {0, 1, 0}, dvec3(0.5), 1.0 / 3, 1), dvec3(-r, 3, z) / d, glm::dvec2(0), kRungs).x * 500 * t * t * window / d2;
    worst = std::max(worst, std::abs(got - wanted));
  }
  std::cout << fmt::format("  spot edge at {:.3f} m, wanted {:.3f} m; largest error {:.4f} of 8.9 cd/m2\n", edge, 3 * std::tan(0.5), worst);
  CHECK(std::abs(edge - 3 * std::tan(0.5)) <= 0.015);
  CHECK(worst < 0.12);
}

TEST_CASE("emission and unlit surfaces are exact") {
  Stage stage;
  CHECK(emissivePicture(stage, {3, 0.5f, 0.1875f}, {}, Output::Linear).at(2, 2) == dvec3(3, 0.5, 0.1875));
  Scene scene;
  Material m = plain({0.5f, 0.25f, 1}, 1);
  m.unlit = true;
  place(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), m);
  CHECK(stage.linear(scene, lookAt({0, 0, 2}, {0, 0, 0}), {4, 4}).at(2, 2) == dvec3(0.5, 0.25, 1));
}

TEST_CASE("unlit surfaces take no light") {
  Stage stage;
  Scene scene;
  Material m = plain({0.5f, 0.25f, 1}, 0.5f);
  m.unlit = true;
  place(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), m);
  addLight(scene, light(LightKind::Directional, vec3(1), 100), {0, 0, 0}, {0, 0, -1});
  addLight(scene, light(LightKind::Point, vec3(1), 100, 10), {0, 0, 1});
  scene.environment.color = vec3(5);
  const dvec3 got = stage.linear(scene, lookAt({0, 0, 2}, {0, 0, 0}), {4, 4}).at(2, 2);
  CHECK(glm::length(got - dvec3(0.5, 0.25, 1)) < 1e-3);
}

TEST_CASE("exposure and tone maps: sRGB(tonemap(L / (1.2 2^EV)))") {
  Stage stage;
  const vec3 radiances[] = {{0.02f, 0.01f, 0.03f}, {1, 1, 1}, {12, 5, 2}, {40, 40, 39}, {300, 20, 5}, {5000, 6000, 7000}};
  double worst = 0;
  for (ToneMap map : {ToneMap::None, ToneMap::Neutral, ToneMap::AgX, ToneMap::Aces})
    for (float ev : {0.0f, 4.0f})
      for (vec3 radiance : radiances) {
        INFO("tone map " << int(map) << ", EV " << ev << ", radiance " << radiance.x);
        Quality quality;
        quality.toneMap = map;
        quality.exposureEv = ev;
        const dvec3 c = dvec3(radiance) / (1.2 * std::exp2(double(ev)));
        dvec3 t = map == ToneMap::None ? f64::tonemapNone(c) : map == ToneMap::Neutral ? f64::tonemapNeutral(c) : map == ToneMap::AgX ? f64::tonemapAgx(c) : f64::tonemapAces(c);
        const dvec3 got = emissivePicture(stage, radiance, quality, Output::Display).at(2, 2);
        for (int i = 0; i < 3; ++i) {
          const double error = std::abs(got[i] - f64::srgbFromLinear(t[i]));
          worst = std::max(worst, error);
          CHECK(error <= 1.0 / 255);
        }
      }
  std::cout << fmt::format("  display value: largest error {:.2f}/255\n", worst * 255);
}

TEST_CASE("linear output is untouched by exposure and tone map") {
  Stage stage;
  Scene scene;
  place(scene, sphere(1, 24, 48), plain({0.5f, 0.3f, 0.1f}, 0.4f));
  addLight(scene, light(LightKind::Directional, vec3(1), 50000), {0, 0, 0}, {-1, -1, -1});
  const View view = lookAt({0, 0, 4}, {0, 0, 0});
  Quality a, b;
  a.exposureEv = -3.0f;
  b.exposureEv = 15.0f;
  b.toneMap = ToneMap::AgX;
  const Picture pa = stage.linear(scene, view, {64, 64}, a), pb = stage.linear(scene, view, {64, 64}, b), pc = stage.linear(scene, view, {64, 64});
  CHECK(same(pa, pb));
  CHECK(same(pa, pc));
  CHECK(pa.at(40, 24).x > 100);
}

TEST_CASE("constant surroundings: directional albedo of the rungs") {
  Stage stage;
  const View view = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.6f);
  for (const Material& m : {plain(vec3(1), 0.3f, 1), plain(vec3(0.5f), 0.6f), plain(vec3(1), 1)}) {
    Scene scene;
    place(scene, sphere(1, 96, 192), m);
    scene.environment.color = vec3(10);
    const Picture p = stage.linear(scene, view, {120, 120});
    Errors e;
    for (int y = 20; y < 100; y += 4)
      for (int x = 20; x < 100; x += 4) {
        const Ray r = rayThrough(view, {120, 120}, x + 0.5, y + 0.5);
        const double b = glm::dot(r.origin, r.direction), d = b * b - glm::dot(r.origin, r.origin) + 1;
        if (d <= 0) continue;
        const double nov = -glm::dot(r.origin + r.direction * (-b - std::sqrt(d)), r.direction);
        if (nov < 0.2) continue;
        const auto wanted = reference::directionalAlbedo({.n = {0, 0, 1}, .v = reference::directionAt(nov), .albedo = dvec3(m.albedo), .substance = m.substance, .alpha = double(m.roughness) * m.roughness}, kRungs);
        e.add(std::abs(p.at(x, y).x / (10 * (wanted.specular.x + wanted.diffuse.x)) - 1), 0.015);
      }
    say(fmt::format("surroundings, roughness {}", m.roughness), e, 0.015);
    CHECK(e.count > 100);
    CHECK(e.share() > 0.995);
    CHECK(e.largest < 0.02);
    CHECK(p.at(0, 0) == dvec3(10));  // the colour is the background too
  }
}

TEST_CASE("the background shows the map: up is up, the centre column is -Z, +X is to the right of it") {
  Stage stage;
  Scene scene;
  const int w = 256, h = 128;
  const auto value = [](double u, double v) { return dvec3(1 + 0.8 * std::sin(2 * kPi * u), 1 + 0.8 * std::cos(2 * kPi * u), 2 * v); };
  scene.environment.map = makeImage(w, h, 3, PixelType::F32);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      for (int c = 0; c < 3; ++c) scene.environment.map.f32()[(y * w + x) * 3 + c] = float(value((x + 0.5) / w, (y + 0.5) / h)[c]);
  scene.environment.scale = 3;
  ++scene.environment.revision;
  Errors e;
  for (dvec3 forward : {dvec3(0, 0, -1), dvec3(1, 0.2, 0), dvec3(-0.3, -0.8, 1)}) {
    const View view = lookAt({5, 6, 7}, dvec3(5, 6, 7) + forward);
    const Picture p = stage.linear(scene, view, {60, 40});
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 60; ++x) {
        const dvec3 d = rayThrough(view, {60, 40}, x + 0.5, y + 0.5).direction;
        const double v = std::acos(d.y) / kPi;
        if (v < 0.02 || v > 0.98) continue;  // the first and last row's halves hold their colour
        e.add(relative(p.at(x, y), 3.0 * value(0.5 + std::atan2(d.x, -d.z) / (2 * kPi), v), 0.02), 0.005);
      }
  }
  say("background", e, 0.005);
  CHECK(e.share() == 1);
  CHECK(e.count > 6000);
}
