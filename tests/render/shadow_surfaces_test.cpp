// Which surfaces cast and receive: both paths, blended surfaces, holes, deformed and mirrored casters, those out of view; shadows that nothing calls for.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "render/deformed.h"
#include "render/shadowed.h"
#include "render/workshop.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{192, 128};
View viewOfYard() { return lookAt({1.5, 2.2, 5}, {-0.2, 0.3, 0}, {0, 1, 0}, 0.8f); }

void addLights(Scene& scene) {
  Light l = light(LightKind::Directional, vec3(1), 1000);
  l.castsShadow = true;
  addLight(scene, l, {0, 0, 0}, {0.8, -0.5, -0.3});
  l = light(LightKind::Spot, vec3(1, 0.5f, 0.2f), 900, 20);
  l.castsShadow = true;
  l.outerCone = 0.7f;
  addLight(scene, l, {-3, 3, 2}, {1, -1, -0.7});
  l = light(LightKind::Point, vec3(0.2f, 0.5f, 1), 500, 12);
  l.castsShadow = true;
  addLight(scene, l, {2.5, 1.5, 1.5});
  addLight(scene, light(LightKind::Point, vec3(1), 50, 6), {0, 1, 2});
}

double mean(const Picture& p) {
  double sum = 0;
  for (int y = 0; y < p.image.height; ++y)
    for (int x = 0; x < p.image.width; ++x) sum += p.at(x, y).y;
  return sum / double(p.image.pixelCount());
}
/// Shares of pixels that differ by more than `bound` of the brighter, 1 % of the mean aside.
double differing(const Picture& a, const Picture& b, double bound) {
  const double least = 0.01 * mean(a);
  int count = 0;
  for (int y = 0; y < a.image.height; ++y)
    for (int x = 0; x < a.image.width; ++x) {
      const dvec3 d = glm::abs(a.at(x, y) - b.at(x, y)), most = glm::max(a.at(x, y), b.at(x, y));
      count += !(std::max({d.x, d.y, d.z}) <= bound * std::max({most.x, most.y, most.z}) + least);
    }
  return double(count) / double(a.image.pixelCount());
}

Quality on(Path path, Shadow rung) {
  Quality q;
  q.path = path;
  q.shadow = rung;
  return q;
}

}  // namespace

TEST_CASE("deferred and forward have the same shadows", "[shadow][sweep]") {
  Stage stage;
  Yard yard;
  addLights(yard.scene);
  for (const Shadow rung : {Shadow::Tap, Shadow::Pcf, Shadow::Pcss}) {
    const Picture deferred = stage.linear(yard.scene, viewOfYard(), kSize, on(Path::Deferred, rung)), forward = stage.linear(yard.scene, viewOfYard(), kSize, on(Path::Forward, rung));
    REQUIRE(stage.renderer->lastPlan().on("shadows"));
    const Picture without = stage.linear(yard.scene, viewOfYard(), kSize, on(Path::Forward, Shadow::None));
    const double apart = differing(deferred, forward, 0.02), changed = differing(without, forward, 0.02);
    std::cout << fmt::format("  rung {}: {:.3f} % of pixels differ by more than 2 % between the paths; shadows change {:.1f} %\n", int(rung), 100 * apart, 100 * changed);
    CHECK(apart < 0.01);
    CHECK(changed > 0.05);  // there is something to compare
  }
}

TEST_CASE("blended surfaces receive shadows as opaque ones do", "[shadow]") {
  Stage stage;
  Yard yard;
  addLights(yard.scene);
  const Picture opaque = stage.linear(yard.scene, viewOfYard(), kSize);
  Material m = *yard.scene.materials.get(yard.scene.instances.get(yard.floor)->material);
  m.blend = true;
  yard.scene.instances.edit(yard.floor)->material = yard.scene.materials.add(m);
  const Picture blended = stage.linear(yard.scene, viewOfYard(), kSize);
  REQUIRE(stage.renderer->lastPlan().on("alpha_blend"));
  CHECK(differing(opaque, blended, 0.02) < 0.01);
  const Picture none = stage.linear(yard.scene, viewOfYard(), kSize, on(Path::Deferred, Shadow::None));
  CHECK(differing(none, blended, 0.02) > 0.1);
}

