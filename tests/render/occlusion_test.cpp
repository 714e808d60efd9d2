// Screen-space ambient occlusion against analytic scenes in double, and what it must leave alone (H22): a lone plane, the sky, far things behind near ones, other views.
//
// What it stands for: 1 - 1/pi ∫ w(t) cos over the hemisphere, t the distance to what a direction meets, w = clamp(4/3 (1 - t²/R²)): occluders count in full up to half the radius R.
// R is Quality::occlusionRadius, held at a sixth of the view's height on the screen.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "render/workshop.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr Occlusion kScreen[] = {Occlusion::Screen4, Occlusion::Screen8, Occlusion::Screen16};
std::string_view nameOf(Occlusion o) {
  for (const Term& t : terms())
    if (t.name == "occlusion") return t.rungs[std::size_t(o)].name;
  return {};
}

Quality with(Occlusion rung, float radius = 1) {
  Quality q;
  q.occlusion = rung;
  q.occlusionRadius = radius;
  return q;
}

/// The debug view shows occlusion as it is, one byte.
Picture occlusionOf(Stage& stage, const Scene& scene, std::span<const View> views, glm::ivec2 size, const Quality& quality) {
  RenderRequest request;
  request.debugView = DebugView::Occlusion;
  return stage.draw(scene, views, size, quality, request);
}
Picture occlusionOf(Stage& stage, const Scene& scene, const View& view, glm::ivec2 size, const Quality& quality) { return occlusionOf(stage, scene, {&view, 1}, size, quality); }

/// Distance to what a ray meets, or a negative number.
using Hit = std::function<double(dvec3 origin, dvec3 direction)>;
double toPlane(dvec3 o, dvec3 d, dvec3 n, double height) {
  const double nd = glm::dot(n, d);
  return nd < 0 ? (height - glm::dot(n, o)) / nd : -1;
}
double toSphere(dvec3 o, dvec3 d, dvec3 c, double r) {
  const dvec3 s = o - c;
  const double b = glm::dot(s, d), e = b * b - glm::dot(s, s) + r * r;
  return e < 0 ? -1 : -b - std::sqrt(e);
}

/// The integral by 48 x 96 cells of equal cosine-weighted measure.
double visibility(dvec3 p, dvec3 n, double radius, const Hit& hit) {
  const dvec3 side = std::abs(n.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0), t = glm::normalize(glm::cross(side, n)), b = glm::cross(n, t);
  constexpr int kRings = 48, kSectors = 96;
  double lost = 0;
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kSectors; ++j) {
      const double sin2 = (i + 0.5) / kRings, phi = 2 * kPi * (j + 0.5) / kSectors, s = std::sqrt(sin2);
      const double d = hit(p + n * 1e-9, t * (s * std::cos(phi)) + b * (s * std::sin(phi)) + n * std::sqrt(1 - sin2));
      if (d >= 0) lost += std::clamp((1 - d * d / (radius * radius)) * 4 / 3, 0.0, 1.0);
    }
  return 1 - lost / (kRings * kSectors);
}

/// The radius in force at a point.
double heldRadius(const View& view, glm::ivec2 size, dvec3 p, double radius) {
  const double depth = -glm::dot(p - view.eye, view.axes[2]);
  const double pixel = view.orthographic ? view.height / size.y : 2 * std::tan(double(view.fovY) / 2) / size.y * depth;
  return std::min(radius, pixel * size.y / 6.0);
}

struct Point {
  dvec3 p, n;
};
/// What a pixel shows: position and normal, or nothing that is to be compared.
using Shown = std::function<std::optional<Point>(const Ray&)>;

struct Accuracy {
  double mean = 0, most = 0;  ///< of |error|: the mean, and what 98 % of pixels keep under
  double bias = 0;
  std::size_t count = 0;
};
Accuracy accuracy(const Picture& picture, const View& view, glm::ivec2 size, double radius, const Shown& shown, const Hit& hit) {
  std::vector<double> errors;
  double sum = 0;
  for (int y = 2; y < size.y - 2; ++y)
    for (int x = 2; x < size.x - 2; ++x) {
      const auto point = shown(rayThrough(view, size, x + 0.5, y + 0.5));
      if (!point) continue;
      const double e = picture.at(x, y).x - visibility(point->p, point->n, heldRadius(view, size, point->p, radius), hit);
      errors.push_back(std::abs(e));
      sum += e;
    }
  std::sort(errors.begin(), errors.end());
  Accuracy a;
  a.count = errors.size();
  REQUIRE(a.count > 100);
  for (double e : errors) a.mean += e / double(a.count);
  a.most = errors[a.count * 98 / 100];
  a.bias = sum / double(a.count);
  return a;
}
void say(std::string_view what, Occlusion rung, const Accuracy& a) {
  std::cout << fmt::format("  {:<34} {:<10} off by {:.4f} on the mean, by {:.4f} at most on 98 % of {} pixels, bias {:+.4f}\n", what, nameOf(rung), a.mean, a.most, a.count, a.bias);
}

