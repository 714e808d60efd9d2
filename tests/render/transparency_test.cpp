// H25: blended surfaces are lit as opaque ones are, what is behind them counts by the closed form, and they come in the right order at every pixel.
#include <catch2/catch.hpp>

#include "render/transparent.h"

namespace burnish::test {
namespace {

constexpr glm::ivec2 kSize{96, 72};

/// A pane that has no light of its own, adds `color · opacity` and lets the rest through: the analytic colour of the order tests.
Material veil(vec3 color, float opacity) {
  Material m = shining(vec3(0));
  m.albedo = color;
  m.blend = m.twoSided = true;
  m.opacity = opacity;
  return m;
}

/// A wall of known radiance behind everything.
void addWall(Scene& scene, vec3 radiance, float z = -3) { place(scene, quad({0, 0, z}, {20, 0, 0}, {0, 20, 0}), shining(radiance)); }

/// What is not finite is larger than anything.
double largest(const dvec3& v) {
  const double sum = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
  return sum < 1e300 ? std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) : 1e300;
}

}  // namespace

TEST_CASE("a blended surface with opacity 1 is the opaque surface, for every light and the surroundings", "[transparency][sweep]") {
  Stage stage;
  struct Lit {
    const char* name;
    std::function<bool(const Light&)> keep;
    bool environment;
  };
  const Lit lit[] = {{"directional", [](const Light& l) { return l.kind == LightKind::Directional; }, false},
                     {"point", [](const Light& l) { return l.kind == LightKind::Point; }, false},
                     {"spot", [](const Light& l) { return l.kind == LightKind::Spot; }, false},
                     {"surroundings", [](const Light&) { return false; }, true},
                     {"all", [](const Light&) { return true; }, true}};
  for (const Lit& l : lit) {
    CAPTURE(l.name);
    Workshop w;
    w.scene.lights.each([&](Id<Light> id, const Light& light) { w.scene.lights.edit(id)->enabled = l.keep(light); });
    if (!l.environment) w.scene.environment.scale = 0;
    const auto shape = [&](bool blend) {
      return [&w, blend](Material& m) {
        m.mapA = w.albedo;
        m.mapB = w.normals;
        m.mapC = w.occlusion;
        m.uvC.set = 1;  // kept apart from map B, so that both draw the same maps
        m.emission = {0.2f, 0.1f, 0.3f};
        m.blend = blend;
      };
    };
    // Map C covers nothing in places: not here.
    Texture* c = w.scene.textures.edit(w.occlusion);
    for (std::size_t i = 0; i < c->image.pixelCount(); ++i) c->image.u8()[4 * i + 1] = 255;
    w.setMaterial(shape(false));
    const Picture opaque = stage.linear(w.scene, w.view, kSize, onPath(Path::Forward)), packed = stage.linear(w.scene, w.view, kSize);
    w.setMaterial(shape(true));
    for (Path path : {Path::Forward, Path::Deferred}) {
      const Picture blended = stage.linear(w.scene, w.view, kSize, onPath(path));
      CHECK(stage.renderer->lastPlan().on("alpha_blend"));
      double mean = 0, worst = 0, off = 0;
      for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x) {
          mean += largest(opaque.at(x, y)) / (kSize.x * kSize.y);
          // The plain sphere is opaque in both: it goes through the G-buffer on the deferred path.
          const dvec3 a = blended.at(x, y), b = opaque.at(x, y), d = packed.at(x, y);
          const double e = std::min(largest(a - b), path == Path::Deferred ? largest(a - d) : 1e30) / (largest(b) + 0.01);
          worst = std::max(worst, e);
          off += e > 1e-4;
        }
      CAPTURE(mean, worst);
      CHECK(mean > 0.05);
      CHECK(worst < 0.02);  // a pixel on an edge
      CHECK(off / (kSize.x * kSize.y) < 0.002);
    }
  }
}

TEST_CASE("what is behind a blended surface counts by 1 - opacity of what the surface does not reflect", "[transparency]") {
  Stage stage;
  const dvec3 wall(3, 2, 1);
  for (float opacity : {0.0f, 0.3f, 1.0f})
    for (Path path : {Path::Deferred, Path::Forward}) {
      Scene scene;
      addWall(scene, vec3(wall));
      Material m;
      m.blend = true;
      m.opacity = opacity;
      m.roughness = 0.05f;
      place(scene, quad({0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}), m);
      const Picture p = stage.linear(scene, lookAt({0, 0, 3}, {0, 0, 0}), kSize, onPath(path));
      CHECK(largest(p.at(48, 36) - wall * double((1 - opacity) * 0.96f)) < 3e-3);
      CHECK(largest(p.at(4, 36) - wall) < 1e-5);
    }
}

