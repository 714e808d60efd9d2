// Soft shadows against closed forms, borders of cascades and cube faces, and the foot of a wall in millimetres.
#include <fmt/format.h>

#include <iostream>

#include "render/shadowed.h"

using namespace burnish;
using namespace burnish::test;

namespace {

Quality quality(Shadow rung) {
  Quality q;
  q.shadow = rung;
  return q;
}
Material matte() {
  Material m;
  m.albedo = vec3(0.5f);
  m.roughness = 1;
  return m;
}
/// With shadows over without, pixel by pixel (of the green channel).
std::vector<double> visibility(Stage& stage, const Scene& scene, const View& view, glm::ivec2 size, const Quality& q) {
  Quality none = q;
  none.shadow = Shadow::None;
  const Picture with = stage.linear(scene, view, size, q), without = stage.linear(scene, view, size, none);
  std::vector<double> v;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) v.push_back(without.at(x, y).y > 0 ? with.at(x, y).y / without.at(x, y).y : -1);
  return v;
}
dvec3 onFloor(const Ray& r) { return r.origin - r.direction * (r.origin.y / r.direction.y); }

/// Share of a disc of radius 1 that shows past a straight edge at t from its middle.
double discPast(double t) {
  if (t <= -1) return 0;
  if (t >= 1) return 1;
  return 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / kPi;
}

}  // namespace

TEST_CASE("the penumbra of a straight edge is as wide as the light's disc makes it", "[shadow]") {
  // A plate over the floor that ends at x = 0, in light from above.
  Stage stage;
  const glm::ivec2 size{400, 60};
  struct Setting {
    bool sun;
    double height, spread;  ///< of the plate over the floor; half width of the penumbra, m
  };
  // Lamp 4 m over the floor, radius R: R h/(4 - h).
  for (const Setting s : {Setting{true, 1.0, 0.04}, Setting{true, 2.0, 0.09}, Setting{false, 1.0, 0.04}, Setting{false, 2.0, 0.09}}) {
    Scene scene;
    place(scene, quad({0, 0, 0}, {0, 0, 3}, {3, 0, 0}), matte());
    place(scene, box({-2, float(s.height), -2}, {0, float(s.height) + 0.02f, 2}), matte());
    Light l = light(s.sun ? LightKind::Directional : LightKind::Spot, vec3(1), 1000, 20);
    l.castsShadow = true;
    l.innerCone = l.outerCone = 0.6f;
    l.angularDiameter = float(2 * std::atan(s.spread / s.height));
    l.sourceRadius = float(s.spread * (4 - s.height) / s.height);
    addLight(scene, l, {0, 4, 0}, {0, -1, 0});
    View view = lookAt({3, 2.2, 0}, {0, 0, 0}, {0, 1, 0}, 0.15f);
    const std::vector<double> v = visibility(stage, scene, view, size, quality(Shadow::Pcss));
    double worst = 0, tenth = 1e9, nine = -1e9;
    int judged = 0;
    for (int x = 0; x < size.x; ++x)
      for (int y = size.y / 2 - 4; y < size.y / 2 + 4; ++y) {
        const dvec3 p = onFloor(rayThrough(view, size, x + 0.5, y + 0.5));
        if (std::abs(p.x) > 2.5 * s.spread || std::abs(p.z) > 1) continue;
        const double seen = v[std::size_t(y * size.x + x)];
        ++judged;
        worst = std::max(worst, std::abs(seen - discPast(p.x / s.spread)));
        if (seen > 0.1) tenth = std::min(tenth, p.x);
        if (seen < 0.9) nine = std::max(nine, p.x);
      }
    // A disc is past the edge by a tenth and by nine tenths at -0.687 and 0.687 of its radius.
    const double width = (nine - tenth) / (2 * 0.687 * s.spread);
    std::cout << fmt::format("  {} {} m over the floor: penumbra {:.0f} mm, {:.2f} of what it should be; visibility off by at most {:.3f} in {} pixels\n", s.sun ? "sun, plate" : "lamp, plate", s.height,
                             2000 * s.spread, width, worst, judged);
    CHECK(judged > 100);
    CHECK(width > 0.8);
    CHECK(width < 1.3);
    CHECK(worst < 0.15);
  }
}

