// H25: glass against closed forms in double: Snell's offset, Beer and Lambert, Fresnel's reflectance, a white room; order; what must stay finite.
#include <catch2/catch.hpp>

#include "reference/shading.h"
#include "render/transparent.h"

namespace burnish::test {
namespace {

constexpr glm::ivec2 kSize{120, 90};

/// A wall across the view whose red rises from left to right and whose green is constant: red over green says where it is seen, whatever the glass keeps.
Id<Instance> addRuler(Scene& scene, float z) {
  Material m = shining(vec3(1));
  Texture ramp = painted(MapKind::Emissive, 32, [](float u, float v) { return vec4(0.2f + 0.8f * u, 0.8f, 0.2f + 0.8f * v, 1); });
  ramp.sampler.wrapU = ramp.sampler.wrapV = Wrap::ClampToEdge;
  m.emissiveMap = scene.textures.add(ramp);
  return place(scene, quad({0, 0, z}, {4, 0, 0}, {0, 4, 0}), m);
}

glm::dmat4 turned(double degrees, dvec3 axis = {0, 1, 0}) { return glm::dmat4(glm::mat3_cast(glm::angleAxis(degrees * kPi / 180, glm::normalize(axis)))); }

/// What is not finite is larger than anything.
double largest(const dvec3& v) {
  const double sum = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
  return sum < 1e300 ? std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) : 1e300;
}

bool finite(const Picture& p) {
  for (int y = 0; y < p.image.height; ++y)
    for (int x = 0; x < p.image.width; ++x)
      if (!(largest(p.at(x, y)) < 1e30)) return false;
  return true;
}

/// Where a value of the rising row `ruler` is, in pixels.
double placeOf(const std::vector<double>& ruler, double value) {
  for (std::size_t i = 1; i < ruler.size(); ++i)
    if (ruler[i] >= value) return double(i - 1) + (value - ruler[i - 1]) / (ruler[i] - ruler[i - 1]);
  return 1e9;
}

/// NaN is worse than anything.
double worse(double a, double b) { return b <= a ? a : b; }

std::vector<double> rulerOf(const Picture& p, int y) {
  std::vector<double> row;
  for (int x = 0; x < p.image.width; ++x) row.push_back(p.at(x, y).x / p.at(x, y).y);
  return row;
}

}  // namespace

TEST_CASE("glass of index 1 is invisible: slabs, balls, panes, rough or not, at the picture's edge too", "[glass]") {
  Stage stage;
  Scene scene;
  addRuler(scene, -2);
  scene.environment.color = vec3(0.7f, 0.6f, 0.5f);
  addLight(scene, light(LightKind::Directional, vec3(1), 5), {}, {0.3, -0.5, -1});
  const View view = lookAt({0.2, 0.1, 3}, {0, 0, 0});
  for (Path path : {Path::Deferred, Path::Forward}) {
    Quality quality = onPath(path);
    quality.exposureEv = 1.0f;
    const Picture bare = stage.display(scene, view, kSize, quality);
    std::vector<Id<Instance>> bodies;
    bodies.push_back(place(scene, box({-0.9f, -0.9f, -0.2f}, {0.1f, 0.1f, 0.2f}), glassOf(1, 0.4f), turned(25)));
    bodies.push_back(place(scene, sphere(0.5f, 32, 64), glassOf(1, 1), translation({0.9, 0.3, 0})));
    bodies.push_back(place(scene, sphere(0.4f, 32, 64), glassOf(1, 0.8f, 0.5f), translation({0, 0.9, 0.2})));
    bodies.push_back(place(scene, quad({1.6f, -0.6f, 0}, {0.6f, 0, 0}, {0, 0.4f, 0}), glassOf(1, 0, 0.4f)));
    const Picture a = stage.display(scene, view, kSize, quality);
    CHECK(stage.renderer->lastPlan().on("glass"));
    const Errors e = difference(a, bare, 1.01 / 255);
    CHECK(e.largest < 1.01 / 255);
    for (Id<Instance> id : bodies) scene.instances.remove(id);
  }
}

