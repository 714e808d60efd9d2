// Shadows against exact rays: a floor, a ball and a wall 2 cm thick, under suns down to 2 degrees, a spot light and a point light.
//
// Every pixel's point, in double, is in the light or not. A map cannot know better than its kernel: lookups reach r texels around a point (1 with one tap, 2 with 3 x 3), and the point itself is moved by
// the normal offset (interface/shadow.glsl), so points whose answer changes within r + offset + half a texel, measured across the light, are the edge and are left out; they are counted. For
// the others the picture over the picture without shadows must be on the right side of a half.
#include <fmt/format.h>

#include <iostream>

#include "plan/situation.h"
#include "render/shadowed.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{320, 200};

struct Source {
  bool sun = true;
  dvec3 place{0};  ///< unit, to the light; or where it is
  [[nodiscard]] dvec3 toward(dvec3 p) const { return sun ? place : glm::normalize(place - p); }
  [[nodiscard]] double distance(dvec3 p) const { return sun ? 1e29 : glm::length(place - p); }
};

struct Outcome {
  int judged = 0, edge = 0, wrong = 0, acne = 0, leak = 0, uncertain = 0;
  [[nodiscard]] double share() const { return double(wrong) / judged; }
};

scene::ShadowSet shadowsOf(const Scene& scene, const View& view, const Quality& quality) {
  scene::Derived derived;
  derived.update(scene);
  Report report;
  plan::Seen seen;
  plan::look(scene, derived, view, kSize, quality, report, seen);
  return std::move(seen.shadows);
}

/// Side of a texel at a point of the scene, across the light (m).
double texelAt(const scene::ShadowSet& set, dvec3 world, int resolution) {
  for (const scene::SunShadow& sun : set.suns)
    for (const scene::Cascade& c : sun.cascades) {
      const dvec3 q = glm::transpose(sun.axes) * (world - c.center);
      if (std::max(std::abs(q.x), std::abs(q.y)) < c.radius * 0.98 && q.z > -c.far) return 2 * c.radius / resolution;
    }
  for (const scene::LocalShadow& s : set.locals) {
    const dvec3 q = s.cube ? glm::abs(world - s.origin) : glm::abs(glm::transpose(s.axes) * (world - s.origin));
    return 2 * s.tangent * (s.cube ? std::max({q.x, q.y, q.z}) : q.z) / resolution;
  }
  return 0;
}

double luminance(dvec3 c) { return c.x + c.y + c.z; }

/// One picture against rays. `kernel`: texels that a lookup may reach.
Outcome judge(Stage& stage, const Yard& yard, const View& view, const Source& light, const Quality& quality, double kernel) {
  Quality none = quality;
  none.shadow = Shadow::None;
  const Picture bare = stage.linear(yard.scene, view, kSize, none), p = stage.linear(yard.scene, view, kSize, quality);
  REQUIRE(stage.renderer->lastPlan().on("shadows"));
  const scene::ShadowSet set = shadowsOf(yard.scene, view, quality);
  View local = view;
  local.eye -= yard.origin;
  Outcome out;
  double brightest = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) brightest = std::max(brightest, luminance(bare.at(x, y)));
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const Ray ray = rayThrough(local, kSize, x + 0.5, y + 0.5);
      const Yard::Hit h = yard.trace(ray);
      if (!h.what) continue;
      const dvec3 l = light.toward(h.point);
      const double nol = glm::dot(h.normal, l), full = luminance(bare.at(x, y));
      // Pixels that the light barely reaches at all say nothing. The ball's facets turn away from the light some 0.02 rad before the ball does.
      if (nol < (h.what == 2 ? 0.03 : 0.01) || full < brightest * 1e-4) continue;
      const double reach = kernel * texelAt(set, h.point + yard.origin, quality.shadowResolution);
      const dvec3 side = glm::normalize(glm::cross(std::abs(l.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0), l)), up = glm::cross(l, side);
      int blocked = 0, rays = 0;
      for (int k = 0; k < 25; ++k) {
        // Across the light, and along it back onto the surface's plane, a hair off it.
        const dvec3 shift = (side * double(k % 5 - 2) + up * double(k / 5 - 2)) * (reach / 2);
        const dvec3 from = h.point + shift - l * (glm::dot(h.normal, shift) / nol) + h.normal * 1e-6;
        blocked += yard.blocked(from, light.toward(from), light.distance(from), 0);
        ++rays;
      }
      if (blocked != 0 && blocked != rays) {
        ++out.edge;
        continue;
      }
      const double visible = luminance(p.at(x, y)) / full;
      ++out.judged;
      if (blocked && visible > 0.5) ++out.wrong, ++out.leak;
      if (!blocked && visible < 0.5) ++out.wrong, ++out.acne;
      out.uncertain += blocked ? visible > 0.05 : visible < 0.95;
    }
  return out;
}