Material matte() {
  Material m;
  m.albedo = vec3(0.8f);
  return m;
}
View parallel(View view, float height) {
  view.orthographic = true;
  view.height = height;
  view.far = 50;
  return view;
}

/// Axis-aligned planes through the origin that face +x, +y, +z: as many as asked for.
struct Corner {
  Scene scene;
  std::vector<dvec3> normals;
  explicit Corner(int planes) {
    const vec3 axes[] = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    for (int i = 0; i < planes; ++i) {
      const vec3 n = axes[i], u = axes[(i + 1) % 3] * 20.0f, v = axes[(i + 2) % 3] * 20.0f;
      normals.emplace_back(n);
      const vec3 facing = glm::cross(u, v);
      // Each plane ends where the next begins.
      vec3 center(0);
      for (int j = 0; j < planes; ++j)
        if (j != i) center += axes[j] * 20.0f;
      place(scene, glm::dot(facing, n) > 0 ? quad(center, u, v) : quad(center, v, u), matte());
    }
  }
  [[nodiscard]] Hit hit() const {
    return [n = normals](dvec3 o, dvec3 d) {
      double nearest = -1;
      for (const dvec3& normal : n) {
        if (glm::dot(normal, o) < 1e-6) continue;
        const double t = toPlane(o, d, normal, 0);
        if (t >= 0 && (nearest < 0 || t < nearest)) nearest = t;
      }
      return nearest;
    };
  }
  [[nodiscard]] Shown shown() const {
    return [n = normals](const Ray& r) -> std::optional<Point> {
      double nearest = 1e9;
      dvec3 facing(0);
      for (const dvec3& normal : n)
        if (const double t = toPlane(r.origin, r.direction, normal, 0); t >= 0 && t < nearest) nearest = t, facing = normal;
      if (nearest > 15) return std::nullopt;
      return Point{r.origin + r.direction * nearest, facing};
    };
  }
};

}  // namespace

TEST_CASE("screen occlusion: the integral that it is held against", "[occlusion]") {
  // Nothing fades: closed forms. On the floor of a corner of two planes half is lost, near three planes three quarters; under a sphere its form factor (r/d)² h/d.
  CHECK(visibility({0, 0, 1e-3}, {0, 1, 0}, 1e9, Corner(2).hit()) == Approx(0.5).margin(0.005));
  CHECK(visibility({1e-3, 0, 1e-3}, {0, 1, 0}, 1e9, Corner(3).hit()) == Approx(0.25).margin(0.02));
  for (double x : {0.3, 1.0, 2.0}) {
    const double d = std::hypot(x, 0.5), factor = 0.25 / (d * d) * 0.5 / d;
    CHECK(visibility({x, 0, 0}, {0, 1, 0}, 1e9, [](dvec3 o, dvec3 v) { return toSphere(o, v, {0, 0.5, 0}, 0.5); }) == Approx(1 - factor).margin(0.005));
  }
  // A wall at distance d takes 1/pi (a - (d/R)² tan a), a = acos(d/R), of what lies within R; weights run from half of R to R.
  const auto within = [](double d, double r) { return d < r ? (std::acos(d / r) - d * d / (r * r) * std::tan(std::acos(d / r))) / kPi : 0; };
  double fading = 0;
  for (int i = 0; i < 1000; ++i) {
    const double r = (i + 0.5) / 1000;
    fading += within(0.3, r) * (r > 0.5 ? 8.0 / 3 * r : 0) / 1000;  // -w'(r): each shell's share
  }
  CHECK(visibility({0, 0, 0.3}, {0, 1, 0}, 1, Corner(2).hit()) == Approx(1 - fading).margin(0.005));
}