TEST_CASE("reflections of a blended surface keep their strength at any opacity, and coverage takes the whole surface away", "[transparency]") {
  Stage stage;
  Scene scene;
  Material m;
  m.blend = true;
  m.albedo = vec3(0.5f);
  m.roughness = 0.3f;
  const Id<Instance> pane = place(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), m);
  const Id<Material> id = scene.instances.get(pane)->material;
  addLight(scene, light(LightKind::Directional, vec3(1), 10), {}, {0, 0, -1});
  const View view = lookAt({0, 0, 3}, {0, 0, 0});
  double beside = 0;
  const auto radiance = [&](float opacity) {
    scene.materials.edit(id)->opacity = opacity;
    const Picture p = stage.linear(scene, view, kSize);
    beside = p.at(56, 36).x;
    return p.at(48, 36).x;
  };
  const double none = radiance(0), half = radiance(0.5f), all = radiance(1);
  CHECK(none > 1);  // the highlight
  CHECK(half - none == Approx(0.5 * (all - none)).epsilon(1e-4));
  CHECK(all - none == Approx(10 * 0.5 / kPi * 0.96).epsilon(0.05));
  Texture holes = painted(MapKind::Occlusion, 8, [](float u, float) { return vec4(1, u < 0.5f ? 0.0f : 1.0f, 0, 0); });
  holes.sampler.magnifyLinear = false;
  scene.materials.edit(id)->mapC = scene.textures.add(holes);
  addWall(scene, vec3(2));
  const Picture p = stage.linear(scene, view, kSize);
  CHECK(p.at(40, 36) == dvec3(2, 2, 2));
  CHECK(p.at(56, 36).x == Approx(beside).epsilon(1e-3));
}

namespace {

/// Two unlit panes that cross on the z axis' line x = 0, and the colours to the left and right of it.
Scene crossing(vec3 a, vec3 b, float opacity) {
  Scene scene;
  addWall(scene, vec3(1), -4);
  place(scene, quad({0, 0, 0}, {0.8f, 0, 0.5f}, {0, 0.7f, 0}), veil(a, opacity));
  place(scene, quad({0, 0, 0}, {0.8f, 0, -0.5f}, {0, 0.7f, 0}), veil(b, opacity));
  return scene;
}

dvec3 over(const dvec3& front, const dvec3& behind, double opacity) { return front * opacity + behind * (1 - opacity); }

}  // namespace

TEST_CASE("two crossing panes are right on both sides of the line where they cross, from both sides", "[transparency]") {
  Stage stage;
  const vec3 a(0.9f, 0.1f, 0.1f), b(0.1f, 0.2f, 0.9f);
  const double o = 0.6;
  for (Path path : {Path::Deferred, Path::Forward})
    for (bool parallel : {false, true})
      for (double side : {1.0, -1.0}) {
        CAPTURE(parallel, side);
        Scene scene = crossing(a, b, float(o));
        if (side < 0) place(scene, quad({0, 0, 4}, {-20, 0, 0}, {0, 20, 0}), shining(vec3(1)));
        View view = lookAt({0, 0, 3 * side}, {0, 0, 0});
        view.orthographic = parallel;
        view.far = 50;
        const Picture p = stage.linear(scene, view, kSize, onPath(path));
        CHECK(stage.renderer->lastPlan().target("peel_a") != nullptr);
        // Pane a is nearer at x > 0 from the front (z grows with x), and at x < 0 from behind; the picture's right is x · side.
        const dvec3 aFirst = over(dvec3(a), over(dvec3(b), dvec3(1), o), o), bFirst = over(dvec3(b), over(dvec3(a), dvec3(1), o), o);
        int wrong = 0;
        for (int x = 34; x < 62; ++x) {
          const dvec3 expected = x >= 48 ? aFirst : bFirst;
          wrong += largest(p.at(x, 36) - expected) > 1e-3;
        }
        CHECK(wrong <= 1);  // the pixel on the line
      }
}