TEST_CASE("what casts near the ground casts its shadow however far above other casters may be", "[shadow]") {
  // A plate at hand's width over the floor, in the sun; far above it a beam, whose blocked light would be spread over more texels than are searched.
  Stage stage;
  Scene scene;
  place(scene, quad({0, 0, 0}, {0, 0, 3}, {3, 0, 0}), matte());
  place(scene, box({-0.5f, 0.1f, -0.5f}, {0.5f, 0.12f, 0.5f}), matte());
  place(scene, box({4.5f, 6, -2}, {4.9f, 6.2f, 2}), matte());  // its shadow lies at x = 0.9 to 1.3
  Light l = light(LightKind::Directional, vec3(1), 1000);
  l.castsShadow = true;
  l.angularDiameter = 0.03f;
  addLight(scene, l, {0, 0, 0}, {-0.6, -1, 0});
  const View view = lookAt({-2.5, 1.2, 0}, {0, 0, 0}, {0, 1, 0}, 0.6f);
  const glm::ivec2 size{200, 120};
  for (const Shadow rung : {Shadow::Pcf, Shadow::Pcss}) {
    const std::vector<double> v = visibility(stage, scene, view, size, quality(rung));
    double lightest = 0, darkest = 1;
    int judged = 0;
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const dvec3 p = onFloor(rayThrough(view, size, x + 0.5, y + 0.5));
        const double seen = v[std::size_t(y * size.x + x)];
        // The plate's shadow lies 6 to 7 cm beside it; of it what the plate does not hide, and the floor well before it.
        if (p.x > -0.555 && p.x < -0.515 && std::abs(p.z) < 0.45) lightest = std::max(lightest, seen), ++judged;
        if (p.x > -1.5 && p.x < -0.7 && std::abs(p.z) < 0.45) darkest = std::min(darkest, seen);
      }
    INFO("rung " << int(rung) << ": " << judged << " pixels");
    CHECK(judged > 20);
    CHECK(lightest < 0.05);
    CHECK(darkest > 0.95);
  }
}

TEST_CASE("soft edges fall off smoothly: no grain, no bands", "[shadow]") {
  Stage stage;
  Scene scene;
  place(scene, quad({0, 0, 0}, {0, 0, 3}, {3, 0, 0}), matte());
  place(scene, box({-2, 2, -2}, {0, 2.02f, 2}), matte());
  Light l = light(LightKind::Directional, vec3(1), 1000);
  l.castsShadow = true;
  l.angularDiameter = 0.09f;
  addLight(scene, l, {0, 0, 0}, {0, -1, 0});
  const View view = lookAt({3, 2.2, 0}, {0, 0, 0}, {0, 1, 0}, 0.1f);
  const glm::ivec2 size{60, 200};
  const std::vector<double> v = visibility(stage, scene, view, size, quality(Shadow::Pcss));
  // Up the picture x falls from light to dark. From pixel to pixel visibility steps by the closed form's slope, at most 2/(pi R) a metre, and by two of the 32 lookups that may meet the edge together;
  // the wrong way by none.
  double most = 0, beyond = 0, rise = 0;
  for (int y = 0; y + 1 < size.y; ++y) {
    const dvec3 a = onFloor(rayThrough(view, size, 30.5, y + 0.5)), b = onFloor(rayThrough(view, size, 30.5, y + 1.5));
    const double step = v[std::size_t((y + 1) * size.x + 30)] - v[std::size_t(y * size.x + 30)];
    most = std::max(most, std::abs(step));
    beyond = std::max(beyond, std::abs(step) - 2 / (kPi * 0.09) * std::abs(b.x - a.x));
    rise = std::max(rise, (b.x > a.x ? -step : step));
  }
  std::cout << fmt::format("  largest step {:.4f}, {:.4f} more than the closed form's, the wrong way {:.4f}\n", most, beyond, rise);
  CHECK(beyond < 2.0 / 32);
  CHECK(rise < 1.0 / 30);
  // Along the edge nothing changes.
  double along = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 10; x + 1 < 50; ++x) along = std::max(along, std::abs(v[std::size_t(y * size.x + x + 1)] - v[std::size_t(y * size.x + x)]));
  std::cout << fmt::format("  largest step along the edge {:.4f}\n", along);
  CHECK(along < 0.06);
}

TEST_CASE("where cascades and cube faces meet there is no seam", "[shadow]") {
  Stage stage;
  const glm::ivec2 size{240, 160};
  for (const Shadow rung : {Shadow::Tap, Shadow::Pcf, Shadow::Pcss})
    for (const bool sun : {true, false}) {
      Scene scene;
      // A floor to the horizon, with something far off that casts into every map.
      place(scene, quad({0, 0, 0}, {0, 0, 60}, {60, 0, 0}), matte());
      place(scene, box({-0.1f, 0, -50}, {0.1f, 0.3f, -49.5f}), matte());
      Light l = light(sun ? LightKind::Directional : LightKind::Point, vec3(1), 1000, 200);
      l.castsShadow = true;
      addLight(scene, l, sun ? dvec3(0) : dvec3(1, 2, -3), {-0.9, -0.2, -0.3});
      const View view = lookAt({0, 1.6, 6}, {0, 0.8, 0}, {0, 1, 0}, 1.0f);
      const std::vector<double> v = visibility(stage, scene, view, size, quality(rung));
      double least = 1;
      int judged = 0;
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
          const Ray r = rayThrough(view, size, x + 0.5, y + 0.5);
          if (r.direction.y > -0.03) continue;
          ++judged;
          least = std::min(least, v[std::size_t(y * size.x + x)]);
        }
      std::cout << fmt::format("  rung {}, {}: {} lit pixels, the darkest {:.4f}\n", int(rung), sun ? "sun, four cascades" : "point light", judged, least);
      CHECK(judged > 10000);
      CHECK(least > 0.999);
    }
}