TEST_CASE("screen occlusion: corners of two and three planes", "[occlusion][sweep]") {
  Stage stage;
  constexpr glm::ivec2 size{96, 96};
  const double bounds[3][2] = {{0.04, 0.2}, {0.022, 0.13}, {0.013, 0.095}};  // mean, 98 %
  for (int planes : {2, 3}) {
    const Corner corner(planes);
    const View view = lookAt({1.6, 1.3, 1.9}, {0.25, 0.2, 0.2}, {0, 1, 0}, 0.9f);
    for (const View& v : {view, parallel(view, 2)})
      for (std::size_t i = 0; i < 3; ++i) {
        const Quality quality = with(kScreen[i], 0.5f);
        const Accuracy a = accuracy(occlusionOf(stage, corner.scene, v, size, quality), v, size, 0.5, corner.shown(), corner.hit());
        say(fmt::format("corner of {} planes{}", planes, v.orthographic ? ", orthographic" : ""), kScreen[i], a);
        CHECK(a.count > 8000);
        CHECK(a.mean < bounds[i][0]);
        CHECK(a.most < bounds[i][1]);
      }
  }
}

TEST_CASE("screen occlusion: a sphere on a plane", "[occlusion]") {
  // All of the sphere lies within half of the radius from what is compared, so that nothing fades: the plane keeps 1 - (r/d)² h/d.
  Stage stage;
  const double bounds[3][2] = {{0.125, 0.28}, {0.06, 0.18}, {0.04, 0.15}};  // mean, 98 %
  constexpr glm::ivec2 size{240, 240};
  constexpr double r = 0.12;
  Scene scene;
  place(scene, quad({0, 0, 0}, {0, 0, 20}, {20, 0, 0}), matte());
  place(scene, sphere(float(r), 96, 192), matte(), translation({0, r, 0}));
  const View view = lookAt({0.4, 4, 3.2}, {0, 0, 0}, {0, 1, 0}, 0.8f);
  for (const View& v : {view, parallel(view, 4.2f)})
    for (Occlusion rung : kScreen) {
      const Picture picture = occlusionOf(stage, scene, v, size, with(rung, 0.7f));
      std::vector<double> errors;
      Accuracy a;
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
          const Ray ray = rayThrough(v, size, x + 0.5, y + 0.5);
          const dvec3 p = ray.origin + ray.direction * toPlane(ray.origin, ray.direction, {0, 1, 0}, 0);
          // Behind the sphere the eye does not see what occludes.
          if (toSphere(ray.origin, ray.direction, {0, r, 0}, r * 1.02) >= 0 || glm::length(p) > 0.25 || p.z < 0) continue;
          CHECK(heldRadius(v, size, p, 0.7) > 0.6);
          const double d = glm::length(p - dvec3(0, r, 0)), e = picture.at(x, y).x - (1 - r * r * r / (d * d * d));
          errors.push_back(std::abs(e));
          a.bias += e;
        }
      a.count = errors.size();
      REQUIRE(a.count > 100);
      std::sort(errors.begin(), errors.end());
      for (double e : errors) a.mean += e / double(a.count);
      a.most = errors[a.count * 98 / 100];
      a.bias /= double(a.count);
      say(v.orthographic ? "sphere on a plane, orthographic" : "sphere on a plane", rung, a);
      CHECK(a.mean < bounds[std::size_t(rung) - std::size_t(kScreen[0])][0]);
      CHECK(a.most < bounds[std::size_t(rung) - std::size_t(kScreen[0])][1]);
    }
}

TEST_CASE("screen occlusion: a lone plane is not darkened at any angle", "[occlusion]") {
  Stage stage;
  constexpr glm::ivec2 size{72, 48};
  double worst = 1;
  for (double degrees : {0.0, 10.0, 35.0, 60.0, 75.0, 85.0, 89.0, 89.8})
    for (double turn : {0.0, 0.3, 0.9}) {
      Scene scene;
      place(scene, quad({0, 0, 0}, {0, 0, 3000}, {3000, 0, 0}), matte());
      const double a = degrees * kPi / 180;
      const dvec3 eye(4 * std::sin(a), 4 * std::cos(a), 0);
      const dvec3 up = glm::normalize(glm::cross(glm::cross(-eye, dvec3(std::sin(turn), std::cos(turn) * 0.5, std::cos(turn))), -eye));
      const View view = lookAt(eye, {0, 0, 0}, up, 0.7f);
      View far = view;
      far.far = 400;
      for (const View& v : {view, far, parallel(view, 3)})
        for (Occlusion rung : kScreen) {
          CAPTURE(degrees, turn, v.orthographic, nameOf(rung));
          const Picture p = occlusionOf(stage, scene, v, size, with(rung, 2));
          double least = 1;
          int count = 0;
          for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
              // A rasterizer moves vertices by up to 1/512 of a pixel, and a horizon with them.
              const auto depthAt = [&](double px, double py) {
                const Ray r = rayThrough(v, size, px, py);
                return -glm::dot(r.direction, v.axes[2]) * toPlane(r.origin, r.direction, {0, 1, 0}, 0);
              };
              const auto seen = [&](double depth) { return depth > 1.01 * v.near && depth < (v.far > 0 ? std::min(double(v.far), 1000.0) : 1000.0); };
              bool all = true;
              for (double dx : {-0.01, 0.01})
                for (double dy : {-0.01, 0.01}) all = all && seen(depthAt(x + 0.5 + dx, y + 0.5 + dy));
              if (all) least = std::min(least, p.at(x, y).x), ++count;
            }
          worst = std::min(worst, least);
          CHECK(least > 1 - 2.5 / 255);
          CHECK(count > 100);
        }
    }
  std::cout << fmt::format("  a lone plane keeps at least {:.4f}\n", worst);
}