Quality quality(Shadow rung) {
  Quality q;
  q.shadow = rung;
  return q;
}
constexpr std::pair<Shadow, double> kRungs[] = {{Shadow::Tap, 1 + 1 + 0.5}, {Shadow::Pcf, 2 + 2.25 + 0.5}, {Shadow::Pcss, 2 + 2.25 + 0.5}};
constexpr const char* kNames[] = {"none", "tap", "pcf", "pcss"};

View viewOfYard(dvec3 origin = dvec3(0)) { return lookAt(origin + dvec3(1.5, 2.2, 5), origin + dvec3(-0.2, 0.3, 0), {0, 1, 0}, 0.8f); }

void check(const std::string& what, const Outcome& o) {
  std::cout << fmt::format("  {:<44} {:5} pixels judged ({} of the edge left out), wrong {:.3f} % (in the dark {}, lit {}); off by 5 %: {:.2f} %\n", what, o.judged, o.edge, 100 * o.share(), o.acne, o.leak,
                           100.0 * o.uncertain / o.judged);
  INFO(what);
  CHECK(o.judged > kSize.x * kSize.y / 4);
  CHECK(o.share() < 0.005);
  CHECK(o.uncertain < 0.02 * o.judged);
}

dvec3 sunAt(double elevation, double azimuth) {
  const double e = elevation * kPi / 180, a = azimuth * kPi / 180;
  return {std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a)};
}

}  // namespace

TEST_CASE("shadows of suns from 2 degrees up agree with rays: acne and leaks under 0.5 %", "[shadow]") {
  Stage stage;
  for (const double elevation : {2.0, 5.0, 10.0, 30.0, 75.0})
    for (const double azimuth : {160.0, 75.0}) {
      Yard yard;
      Light sun = light(LightKind::Directional, vec3(1), 1000);
      sun.castsShadow = true;
      sun.angularDiameter = 0;
      const Source source{true, sunAt(elevation, azimuth)};
      addLight(yard.scene, sun, {0, 0, 0}, -source.place);
      for (const auto& [rung, kernel] : kRungs)
        check(fmt::format("{}, sun at {} degrees, from {}", kNames[int(rung)], elevation, azimuth), judge(stage, yard, viewOfYard(), source, quality(rung), kernel));
    }
}

TEST_CASE("shadows of spot and point lights agree with rays", "[shadow]") {
  Stage stage;
  for (const bool point : {false, true})
    for (const dvec3 at : {dvec3(-4.5, 0.5, 1.5), dvec3(-2.5, 2.5, 2), dvec3(0.2, 3, -0.5)}) {
      Yard yard;
      Light l = light(point ? LightKind::Point : LightKind::Spot, vec3(1), 500, 30);
      l.castsShadow = true;
      l.sourceRadius = 0;
      l.innerCone = l.outerCone = 0.9f;
      addLight(yard.scene, l, at, dvec3(0, 0.2, 0) - at);
      for (const auto& [rung, kernel] : kRungs)
        check(fmt::format("{}, {} light at {}, {}, {}", kNames[int(rung)], point ? "point" : "spot", at.x, at.y, at.z), judge(stage, yard, viewOfYard(), {false, at}, quality(rung), kernel));
    }
}

TEST_CASE("shadows a million metres from the origin", "[shadow]") {
  Stage stage;
  const dvec3 origin(1e6 + 0.3, 2e5, -1e6);
  Yard yard(origin);
  Light sun = light(LightKind::Directional, vec3(1), 1000);
  sun.castsShadow = true;
  sun.angularDiameter = 0;
  const Source source{true, sunAt(10, 160)};
  addLight(yard.scene, sun, {0, 0, 0}, -source.place);
  for (const auto& [rung, kernel] : kRungs) check(fmt::format("{}, sun at 10 degrees, 1.4e6 m out", kNames[int(rung)]), judge(stage, yard, viewOfYard(origin), source, quality(rung), kernel));
  Yard other(origin);
  Light l = light(LightKind::Point, vec3(1), 500, 30);
  l.castsShadow = true;
  l.sourceRadius = 0;
  const dvec3 at(-2.5, 2.5, 2);
  addLight(other.scene, l, origin + at);
  for (const auto& [rung, kernel] : kRungs) check(fmt::format("{}, point light, 1.4e6 m out", kNames[int(rung)]), judge(stage, other, viewOfYard(origin), {false, at}, quality(rung), kernel));
}