TEST_CASE("holes of alpha-tested casters let light through", "[shadow]") {
  Stage stage;
  for (const bool general : {false, true}) {
    Scene scene;
    Material m;
    m.albedo = vec3(0.5f);
    m.roughness = 1;
    place(scene, quad({0, 0, 0}, {0, 0, 4}, {4, 0, 0}), m);
    Material holed = m;
    // Opaque where u < 1/2.
    holed.mapC = scene.textures.add(painted(MapKind::Occlusion, 64, [](float u, float) { return vec4(1, u < 0.5f ? 1 : 0, 0, 0); }));
    holed.alphaTest = true;
    if (general) holed.uvC.transform = {-1, 0, 0, 1, 1, 0};  // the other half
    place(scene, quad({0, 1.5f, 0}, {0, 0, 1}, {1, 0, 0}), holed);
    Light l = light(LightKind::Directional, vec3(1), 1000);
    l.castsShadow = true;
    addLight(scene, l, {0, 0, 0}, {0, -1, 0});
    const View view = lookAt({0, 0.9, 6}, {0, 0, 0}, {0, 1, 0}, 0.6f);
    const Picture with = stage.linear(scene, view, kSize), without = stage.linear(scene, view, kSize, on(Path::Deferred, Shadow::None));
    int judged = 0, wrong = 0;
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) {
        const Ray r = rayThrough(view, kSize, x + 0.5, y + 0.5);
        const dvec3 plate = r.origin + r.direction * ((1.5 - r.origin.y) / r.direction.y), p = r.origin - r.direction * (r.origin.y / r.direction.y);
        if (r.direction.y > 0 || std::abs(p.x) > 3 || std::abs(p.z) > 3) continue;
        if (plate.z < r.origin.z && std::abs(plate.x) < 1.1 && std::abs(plate.z) < 1.1) continue;
        // u runs along the first half-vector, +z.
        const bool inside = std::abs(p.x) < 1 && std::abs(p.z) < 1, dark = inside && (general ? p.z > 0 : p.z < 0);
        if (std::abs(std::abs(p.x) - 1) < 0.05 || std::abs(std::abs(p.z) - 1) < 0.05 || std::abs(p.z) < 0.05) continue;
        ++judged;
        wrong += (with.at(x, y).y < 0.5 * without.at(x, y).y) != dark;
      }
    CHECK(judged > 3000);
    CHECK(wrong == 0);
  }
}

TEST_CASE("a deformed caster out of view casts the shadow of its pose, again when it moves", "[shadow]") {
  Arm arm(4, {-1.5, 1.2, 0});
  Material m;
  m.albedo = vec3(0.5f);
  m.roughness = 1;
  place(arm.scene, quad({0, 0, -4}, {0, 0, 4}, {8, 0, 0}), m);
  Light l = light(LightKind::Directional, vec3(1), 1000);
  l.castsShadow = true;
  addLight(arm.scene, l, {0, 0, 0}, {0, -0.45, -1});
  // The floor alone, in front of which the arm stands.
  const View view = lookAt({0, 2.6, -0.8}, {0, 0, -3}, {0, 1, 0}, 0.9f);
  Stage stage;
  const auto compare = [&] {
    const Picture bent = stage.linear(arm.scene, view, kSize);
    const FrameStats stats = bent.stats;
    const FramePlan plan = stage.renderer->lastPlan();
    CHECK(plan.pass("deform") == nullptr);  // nothing deformed is in view
    CHECK(plan.on("deformation"));
    Scene rigid = arm.scene;
    Instance& i = *rigid.instances.edit(arm.instance);
    i.mesh = rigid.meshes.add(frozen(arm.scene, arm.row()));
    i.skin = {};
    i.node = addNode(rigid, glm::dmat4(1));
    Stage other;
    const Picture wanted = other.linear(rigid, view, kSize), none = other.linear(rigid, view, kSize, on(Path::Deferred, Shadow::None));
    CHECK(differing(bent, wanted, 0.02) < 0.002);
    CHECK(differing(none, wanted, 0.02) > 0.01);
    return stats;
  };
  CHECK(compare().shadowMapsDrawn > 0);
  CHECK(compare().shadowMapsDrawn == 0);
  arm.turn(1, 0.7);
  CHECK(compare().shadowMapsDrawn > 0);
}