TEST_CASE("screen occlusion: nothing bleeds from what is out of reach, from the sky or into another view (H22)", "[occlusion]") {
  Stage stage;
  constexpr glm::ivec2 size{96, 72};
  const View view = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.8f);
  const auto least = [](const Picture& p, int x0, int x1) {
    double value = 1;
    for (int y = 0; y < p.image.height; ++y)
      for (int x = x0; x < x1; ++x) value = std::min(value, p.at(x, y).x);
    return value;
  };
  Scene near;  // a panel before a wall three radii behind it, both wholly open
  place(near, quad({0, 0, -3}, {9, 0, 0}, {0, 9, 0}), matte());
  place(near, quad({0, 0, 0}, {0.7f, 0, 0}, {0, 0.7f, 0}), matte());
  place(near, quad({-1.2f, 0.9f, 0.5f}, {0.01f, 0, 0}, {0, 0.9f, 0}), matte());
  for (Occlusion rung : kScreen)
    for (const View& v : {view, parallel(view, 3)}) CHECK(least(occlusionOf(stage, near, v, size, with(rung)), 0, size.x) > 1 - 2.5 / 255);
  Scene sky;  // a ball before the sky: convex, so that all of it is open, its silhouette too
  place(sky, sphere(1, 128, 256), matte());
  const Picture ball = occlusionOf(stage, sky, view, size, with(Occlusion::Screen16));
  double darkest = 1;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const Ray r = rayThrough(view, size, x + 0.5, y + 0.5);
      if (toSphere(r.origin, r.direction, {0, 0, 0}, 0.999) > 0) darkest = std::min(darkest, ball.at(x, y).x);
    }
  std::cout << fmt::format("  a ball before the sky keeps at least {:.4f}\n", darkest);
  CHECK(darkest > 0.98);
  // Two views side by side: the same bytes as each alone, though the other's depth borders on it.
  const Corner corner(3);
  View left = lookAt({1.6, 1.3, 1.9}, {0.25, 0.2, 0.2}, {0, 1, 0}, 0.9f), right = parallel(lookAt({3, 0.6, 0.9}, {0, 0.3, 0.4}), 1.2f);
  constexpr glm::ivec2 half{48, 72};
  const Picture leftAlone = occlusionOf(stage, corner.scene, left, half, with(Occlusion::Screen8)), rightAlone = occlusionOf(stage, corner.scene, right, half, with(Occlusion::Screen8));
  left.viewport = {0, 0, 48, 72};
  right.viewport = {48, 0, 48, 72};
  const View both[] = {left, right};
  const Picture p = occlusionOf(stage, corner.scene, both, size, with(Occlusion::Screen8));
  int differing = 0;
  for (int y = 0; y < 72; ++y)
    for (int x = 0; x < 48; ++x) differing += glm::length(p.at(x, y) - leftAlone.at(x, y)) > 1.1 / 255 || glm::length(p.at(x + 48, y) - rightAlone.at(x, y)) > 1.1 / 255;
  CHECK(differing <= 2);
  CHECK(least(leftAlone, 0, 48) < 0.6);
}

TEST_CASE("screen occlusion: finite at every size and in hard places; the same picture each time", "[occlusion]") {
  Stage stage;
  const Workshop w;
  const View inside = lookAt({0, -0.84, 1.9}, {0, -0.849, 0}, {0, 1, 0}, 2.6f);  // grazing along the floor, wide
  RenderRequest request;
  request.output = Output::Linear;
  request.countNonfinite = true;
  for (glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(3, 2), glm::ivec2(17, 33), glm::ivec2(96, 64)})
    for (const View& v : {w.view, inside, parallel(w.view, 2.6f)})
      for (float radius : {0.0f, 1e-3f, 1.0f, 1e6f, std::numeric_limits<float>::quiet_NaN()}) {
        const Quality quality = with(Occlusion::Screen8, radius);
        const Picture a = stage.draw(w.scene, {&v, 1}, size, quality, request);
        CHECK(a.stats.nonfinitePixels == 0);
        CHECK(same(a, stage.draw(w.scene, {&v, 1}, size, quality, request)));
      }
}