TEST_CASE("what an order holds for is not peeled; what overlaps itself is", "[transparency]") {
  const auto planFor = [](Scene& scene, const View& view) { return makePlan(scene, {&view, 1}, {}, Capabilities{}, {.size = {64, 64}}); };
  const View view = lookAt({0, 0, 5}, {0, 0, 0});
  const Material m = veil({1, 1, 1}, 0.5f);
  SECTION("one behind the other, crosswise to the view") {
    Scene scene;
    for (float z : {0.0f, 0.5f, 1.0f}) place(scene, quad({0, 0, z}, {0.5f, 0, 0}, {0, 0.5f, 0}), m);
    CHECK(planFor(scene, view).target("peel_a") == nullptr);
  }
  SECTION("parallel panes seen at an angle, whose distances overlap") {
    Scene scene;
    for (float z : {0.0f, 0.1f}) place(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), m, glm::dmat4(glm::dmat3({0.7, 0, 0.7}, {0, 1, 0}, {-0.7, 0, 0.7})) * translation({0, 0, z}));
    CHECK(planFor(scene, view).target("peel_a") == nullptr);
  }
  SECTION("side by side") {
    Scene scene;
    for (float x : {-0.8f, 0.8f}) place(scene, sphere(0.5f, 8, 16), m, translation({x, 0, 0}));
    CHECK(planFor(scene, view).target("peel_a") == nullptr);
  }
  SECTION("crossing") {
    Scene scene = crossing({1, 0, 0}, {0, 1, 0}, 0.5f);
    CHECK(planFor(scene, view).target("peel_a") != nullptr);
  }
  SECTION("a body that overlaps itself") {
    Scene scene;
    Mesh two = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const Mesh other = quad({0, 0, 1}, {1, 0, 0.3f}, {0, 1, 0});
    for (std::uint32_t i : other.indices) two.indices.push_back(i + 4);
    two.positions.insert(two.positions.end(), other.positions.begin(), other.positions.end());
    two.normals.insert(two.normals.end(), other.normals.begin(), other.normals.end());
    two.uv0.insert(two.uv0.end(), other.uv0.begin(), other.uv0.end());
    place(scene, two, m);
    CHECK(planFor(scene, view).target("peel_a") != nullptr);
  }
  SECTION("nothing transparent in view") {
    Scene scene;
    place(scene, sphere(0.5f, 8, 16), m, translation({0, 0, 40}));
    place(scene, sphere(0.5f, 8, 16), Material{});
    const FramePlan plan = planFor(scene, view);
    CHECK(!plan.on("alpha_blend"));
    CHECK(plan.pass("transparent") == nullptr);
  }
}

TEST_CASE("sorted panes and both sides of a sphere blend far to near", "[transparency]") {
  Stage stage;
  const vec3 colors[] = {{0.9f, 0.2f, 0.1f}, {0.1f, 0.8f, 0.2f}, {0.2f, 0.1f, 0.7f}};
  Scene scene;
  addWall(scene, vec3(1));
  // Placed in no order.
  for (int i : {1, 2, 0}) place(scene, quad({0, 0, 0.3f * float(i)}, {0.6f, 0, 0}, {0, 0.6f, 0}), veil(colors[i], 0.5f));
  place(scene, sphere(0.3f, 16, 32), veil({0.5f, 0.5f, 0}, 0.4f), translation({1.0, 0, 0}));
  const Picture p = stage.linear(scene, lookAt({0, 0, 3}, {0, 0, 0}), kSize);
  CHECK(stage.renderer->lastPlan().target("peel_a") == nullptr);
  dvec3 expected(1);
  for (const vec3& c : colors) expected = over(dvec3(c), expected, 0.5);
  CHECK(largest(p.at(48, 36) - expected) < 1e-5);
  const dvec3 twice = over({0.5, 0.5, 0}, over({0.5, 0.5, 0}, dvec3(1), 0.4), 0.4);
  CHECK(largest(p.at(48 + 26, 36) - twice) < 1e-5);
}

TEST_CASE("more layers than the limit: a warning, and nothing is lost", "[transparency]") {
  Stage stage;
  Scene scene;
  addWall(scene, vec3(1));
  Mesh stack;
  for (int i = 0; i < 6; ++i) {
    const Mesh q = quad({0, 0, 0.1f * float((i * 7) % 6)}, {0.8f, 0, 0.01f * float(i)}, {0, 0.8f, 0});
    for (std::uint32_t k : q.indices) stack.indices.push_back(k + std::uint32_t(stack.positions.size()));
    stack.positions.insert(stack.positions.end(), q.positions.begin(), q.positions.end());
    stack.normals.insert(stack.normals.end(), q.normals.begin(), q.normals.end());
    stack.uv0.insert(stack.uv0.end(), q.uv0.begin(), q.uv0.end());
  }
  place(scene, stack, veil({0, 0, 0}, 0.5f));
  const View view = lookAt({0, 0, 3}, {0, 0, 0});
  const auto warned = [&] {
    return std::any_of(stage.renderer->report().warnings().begin(), stage.renderer->report().warnings().end(), [](const Warning& w) { return w.place == "transparency"; });
  };
  Quality quality;
  CHECK(largest(stage.linear(scene, view, kSize, quality).at(48, 36) - dvec3(1.0 / 64)) < 1e-6);
  CHECK(!warned());
  quality.transparentLayers = 2;
  CHECK(largest(stage.linear(scene, view, kSize, quality).at(48, 36) - dvec3(1.0 / 64)) < 1e-6);
  CHECK(warned());
}