TEST_CASE("casters in a crowd, mirrored and seen from behind cast as each alone would", "[shadow]") {
  Stage stage;
  const auto sceneOf = [](bool shared) {
    Scene scene;
    Material m;
    m.albedo = vec3(0.5f);
    m.roughness = 1;
    place(scene, quad({0, 0, 0}, {0, 0, 6}, {6, 0, 0}), m);
    const Id<Material> material = scene.materials.add(m);
    const Mesh post = box({-0.05f, 0, -0.05f}, {0.05f, 1, 0.05f}, true);  // its faces look inward
    const Id<Mesh> mesh = scene.meshes.add(post);
    for (int i = 0; i < 20; ++i) {
      glm::dmat4 at = translation({-2 + 0.4 * (i % 10), 0, i < 10 ? -0.6 : 0.4});
      if (i % 3 == 0) at[0][0] = -1;
      Instance p;
      p.mesh = shared ? mesh : scene.meshes.add(post);
      p.material = material;
      p.node = addNode(scene, at);
      scene.instances.add(p);
    }
    Light l = light(LightKind::Directional, vec3(1), 1000);
    l.castsShadow = true;
    addLight(scene, l, {0, 0, 0}, {0.3, -0.7, -0.5});
    return scene;
  };
  const Picture crowd = stage.linear(sceneOf(true), viewOfYard(), kSize), each = stage.linear(sceneOf(false), viewOfYard(), kSize);
  CHECK(same(crowd, each));
  CHECK(crowd.stats.shadowDraws < each.stats.shadowDraws / 4);
  const Picture none = stage.linear(sceneOf(true), viewOfYard(), kSize, on(Path::Deferred, Shadow::None));
  CHECK(differing(crowd, none, 0.02) > 0.03);
}

TEST_CASE("shadows that no light casts change nothing, forced or taken off the list", "[shadow]") {
  Workshop w;
  RendererOptions forced, removed;
  forced.forcedEffects = {"shadows"};
  removed.removedEffects = {"shadows"};
  Stage a(forced), b(removed), c;
  const Picture usual = c.display(w.scene, w.view, kSize), with = a.display(w.scene, w.view, kSize), without = b.display(w.scene, w.view, kSize);
  CHECK(same(usual, with));
  CHECK(same(usual, without));
  // Taken off the list where lights do cast: as with shadow=none.
  Yard yard;
  addLights(yard.scene);
  CHECK(same(b.linear(yard.scene, viewOfYard(), kSize), c.linear(yard.scene, viewOfYard(), kSize, on(Path::Deferred, Shadow::None))));
  CHECK(!same(b.linear(yard.scene, viewOfYard(), kSize), c.linear(yard.scene, viewOfYard(), kSize)));
}

TEST_CASE("shadows keep a sun out of a closed room, whichever way its walls face", "[shadow]") {
  Stage stage;
  for (const bool inside : {false, true}) {
    Scene scene;
    Material m;
    m.albedo = vec3(0.5f);
    m.roughness = 1;
    m.twoSided = true;
    place(scene, box({-3, 0, -3}, {3, 3, 3}, inside), m);
    Light l = light(LightKind::Directional, vec3(1), 1000);
    l.castsShadow = true;
    addLight(scene, l, {0, 0, 0}, {0.4, -0.8, -0.3});
    const View view = lookAt({0, 1.5, 2}, {0, 1, -3}, {0, 1, 0}, 1.2f);
    const Picture p = stage.linear(scene, view, kSize), bare = stage.linear(scene, view, kSize, on(Path::Deferred, Shadow::None));
    double leak = 0;
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) leak += p.at(x, y).y > 0.5 * bare.at(x, y).y && bare.at(x, y).y > 1;
    std::cout << fmt::format("  walls that face {}: {:.3f} % of pixels leak\n", inside ? "inward" : "outward", 100 * leak / (kSize.x * kSize.y));
    CHECK(mean(bare) > 10);
    CHECK(leak / (kSize.x * kSize.y) < 0.005);
  }
}