TEST_CASE("screen occlusion: what calls for it, and what it darkens", "[occlusion]") {
  Stage stage;
  constexpr glm::ivec2 size{64, 64};
  Corner corner(2);
  const View view = lookAt({0.3, 1, 1.4}, {0, 0.1, 0.1}, {0, 1, 0}, 0.8f);
  const auto planOf = [&](const Quality& quality) {
    PlanOptions options;
    options.size = size;
    return makePlan(corner.scene, {&view, 1}, quality, Capabilities{}, options);
  };
  const auto absent = [&](const FramePlan& plan) {
    CHECK(!plan.on("screen_occlusion"));
    CHECK((!plan.target("occlusion") && !plan.target("occlusion_raw") && !plan.pass("occlusion") && !plan.pass("occlusion_denoise")));
  };
  absent(planOf(with(Occlusion::Screen8)));  // no light that it could hold back
  corner.scene.environment.color = vec3(1);
  absent(planOf(with(Occlusion::Baked)));
  absent(planOf(with(Occlusion::None)));
  Quality forward = with(Occlusion::Screen8);
  forward.path = Path::Forward;
  absent(planOf(forward));
  const FramePlan on = planOf(with(Occlusion::Screen8));
  CHECK(on.on("screen_occlusion"));
  CHECK(!on.on("baked_occlusion"));
  CHECK(on.target("occlusion")->format == "R8");
  // Ambient diffuse light is multiplied by it.
  Quality quality = with(Occlusion::Screen8), open = with(Occlusion::Baked);
  quality.environmentSpecular = open.environmentSpecular = EnvironmentSpecular::None;
  const Picture lit = stage.linear(corner.scene, view, size, quality), unoccluded = stage.linear(corner.scene, view, size, open), map = occlusionOf(stage, corner.scene, view, size, quality);
  double worst = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      if (unoccluded.at(x, y).x > 0) worst = std::max(worst, std::abs(lit.at(x, y).x / unoccluded.at(x, y).x - map.at(x, y).x));
  CHECK(worst < 1.1 / 255);
  // Baked occlusion where it is darker: on a lone plane it is all that there is.
  Scene scene;
  Workshop maps;
  const Texture occlusion = *maps.scene.textures.get(maps.occlusion);
  Material m = matte();
  m.mapC = scene.textures.add(occlusion);
  place(scene, quad({0, 0, 0}, {0, 0, 2}, {2, 0, 0}), m);
  const View above = lookAt({0, 2, 1}, {0, 0, 0});
  CHECK(difference(occlusionOf(stage, scene, above, size, with(Occlusion::Screen8)), occlusionOf(stage, scene, above, size, with(Occlusion::Baked)), 0).largest < 1.1 / 255);
}

TEST_CASE("screen occlusion: what is drawn over the picture neither takes it nor loses the light that it holds back elsewhere", "[occlusion]") {
  Stage stage;
  constexpr glm::ivec2 size{64, 64};
  Corner corner(2);
  corner.scene.environment.color = vec3(1);
  const View view = lookAt({0.3, 1, 1.4}, {0, 0.1, 0.1}, {0, 1, 0}, 0.8f);
  Material pane = matte();
  pane.blend = true;
  pane.albedo = {0.9f, 0.2f, 0.1f};
  place(corner.scene, quad({0.3f, 0.02f, 0.3f}, {0, 0, 0.2f}, {0.2f, 0, 0}), pane);  // over the floor, all of it covered
  const Picture screen = stage.linear(corner.scene, view, size, with(Occlusion::Screen8)), plain = stage.linear(corner.scene, view, size, with(Occlusion::Baked));
  CHECK(stage.renderer->lastPlan().on("alpha_blend"));
  int panes = 0, darker = 0;
  double worst = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const dvec3 a = screen.at(x, y), b = plain.at(x, y);
      if (b.x > 2 * b.y) {
        ++panes;
        worst = std::max(worst, glm::length(a - b) / glm::length(b));
      } else {
        darker += a.y < 0.95 * b.y;
      }
    }
  CHECK(worst < 1e-4);
  CHECK(panes > 100);
  CHECK(darker > 100);
}