TEST_CASE("a slab shifts what is behind it by Snell's law, within a pixel", "[glass]") {
  Stage stage;
  constexpr glm::ivec2 size{320, 160};
  for (bool parallel : {false, true})
    for (Path path : {Path::Deferred, Path::Forward})
      for (double angle : {0.0, 35.0, -50.0})
        for (double ior : {1.33, 1.8}) {
          if (path == Path::Forward && ior < 1.5) continue;
          CAPTURE(parallel, angle, ior);
          const double thickness = 0.5;
          Scene scene;
          addRuler(scene, -2);
          View view = lookAt({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.6f);
          view.orthographic = parallel;
          view.far = 20;
          const int row = size.y / 2;
          const std::vector<double> ruler = rulerOf(stage.linear(scene, view, size, onPath(path)), row);
          const glm::dmat4 turn = turned(angle);
          place(scene, box({-0.9f, -0.9f, float(-thickness / 2)}, {0.9f, 0.9f, float(thickness / 2)}), glassOf(float(ior), float(thickness)), turn);
          const Picture p = stage.linear(scene, view, size, onPath(path));
          const dvec3 n(turn[2]);
          double worst = 0, moved = 0;
          int count = 0;
          for (int x = 4; x < size.x - 4; ++x) {
            const Ray ray = rayThrough(view, size, x + 0.5, row + 0.5);
            // Entry through the front face, away from its edges.
            const double s = (thickness / 2 - glm::dot(n, ray.origin)) / glm::dot(n, ray.direction);
            const dvec3 entry = ray.origin + ray.direction * s;
            if (std::abs(glm::dot(entry, dvec3(turn[0]))) > 0.85) continue;
            const double c = -glm::dot(ray.direction, n), c2 = std::sqrt(1 - (1 - c * c) / (ior * ior));
            const dvec3 inside = (ray.direction + n * c) / ior - n * c2, leaves = entry + inside * (thickness / c2);
            const dvec3 hit = leaves + ray.direction * ((-2 - leaves.z) / ray.direction.z);
            // The pixel whose unhindered ray ends there.
            const double there = parallel ? (hit.x / (view.height / 2.0 * size.x / size.y) + 1) / 2 * size.x : (hit.x / (5 * std::tan(0.3) * size.x / size.y) + 1) / 2 * size.x;
            if (there < 3 || there > size.x - 3) continue;
            worst = worse(worst, std::abs(placeOf(ruler, p.at(x, row).x / p.at(x, row).y) + 0.5 - there));
            moved = std::max(moved, std::abs(there - x - 0.5));
            ++count;
          }
          CAPTURE(worst, moved, count);
          CHECK(count > 60);
          CHECK(worst < 0.1);
          if (angle != 0) CHECK(moved > 4);
        }
}

TEST_CASE("a ball turns what is behind it by Snell's law at both surfaces", "[glass]") {
  Stage stage;
  constexpr glm::ivec2 size{320, 160};
  const double radius = 0.6, ior = 1.2;
  Scene scene;
  addRuler(scene, -2);
  const View view = lookAt({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.6f);
  const std::vector<double> ruler = rulerOf(stage.linear(scene, view, size), size.y / 2);
  place(scene, sphere(float(radius), 96, 192), glassOf(float(ior), float(2 * radius)));
  const Picture p = stage.linear(scene, view, size);
  double worst = 0, moved = 0;
  int count = 0;
  for (int x = 0; x < size.x; ++x) {
    const Ray ray = rayThrough(view, size, x + 0.5, size.y / 2 + 0.5);
    const double b = glm::dot(ray.origin, ray.direction), d = b * b - glm::dot(ray.origin, ray.origin) + radius * radius;
    if (d < 0) continue;
    const dvec3 entry = ray.origin + ray.direction * (-b - std::sqrt(d)), n = entry / radius;
    const double c = -glm::dot(ray.direction, n);
    if (c < 0.6) continue;  // beyond that the picture is squeezed into few pixels
    const double c2 = std::sqrt(1 - (1 - c * c) / (ior * ior));
    const dvec3 inside = (ray.direction + n * c) / ior - n * c2, leaves = entry + inside * (2 * radius * c2), m = leaves / radius;
    const double k = glm::dot(inside, m), k2 = std::sqrt(1 - (1 - k * k) * ior * ior);
    const dvec3 out = (inside - m * k) * ior + m * k2, hit = leaves + out * ((-2 - leaves.z) / out.z);
    const double there = (hit.x / (5 * std::tan(0.3) * size.x / size.y) + 1) / 2 * size.x;
    if (there < 3 || there > size.x - 3) continue;
    worst = worse(worst, std::abs(placeOf(ruler, p.at(x, size.y / 2).x / p.at(x, size.y / 2).y) + 0.5 - there));
    moved = std::max(moved, std::abs(there - x - 0.5));
    ++count;
  }
  CAPTURE(worst, moved, count);
  CHECK(count > 40);
  CHECK(moved > 20);
  CHECK(worst < 0.1);
}

TEST_CASE("absorption follows Beer and Lambert within 1 %", "[glass]") {
  Stage stage;
  const vec3 color(0.7f, 0.4f, 0.1f);
  const double distance = 0.25;
  const View view = lookAt({0, 0, 3}, {0, 0, 0});
  const auto ratio = [&](Mesh mesh, float thickness, const glm::dmat4& turn) {
    Scene scene;
    place(scene, quad({0, 0, -2}, {9, 0, 0}, {0, 9, 0}), shining(vec3(1)));
    const Id<Instance> body = place(scene, std::move(mesh), glassOf(1.5f, thickness), turn);
    const dvec3 clear = stage.linear(scene, view, {121, 91}).at(60, 45);
    Material& m = *scene.materials.edit(scene.instances.get(body)->material);
    m.attenuationColor = color;
    m.attenuationDistance = float(distance);
    return stage.linear(scene, view, {121, 91}).at(60, 45) / clear;
  };
  const auto expect = [&](const dvec3& measured, double way) {
    for (int i = 0; i < 3; ++i) CHECK(measured[i] == Approx(std::pow(double(color[i]), way / distance)).epsilon(0.01));
  };
  const Mesh slab = box({-1, -1, -0.1f}, {1, 1, 0.1f});
  expect(ratio(slab, 0.2f, turned(0)), 0.2);
  expect(ratio(slab, 0.2f, turned(50)), 0.2 / std::sqrt(1 - std::pow(std::sin(50 * kPi / 180) / 1.5, 2)));
  expect(ratio(sphere(0.3f, 48, 96), 0.6f, turned(0)), 0.6);
  expect(ratio(slab, 0, turned(0)), 0);  // a thin pane
  // Scaled instances scale their thickness along the normal.
  glm::dmat4 flat(1);
  flat[2][2] = 0.5;
  expect(ratio(slab, 0.2f, flat), 0.1);
}

TEST_CASE("glass reflects what Fresnel's equation says, exact or Schlick", "[glass]") {
  Stage stage;
  const View view = lookAt({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.3f);
  for (Fresnel fresnel : {Fresnel::Schlick, Fresnel::Dielectric})
    for (float ior : {1.33f, 1.5f, 2.0f})
      for (double angle : {0.0, 30.0, 50.0, 65.0, 80.0, 86.0})
        for (float thickness : {0.0f, 0.1f}) {
          if (thickness > 0 && ior != 1.5f) continue;
          CAPTURE(int(fresnel), ior, angle, thickness);
          Scene scene;
          scene.environment.color = vec3(1);
          scene.environment.background = false;  // nothing but the reflection is bright
          place(scene, quad({0, 0, -1}, {9, 0, 0}, {0, 9, 0}), shining(vec3(0)));
          place(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), glassOf(ior, thickness), turned(angle));
          const double c = std::cos(angle * kPi / 180), s = (ior - 1.0) / (ior + 1.0), f0 = s * s;
          const double expected = fresnel == Fresnel::Schlick ? f0 + (1 - f0) * std::pow(1 - c, 5) : shading::f64::dielectricReflectance(ior, c);
          const double measured = stage.linear(scene, view, {61, 61}, onPath(Path::Deferred, fresnel)).at(30, 30).x;
          CHECK(measured == Approx(expected).epsilon(0.01).margin(0.002));
        }
}

TEST_CASE("a white room: glass gives back what it gets, never more", "[glass]") {
  Stage stage;
  Scene scene;
  scene.environment.color = vec3(1);
  const Id<Instance> body = place(scene, sphere(1, 32, 64), Material{});
  const Id<Material> id = scene.instances.get(body)->material;
  const View view = lookAt({0, 0, 3.2}, {0, 0, 0});
  for (bool twoSided : {false, true})
    for (float transmission : {0.4f, 1.0f})
      for (float ior : {1.0f, 1.5f, 2.4f})
        for (float roughness : {0.0f, 0.3f, 1.0f})
          for (float thickness : {0.0f, 2.0f})
            for (Fresnel fresnel : {Fresnel::Schlick, Fresnel::Dielectric}) {
              if (twoSided && fresnel == Fresnel::Dielectric) continue;
              CAPTURE(twoSided, transmission, ior, roughness, thickness, int(fresnel));
              *scene.materials.edit(id) = glassOf(ior, thickness, roughness);
              scene.materials.edit(id)->transmission = transmission;
              scene.materials.edit(id)->twoSided = twoSided;
              const Picture p = stage.linear(scene, view, {40, 40}, onPath(Path::Deferred, fresnel));
              double most = 0, least = 1e9;
              for (int y = 0; y < 40; ++y)
                for (int x = 0; x < 40; ++x) {
                  most = std::max(most, largest(p.at(x, y)));
                  least = std::min(least, p.at(x, y).x);
                }
              CHECK(most < 1.004);
              // Light that is reflected inside is what a rough lobe keeps of it.
              CHECK(least > (transmission == 1 ? (twoSided ? 0.4 : 0.99) : 0.25));
            }
}

namespace {

Material veil(vec3 color, float opacity) {
  Material m;
  m.unlit = m.blend = m.twoSided = true;
  m.albedo = color;
  m.opacity = opacity;
  return m;
}
/// Glass that only tints (index 1) but reads the picture behind it as any rough glass does.
Material tint(vec3 color) {
  Material m = glassOf(1, 0, 0.3f);
  m.albedo = color;
  m.twoSided = true;
  return m;
}

}  // namespace

TEST_CASE("glass and a veil that cross are right on both sides of the line, from both sides; glass sees glass", "[glass]") {
  Stage stage;
  const dvec3 color(0.5, 0.9, 0.2), milk(0.8, 0.1, 0.6);
  const double o = 0.4;
  for (Path path : {Path::Deferred, Path::Forward})
    for (double side : {1.0, -1.0}) {
      Scene scene;
      place(scene, quad({0, 0, -4}, {20, 0, 0}, {0, 20, 0}), shining(vec3(1)));
      place(scene, quad({0, 0, 4}, {-20, 0, 0}, {0, 20, 0}), shining(vec3(1)));
      place(scene, quad({0, 0, 0}, {0.8f, 0, 0.5f}, {0, 0.7f, 0}), tint(vec3(color)));
      place(scene, quad({0, 0, 0}, {0.8f, 0, -0.5f}, {0, 0.7f, 0}), veil(vec3(milk), float(o)));
      const Picture p = stage.linear(scene, lookAt({0, 0, 3 * side}, {0, 0, 0}), {96, 72}, onPath(path));
      CHECK(stage.renderer->lastPlan().target("peel_a") != nullptr);
      const dvec3 glassFirst = color * (milk * o + (1 - o)), veilFirst = milk * o + color * (1 - o);
      int wrong = 0;
      for (int x = 34; x < 62; ++x) wrong += largest(p.at(x, 36) - (x >= 48 ? glassFirst : veilFirst)) > 4e-3;
      CHECK(wrong <= 1);
    }
  // Balls and panes behind one another, in no order of the tables.
  Scene scene;
  place(scene, quad({0, 0, -4}, {20, 0, 0}, {0, 20, 0}), shining(vec3(1)));
  Material ball = tint({0.5f, 0.9f, 0.2f});
  ball.twoSided = false;
  place(scene, quad({0, 0, 1}, {0.8f, 0, 0}, {0, 0.7f, 0}), tint({0.9f, 0.3f, 0.8f}));
  place(scene, sphere(0.4f, 32, 64), ball);
  place(scene, quad({0, 0, -1}, {0.8f, 0, 0}, {0, 0.7f, 0}), tint({0.6f, 0.7f, 0.9f}));
  const Picture p = stage.linear(scene, lookAt({0, 0, 3}, {0, 0, 0}), {96, 72});
  CHECK(stage.renderer->lastPlan().target("peel_a") == nullptr);
  CHECK(largest(p.at(48, 36) - dvec3(0.5, 0.9, 0.2) * dvec3(0.9, 0.3, 0.8) * dvec3(0.6, 0.7, 0.9)) < 4e-3);
}

TEST_CASE("what stands in front of glass is not seen through it", "[glass]") {
  Stage stage;
  Scene scene;
  place(scene, quad({0, 0, -3}, {20, 0, 0}, {0, 20, 0}), shining({0, 1, 0}));
  place(scene, box({-1, -1, -0.4f}, {1, 1, 0.4f}), glassOf(1.6f, 0.8f), turned(40));
  const View view = lookAt({0, 0, 4}, {0, 0, 0});
  place(scene, quad({0, 0, 1.2f}, {0.2f, 0, 0}, {0, 1.5f, 0}), shining({100, 0, 0}));
  const Picture p = stage.linear(scene, view, {160, 120});
  int covered = 0, leaked = 0;
  for (int x = 0; x < 160; ++x) {
    const dvec3 c = p.at(x, 60);
    covered += c.x > 99.9;
    leaked += c.x > 1e-3 && c.x < 99.9;
  }
  CHECK(covered >= 3);
  CHECK(leaked == 0);
}

TEST_CASE("the picture behind rough glass is blurred by roughness, and keeps its mean", "[glass]") {
  Stage stage;
  Scene scene;
  Material m = shining(vec3(1));
  m.emissiveMap = scene.textures.add(painted(MapKind::Emissive, 256, [](float u, float) { return std::sin(u * 6.2831853f * 32) > 0 ? vec4(1) : vec4(0, 0, 0, 1); }));
  place(scene, quad({0, 0, -2}, {6, 0, 0}, {0, 6, 0}), m);
  const Id<Instance> pane = place(scene, quad({0, 0, 0}, {1.5f, 0, 0}, {0, 1.5f, 0}), glassOf(1.5f, 0));
  const View view = lookAt({0, 0, 3}, {0, 0, 0});
  double before = 1e9;
  for (float roughness : {0.0f, 0.15f, 0.3f, 0.6f}) {
    scene.materials.edit(scene.instances.get(pane)->material)->roughness = roughness;
    const Picture p = stage.linear(scene, view, {256, 192});
    double mean = 0, square = 0;
    int n = 0;
    for (int y = 80; y < 112; ++y)
      for (int x = 64; x < 192; ++x, ++n) {
        mean += p.at(x, y).y;
        square += p.at(x, y).y * p.at(x, y).y;
      }
    mean /= n;
    const double deviation = std::sqrt(std::max(square / n - mean * mean, 0.0));
    CAPTURE(roughness, mean, deviation);
    CHECK(mean == Approx(0.48).epsilon(0.1));
    CHECK(deviation < before * 0.9 + 1e-3);
    before = deviation;
  }
  CHECK(before < 0.02);
}

TEST_CASE("glass stays finite: eye inside, total reflection, grazing, zero and absurd numbers, the picture's edge", "[glass]") {
  Stage stage;
  const float nan = std::nanf("");
  const View views[] = {lookAt({0, 0, 3}, {0, 0, 0}), lookAt({0.2, 0.1, 0.2}, {1, 0.3, 0}), lookAt({0, 0.999, 0.2}, {0, 1, -3}), lookAt({0, 0, 3}, {0.9, 0.8, 0}), lookAt({0, 0, 1.0001}, {0, 0, 0})};
  std::vector<Material> materials{glassOf(1.5f, 2), glassOf(2.4f, 1e9f), glassOf(100, 1), glassOf(0, 0), glassOf(nan, nan), glassOf(1, 1e-30f, nan), glassOf(1.5f, 2)};
  materials[1].attenuationColor = {0, 0.5f, 1};
  materials[1].attenuationDistance = 1e-20f;
  materials[2].attenuationColor = vec3(nan);
  materials[2].attenuationDistance = nan;
  materials[4].transmission = nan;
  materials[6].transmission = 5;
  materials[6].substance = 1;  // metal lets nothing through
  RenderRequest request;
  request.output = Output::Linear;
  request.countNonfinite = true;
  for (Material m : materials)
    for (bool twoSided : {false, true})
      for (bool parallel : {false, true}) {
        Scene scene;
        scene.environment.color = vec3(1, 0.8f, 0.6f);
        addRuler(scene, -2);
        addLight(scene, light(LightKind::Point, vec3(1), 10, 5), {0, 0.5, 0.5});
        m.twoSided = twoSided;
        m.name = "odd";
        place(scene, sphere(1, 24, 48), m);
        place(scene, quad({0, 1, 0}, {2, 0, 0}, {0, 0, -2}), m);
        for (View view : views) {
          view.orthographic = parallel;
          view.far = 30;
          const Picture p = stage.draw(scene, {&view, 1}, {48, 36}, {}, request);
          CHECK(finite(p));
          CHECK(p.stats.nonfinitePixels == 0);
        }
      }
}

TEST_CASE("inside a ball of glass light beyond the critical angle is reflected, not let through", "[glass]") {
  Stage stage;
  Scene scene;
  place(scene, box({-5, -5, -5}, {5, 5, 5}, true), shining({0, 1, 0}));
  Material m = glassOf(1.5f, 2);
  m.twoSided = true;
  place(scene, quad({0, 0, 0}, {-4, 0, 0}, {0, 4, 0}), m, turned(0));  // seen from behind: the eye is in the glass
  // The critical angle is 41.8 degrees.
  const auto through = [&](double degrees) {
    const double a = degrees * kPi / 180;
    const View view = lookAt({0, 0, 2}, {2 * std::tan(a), 0, 0}, {0, 1, 0}, 1.6f);  // wide: what leaves the picture finds no surroundings, which are black
    return stage.linear(scene, view, {9, 9}).at(4, 4).y;
  };
  CHECK(through(10) == Approx(0.96).epsilon(0.01));
  CHECK(through(35) > 0.8);
  CHECK(through(46) < 1e-3);
}

TEST_CASE("forward and deferred agree on glass, in every place of several views", "[glass]") {
  Stage stage;
  Workshop w;
  w.scene.environment.background = true;
  w.setMaterial([](Material&) {});
  Material amber = glassOf(1.5f, 0.7f);
  amber.attenuationColor = {0.9f, 0.6f, 0.2f};
  amber.attenuationDistance = 0.4f;
  place(w.scene, sphere(0.35f, 48, 96), amber, translation({0.1, 0.1, 1.3}));
  place(w.scene, quad({-0.9f, 0, 1.5f}, {0.3f, 0, 0.1f}, {0, 0.5f, 0}), glassOf(1.5f, 0, 0.3f));
  const Picture deferred = stage.linear(w.scene, w.view, kSize), forward = stage.linear(w.scene, w.view, kSize, onPath(Path::Forward));
  double mean = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) mean += forward.at(x, y).y / (kSize.x * kSize.y);
  const Errors e = difference(deferred, forward, 0.02 * mean);
  CAPTURE(e.largest, mean, e.share());
  CHECK(e.share() > 0.98);
  CHECK(e.largest < 0.3 * mean);
  RenderRequest request;
  request.output = Output::Linear;
  View left = w.view, right = lookAt({-1.5, 1, 3.5}, {0, 0, 0});
  left.viewport = right.viewport = {0, 0, 50, 40};
  const Picture a = stage.draw(w.scene, {&left, 1}, kSize, {}, request), b = stage.draw(w.scene, {&right, 1}, kSize, {}, request);
  left.viewport = {4, 8, 50, 40};
  right.viewport = {62, 22, 50, 40};
  const View views[] = {left, right};
  const Picture both = stage.draw(w.scene, views, kSize, {}, request);
  Errors apart;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 50; ++x) {
      apart.add(largest(both.at(4 + x, kSize.y - 8 - 40 + y) - a.at(x, kSize.y - 40 + y)), 0.02 * mean);
      apart.add(largest(both.at(62 + x, kSize.y - 22 - 40 + y) - b.at(x, kSize.y - 40 + y)), 0.02 * mean);
    }
  // Rays that graze an edge of the depth buffer may end on either side of it.
  CHECK(apart.share() > 0.99);
}