TEST_CASE("transparent surfaces in several views, at an offset, beside opaque ones in front", "[transparency]") {
  Stage stage;
  Scene scene = crossing({0.9f, 0.1f, 0.1f}, {0.1f, 0.2f, 0.9f}, 0.6f);
  place(scene, quad({0.3f, 0.2f, 1}, {0.2f, 0, 0}, {0, 0.2f, 0}), shining({0, 2, 0}));
  Quality quality;
  RenderRequest request;
  request.output = Output::Linear;
  View left = lookAt({0, 0, 3}, {0, 0, 0}), right = lookAt({1, 0.4, -2.5}, {0, 0, 0});
  const Picture a = stage.linear(scene, left, {40, 30}, quality), b = stage.linear(scene, right, {40, 30}, quality);
  left.viewport = {3, 5, 40, 30};
  right.viewport = {47, 9, 40, 30};
  const View views[] = {left, right};
  const Picture both = stage.draw(scene, views, kSize, quality, request);
  double worst = 0;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      worst = std::max(worst, largest(both.at(3 + x, kSize.y - 5 - 30 + y) - a.at(x, y)));
      worst = std::max(worst, largest(both.at(47 + x, kSize.y - 9 - 30 + y) - b.at(x, y)));
    }
  CHECK(worst < 1e-5);
  auto picked = stage.renderer->pick(scene, left, kSize, {3 + 10, 5 + 15});
  REQUIRE(picked);
  CHECK(scene.instances.get(*picked) != nullptr);
}

TEST_CASE("occlusion found on the screen leaves blended surfaces as they are", "[transparency]") {
  Stage stage;
  Scene scene = crossing({0.9f, 0.1f, 0.1f}, {0.1f, 0.2f, 0.9f}, 0.6f);
  Material m;
  m.blend = true;
  m.opacity = 0.5f;
  place(scene, sphere(0.3f, 16, 32), m, translation({1, 0.4, 0}));
  addLight(scene, light(LightKind::Directional, vec3(1), 10), {}, {0, 0, -1});
  scene.environment.color = vec3(1);
  const View view = lookAt({0, 0, 3}, {0, 0, 0});
  Quality screen;
  screen.occlusion = Occlusion::Screen4;
  const Picture a = stage.linear(scene, view, kSize), b = stage.linear(scene, view, kSize, screen);
  CHECK(stage.renderer->lastPlan().on("screen_occlusion"));
  CHECK(difference(a, b, 1e-4).largest < 1e-4);
}

TEST_CASE("a furnace: a blended surface never gives more than it gets", "[transparency]") {
  Stage stage;
  Scene scene;
  scene.environment.color = vec3(1);
  const Id<Instance> ball = place(scene, sphere(1, 32, 64), Material{});
  const Id<Material> id = scene.instances.get(ball)->material;
  for (float opacity : {0.0f, 0.5f, 1.0f})
    for (float substance : {0.02f, 1.0f / 3, 0.8f})
      for (float roughness : {0.1f, 0.6f, 1.0f}) {
        Material& m = *scene.materials.edit(id);
        m.blend = true;
        m.opacity = opacity;
        m.substance = substance;
        m.roughness = roughness;
        const Picture p = stage.linear(scene, lookAt({0, 0, 3}, {0, 0, 0}), kSize);
        double most = 0, least = 1e9;
        for (int y = 0; y < kSize.y; ++y)
          for (int x = 0; x < kSize.x; ++x) {
            most = std::max(most, largest(p.at(x, y)));
            least = std::min(least, p.at(x, y).x);
          }
        CAPTURE(opacity, substance, roughness);
        CHECK(most < 1.003);
        CHECK(least > (substance < 0.5f ? 0.8 : 0.4));
      }
}

}  // namespace burnish::test