TEST_CASE("an edge that crosses cascades bends by no more than their texels", "[shadow]") {
  Stage stage;
  const glm::ivec2 size{480, 320};
  Scene scene;
  place(scene, quad({0, 0, 0}, {0, 0, 40}, {40, 0, 0}), matte());
  // A beam along the view: its shadow ends along x = 0.1 + 1.1 / tan(50 degrees).
  place(scene, box({-0.1f, 1, -36}, {0.1f, 1.1f, 6}), matte());
  Light l = light(LightKind::Directional, vec3(1), 1000);
  l.castsShadow = true;
  const double e = 50 * kPi / 180;
  addLight(scene, l, {0, 0, 0}, {std::cos(e), -std::sin(e), 0});
  const View view = lookAt({2.5, 2, 5}, {1, 0, -6}, {0, 1, 0}, 0.9f);
  const std::vector<double> v = visibility(stage, scene, view, size, quality(Shadow::Pcf));
  const double edge = 0.1 + 1.1 / std::tan(e);
  double worst = 0;
  int judged = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 1; x < size.x; ++x) {
      const double a = v[std::size_t(y * size.x + x - 1)], b = v[std::size_t(y * size.x + x)];
      if (!(a >= 0 && a < 0.5 && b >= 0.5)) continue;
      const double share = (0.5 - a) / (b - a);
      const dvec3 p = onFloor(rayThrough(view, size, x - 0.5 + share, y + 0.5)), q = onFloor(rayThrough(view, size, x + 0.5 + share, y + 0.5));
      if (p.z < -25 || p.z > 3) continue;
      ++judged;
      // In pixels, so that all distances count alike.
      worst = std::max(worst, std::abs(p.x - edge) / glm::length(q - p));
    }
  std::cout << fmt::format("  {} rows, the edge off by at most {:.2f} pixels\n", judged, worst);
  CHECK(judged > 60);
  // A texel is no wider than three pixels here, and the normal offset moves an edge by 2.25 texels times sin(50 degrees) less what the slope in the map gives back.
  CHECK(worst < 4);
}

TEST_CASE("the foot of a thin wall: where its shadow begins, in millimetres", "[shadow]") {
  Stage stage;
  const glm::ivec2 size{900, 120};
  for (const Shadow rung : {Shadow::Tap, Shadow::Pcf, Shadow::Pcss})
    for (const double elevation : {2.0, 10.0, 30.0, 60.0}) {
      Yard yard;
      Light sun = light(LightKind::Directional, vec3(1), 1000);
      sun.castsShadow = true;
      sun.angularDiameter = 0;
      const double e = elevation * kPi / 180;
      addLight(yard.scene, sun, {0, 0, 0}, {std::cos(e), -std::sin(e), 0});
      // From behind the wall, 4 m off: a pixel is 2 mm of the floor across the view.
      const View view = lookAt({3.5, 3.2, 0}, {0.85, 0, 0}, {0, 1, 0}, 0.06f);
      const std::vector<double> v = visibility(stage, yard.scene, view, size, quality(rung));
      double gap = 0;
      int judged = 0;
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
          const Ray r = rayThrough(view, size, x + 0.5, y + 0.5);
          const Yard::Hit h = yard.trace(r);
          if (h.what != 1 || h.point.x < yard.wallHigh.x || h.point.x > 1.0 || std::abs(h.point.z) > 1) continue;
          ++judged;
          if (v[std::size_t(y * size.x + x)] > 0.5) gap = std::max(gap, h.point.x - yard.wallHigh.x);
        }
      std::cout << fmt::format("  rung {}, sun at {} degrees: light reaches {:.1f} mm under the wall ({} pixels)\n", int(rung), elevation, 1000 * gap, judged);
      CHECK(judged > 1000);
      // The wall is 20 mm thick: as long as the kernel finds it, there is no gap.
      CHECK(gap < 0.004);
    }
}