TEST_CASE("what glass takes follows from what it is", "[glass]") {
  const View view = lookAt({0, 0, 4}, {0, 0, 0});
  const auto planFor = [&](const Mesh& mesh, const Material& material) {
    Scene scene;
    place(scene, quad({0, 0, -2}, {9, 0, 0}, {0, 9, 0}), shining(vec3(1)));
    place(scene, mesh, material);
    return makePlan(scene, {&view, 1}, {}, Capabilities{}, {.size = {256, 256}});
  };
  const Mesh pane = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  CHECK(planFor(pane, glassOf(1.5f, 0)).target("scene_color") == nullptr);
  REQUIRE(planFor(pane, glassOf(1.5f, 0.1f)).target("scene_color") != nullptr);
  CHECK(planFor(pane, glassOf(1.5f, 0.1f)).target("scene_color")->levels == 1);
  CHECK(planFor(pane, glassOf(1.5f, 0, 0.3f)).target("scene_color")->levels > 4);
  CHECK(planFor(sphere(1, 16, 32), glassOf(1.5f, 2)).target("scene_color")->levels > 4);
  const FramePlan none = planFor(pane, Material{});
  CHECK(!none.on("glass"));
  CHECK(none.pass("transparent") == nullptr);
  for (const ProgramPlan& p : none.programs) CHECK(p.name.find("transparent") == std::string::npos);
  Material unlit = glassOf(1.5f, 0);
  unlit.unlit = true;
  CHECK(!planFor(pane, unlit).on("glass"));
}

}  // namespace burnish::test
