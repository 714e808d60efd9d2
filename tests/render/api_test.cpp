// The scene as a program changes it, picking, uploads, warm-up, views, and a plan that tells the truth.
#include <fmt/format.h>

#include <algorithm>

#include "render/scenes.h"

using namespace burnish;
using namespace burnish::test;

namespace {

Quality fixedQuality() {
  Quality q;
  q.exposureEv = 3.0f;
  return q;
}
Material colored(vec3 albedo) {
  Material m;
  m.albedo = albedo;
  return m;
}
Texture checker(std::uint8_t r, std::uint8_t g, std::uint8_t b, int size = 8) {
  Texture t;
  t.kind = MapKind::AlbedoSubstance;
  t.image = makeImage(size, size, 4, PixelType::U8);
  for (std::size_t i = 0; i < t.image.pixelCount(); ++i) {
    const std::uint8_t texel[4] = {r, g, b, 85};
    for (std::size_t c = 0; c < 4; ++c) t.image.data[i * 4 + c] = std::byte(texel[c]);
  }
  return t;
}

/// Two quads beside each other, facing the eye, in the light of a sun.
struct Pair {
  Scene scene;
  Id<Instance> left = place(scene, quad({-1, 0, 0}, {0.8f, 0, 0}, {0, 0.8f, 0}), colored({0.8f, 0.1f, 0.1f}));
  Id<Instance> right = place(scene, quad({1, 0, 0}, {0.8f, 0, 0}, {0, 0.8f, 0}), colored({0.1f, 0.8f, 0.1f}));
  Id<Light> sun = addLight(scene, light(LightKind::Directional, vec3(1), 50), {0, 0, 0}, {0, 0, -1});
  View view = lookAt({0, 0, 4}, {0, 0, 0});
  Node& node(Id<Instance> i) { return *scene.nodes.edit(scene.instances.get(i)->node); }
  Material& material(Id<Instance> i) { return *scene.materials.edit(scene.instances.get(i)->material); }
};
// Pixels of the two quads' middles in 96 × 64.
constexpr glm::ivec2 kSize{96, 64}, kLeft{31, 32}, kRight{64, 32};

/// A fresh renderer's picture: what an edited scene must look like.
Picture fresh(const Scene& scene, const View& view) {
  Stage stage;
  return stage.display(scene, view, kSize, fixedQuality());
}

}  // namespace

TEST_CASE("edits of a scene show in the next frame") {
  Pair p;
  Picture last;
  std::vector<Picture> frames;
  {
    Stage stage;
    const auto next = [&] { frames.push_back(stage.display(p.scene, p.view, kSize, fixedQuality())); return frames.back(); };
    last = next();
    CHECK(last.at(kLeft.x, kLeft.y).x > 2 * last.at(kLeft.x, kLeft.y).y);
    CHECK(last.at(kRight.x, kRight.y).y > 2 * last.at(kRight.x, kRight.y).x);

    p.node(p.left).local = translation({0, 1.8, 0});  // moved out of its pixel
    last = next();
    CHECK(last.at(kLeft.x, kLeft.y) == dvec3(0));
    CHECK(last.at(kLeft.x, 4).x > 0.1);
    p.node(p.left).local = glm::dmat4(1);

    p.material(p.left).albedo = {0.1f, 0.1f, 0.8f};
    last = next();
    CHECK(last.at(kLeft.x, kLeft.y).z > 2 * last.at(kLeft.x, kLeft.y).x);

    const Id<Texture> texture = p.scene.textures.add(checker(255, 255, 0));
    p.material(p.left).albedo = vec3(1);
    p.material(p.left).mapA = texture;
    last = next();
    CHECK(last.at(kLeft.x, kLeft.y).x > 2 * last.at(kLeft.x, kLeft.y).z);
    *p.scene.textures.edit(texture) = checker(0, 255, 255, 16);
    last = next();
    CHECK(last.at(kLeft.x, kLeft.y).z > 2 * last.at(kLeft.x, kLeft.y).x);

    *p.scene.meshes.edit(p.scene.instances.get(p.right)->mesh) = quad({1, 0.9f, 0}, {0.8f, 0, 0}, {0, 0.3f, 0});
    last = next();
    CHECK(last.at(kRight.x, kRight.y) == dvec3(0));

    const Id<Instance> third = place(p.scene, quad({1, -0.2f, 0.5f}, {0.3f, 0, 0}, {0, 0.3f, 0}), colored(vec3(0.7f)));
    last = next();
    CHECK(last.at(kRight.x, kRight.y + 2).z > 0.1);
    const Id<Node> group = addNode(p.scene, translation({0, 5, 0}));
    p.scene.nodes.edit(p.scene.instances.get(third)->node)->parent = group;  // a parent takes it along
    last = next();
    CHECK(last.at(kRight.x, kRight.y + 2) == dvec3(0));
    p.scene.nodes.edit(group)->local = glm::dmat4(1);
    next();
    p.scene.instances.remove(third);
    last = next();
    CHECK(last.at(kRight.x, kRight.y + 2) == dvec3(0));

    p.scene.lights.edit(p.sun)->color = {1, 0, 0};
    last = next();
    CHECK(last.at(kLeft.x, kLeft.y).y == 0);
    p.scene.lights.remove(p.sun);
    last = next();
    CHECK(last.at(kLeft.x, kLeft.y) == dvec3(0));
    p.scene.environment.color = {0, 0, 4};
    last = next();
    CHECK(last.at(2, 2).z > 0.1);
    p.scene.instances.edit(p.left)->visible = false;
    last = next();
  }
  CHECK(same(last, fresh(p.scene, p.view)));  // no trace of what was
}

TEST_CASE("rows that are freed and used again are not taken for the old ones") {
  Pair p;
  Stage stage;
  stage.display(p.scene, p.view, kSize, fixedQuality());
  const Instance old = *p.scene.instances.get(p.left);
  p.scene.instances.remove(p.left);
  p.scene.meshes.remove(old.mesh);
  p.scene.materials.remove(old.material);
  p.scene.nodes.remove(old.node);
  p.left = place(p.scene, quad({-1, 0, 0}, {0.4f, 0, 0}, {0, 0.4f, 0}), colored({0.1f, 0.1f, 0.9f}), translation({0, 0.3, 0}));
  CHECK(p.scene.instances.get(p.left)->mesh.index == old.mesh.index);  // the same rows, another generation
  const Picture again = stage.display(p.scene, p.view, kSize, fixedQuality());
  CHECK(again.at(kLeft.x, kLeft.y - 3).z > 2 * again.at(kLeft.x, kLeft.y - 3).x);
  CHECK(same(again, fresh(p.scene, p.view)));
  stage.renderer->release(p.scene);
  CHECK(same(stage.display(p.scene, p.view, kSize, fixedQuality()), again));
  Scene copy = p.scene;
  copy.materials.edit(copy.instances.get(p.left)->material)->albedo = vec3(0);
  CHECK(stage.display(copy, p.view, kSize, fixedQuality()).at(kLeft.x, kLeft.y - 3).z < 0.3);
  CHECK(same(stage.display(p.scene, p.view, kSize, fixedQuality()), again));
}

TEST_CASE("picking") {
  Pair p;
  // A fence before the right quad: opaque in its upper half only.
  Texture c;
  c.kind = MapKind::Occlusion;
  c.sampler.mips = false;
  c.sampler.magnifyLinear = false;
  c.image = makeImage(1, 2, 2, PixelType::U8);
  const std::uint8_t texels[4] = {255, 255, 255, 0};
  for (std::size_t i = 0; i < 4; ++i) c.image.data[i] = std::byte(texels[i]);
  Material fence;
  fence.mapC = p.scene.textures.add(c);
  fence.alphaTest = true;
  const Id<Instance> fenceId = place(p.scene, quad({1, 0, 0.5f}, {0.7f, 0, 0}, {0, 0.7f, 0}), fence);
  Stage stage;
  const auto pick = [&](int x, int y) {
    const auto found = stage.renderer->pick(p.scene, p.view, kSize, {x, y});
    REQUIRE(found);
    return *found;
  };
  CHECK(pick(kLeft.x, 32) == p.left);
  CHECK(!pick(1, 1));
  CHECK(!pick(-5, 10));
  CHECK(!pick(96, 64));
  CHECK(pick(kRight.x + 2, 38) == fenceId);   // y up
  CHECK(pick(kRight.x + 2, 25) == p.right);  // through the fence's open half
  // What is picked is what is seen, all over the picture.
  RenderRequest request;
  request.debugView = DebugView::Albedo;
  const Picture seen = stage.draw(p.scene, {&p.view, 1}, kSize, {}, request);
  for (int y = 1; y < 64; y += 7)
    for (int x = 1; x < 96; x += 5) {
      const dvec3 albedo = seen.at(x, y);
      const Id<Instance> wanted = albedo == dvec3(0) ? Id<Instance>{} : albedo.x > 2 * albedo.y ? p.left : albedo.y > 2 * albedo.x ? p.right : fenceId;
      INFO(x << ", " << y);
      CHECK(pick(x, 63 - y) == wanted);
    }
  View corner = p.view;
  corner.viewport = {100, 50, 96, 64};
  const auto inside = stage.renderer->pick(p.scene, corner, {300, 200}, {100 + kLeft.x, 50 + 32});
  REQUIRE(inside);
  CHECK(*inside == p.left);
  const Picture after = stage.display(p.scene, p.view, kSize, fixedQuality());
  CHECK(same(after, fresh(p.scene, p.view)));  // picking leaves nothing behind
}

TEST_CASE("uploads within a budget: something is pending at first, in the end nothing is missing") {
  Pair p;
  for (int i = 0; i < 12; ++i) {
    Material m = colored(vec3(1));
    m.mapA = p.scene.textures.add(checker(std::uint8_t(20 * i), 200, 100, 64));
    place(p.scene, sphere(0.2f, 16, 32), m, translation({-1.6 + 0.3 * i, -0.8, 0.6}));
  }
  const Picture whole = fresh(p.scene, p.view);
  RendererOptions options;
  options.uploadBytesPerFrame = 60000;
  Stage stage(options);
  Picture frame = stage.display(p.scene, p.view, kSize, fixedQuality());
  CHECK(frame.stats.pendingUploads > 0);
  CHECK(!same(frame, whole));
  int frames = 1;
  for (; frames < 100 && frame.stats.pendingUploads > 0; ++frames) {
    CHECK(frame.stats.uploadedBytes <= 60000);
    frame = stage.display(p.scene, p.view, kSize, fixedQuality());
  }
  CHECK(frames > 3);
  CHECK(frame.stats.pendingUploads == 0);
  CHECK(same(frame, whole));
  CHECK(stage.display(p.scene, p.view, kSize, fixedQuality()).stats.uploadedBytes == 0);
}

TEST_CASE("warm-up builds all that the frame needs") {
  Pair p;
  addLight(p.scene, light(LightKind::Point, vec3(1), 10, 5), {0, 1, 1});
  p.scene.environment.color = vec3(1);
  Stage stage;
  PlanOptions options;
  options.size = kSize;
  const FramePlan plan = makePlan(p.scene, {&p.view, 1}, fixedQuality(), stage.renderer->capabilities(), options);
  const auto built = stage.renderer->warmUp(plan);
  REQUIRE(built);
  CHECK(*built > 0);
  CHECK(std::size_t(*built) == plan.programs.size());
  stage.display(p.scene, p.view, kSize, fixedQuality());
  CHECK(stage.renderer->lastPlan().programs == plan.programs);  // a pure function: the renderer's plan is ours
  CHECK(stage.renderer->lastPlan().targets == plan.targets);
  const auto again = stage.renderer->warmUp(stage.renderer->lastPlan());
  REQUIRE(again);
  CHECK(*again == 0);
}

TEST_CASE("automatic exposure meters what is there, not the black behind it") {
  // A small lit square alone, and the same filling the view: the same exposure within a stop.
  Scene s;
  Material m;
  m.albedo = vec3(0.5f);
  place(s, quad({0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}), m);
  addLight(s, light(LightKind::Directional, vec3(1), 1000), {0, 0, 1}, {0, 0, -1});
  Stage stage;
  RenderRequest request;
  request.countNonfinite = true;
  const View far = lookAt({0, 0, 4}, {0, 0, 0}), near = lookAt({0, 0, 0.4}, {0, 0, 0});
  const float small = stage.draw(s, {&far, 1}, kSize, {}, request).stats.exposureEv, whole = stage.draw(s, {&near, 1}, kSize, {}, request).stats.exposureEv;
  CHECK(std::abs(small - whole) < 1);
  CHECK(whole > 5);
}

TEST_CASE("two runs give the same bytes") {
  Pair p;
  for (int i = 0; i < 40; ++i) addLight(p.scene, light(LightKind::Point, vec3(1), 2, 3), {-2 + 0.1 * i, 0.5, 1});
  p.scene.environment.color = vec3(1);
  CHECK(same(fresh(p.scene, p.view), fresh(p.scene, p.view)));
  Stage stage;
  const Picture automatic = stage.display(p.scene, p.view, kSize);
  CHECK(same(automatic, stage.display(p.scene, p.view, kSize)));  // exposure follows from this picture alone
}

TEST_CASE("several views share a target") {
  Pair p;
  addLight(p.scene, light(LightKind::Point, vec3(1), 10, 5), {0, 1, 1});
  p.scene.environment.color = vec3(0.5f);
  View side = lookAt({3, 1, 3}, {0, 0, 0}), top = lookAt({0, 3, 3}, {0, 0, 0});
  top.orthographic = true;
  top.height = 3;
  top.far = 50;
  std::array<View, 3> views{p.view, side, top};
  views[0].viewport = {0, 0, 48, 40};
  views[1].viewport = {48, 0, 52, 40};
  views[2].viewport = {10, 41, 70, 30};
  Stage stage;
  const Picture all = stage.draw(p.scene, views, {100, 72}, fixedQuality(), {});
  for (std::size_t i = 0; i < 3; ++i) {
    INFO("view " << i);
    const glm::ivec4 at = views[i].viewport;
    View alone = views[i];
    alone.viewport = glm::ivec4(0);
    const Picture one = stage.display(p.scene, alone, {at.z, at.w}, fixedQuality());
    Errors e;
    for (int y = 0; y < at.w; ++y)
      for (int x = 0; x < at.z; ++x) {
        const dvec3 d = glm::abs(one.at(x, y) - all.at(x + at.x, 72 - at.y - at.w + y));
        e.add(std::max({d.x, d.y, d.z}), 1.0 / 255);
      }
    CHECK(e.share() > 0.99);  // a pixel on an edge may fall to the other side at another offset
  }
  CHECK(all.at(5, 2) == dvec3(0));  // no view covers it
}

TEST_CASE("the G-buffer is 8 bytes a pixel beside depth; 9 only with baked occlusion") {
  Pair p;
  Stage stage;
  const auto bytes = [&](const Quality& q) {
    stage.display(p.scene, p.view, kSize, q);
    const FramePlan& plan = stage.renderer->lastPlan();
    std::uint64_t sum = 0;
    for (const TargetPlan& t : plan.targets)
      if (t.name.starts_with("gbuffer")) sum += t.bytes;
    CHECK(sum == std::uint64_t(plan.gbufferBytesPerPixel) * 96 * 64);
    CHECK(plan.target("depth")->bytes == 4 * 96 * 64);
    return plan.gbufferBytesPerPixel;
  };
  CHECK(bytes(fixedQuality()) == 8);
  Texture c;
  c.kind = MapKind::Occlusion;
  c.image = makeImage(4, 4, 1, PixelType::U8);
  std::fill(c.image.data.begin(), c.image.data.end(), std::byte(64));
  p.material(p.left).mapC = p.scene.textures.add(c);
  p.scene.environment.color = vec3(5);
  Quality without = fixedQuality();
  without.occlusion = Occlusion::None;
  CHECK(bytes(fixedQuality()) == 9);
  const Picture dark = stage.linear(p.scene, p.view, kSize, fixedQuality());
  CHECK(bytes(without) == 8);
  const Picture bright = stage.linear(p.scene, p.view, kSize, without);
  CHECK(dark.at(kLeft.x, kLeft.y).x < 0.9 * bright.at(kLeft.x, kLeft.y).x);  // it counts for the surroundings' light
  CHECK(dark.at(kRight.x, kRight.y) == bright.at(kRight.x, kRight.y));
}

TEST_CASE("the plan is honest: passes timed are passes planned, and every name it uses is in it") {
  Pair p;
  Stage stage;
  RenderRequest request;
  request.timing = TimingMode::Profile;
  for (int i = 0; i < 3; ++i) {
    if (i == 1) addLight(p.scene, light(LightKind::Point, vec3(1), 10, 5), {0, 1, 1});
    if (i == 1) p.scene.environment.color = vec3(1);
    if (i == 2) p.material(p.left).emission = vec3(1);
    Picture frame = stage.draw(p.scene, {&p.view, 1}, kSize, {}, request);
    const FramePlan& plan = stage.renderer->lastPlan();
    std::vector<std::string> timed, planned;
    for (const PassTime& t : frame.stats.passes) timed.push_back(t.name);
    for (const PassPlan& pass : plan.passes) planned.push_back(pass.name);
    CHECK(timed == planned);
    for (const PassPlan& pass : plan.passes)
      for (const std::string& name : pass.programs) CHECK(std::any_of(plan.programs.begin(), plan.programs.end(), [&](const ProgramPlan& q) { return q.name == name; }));
    for (const EffectPlan& e : plan.effects) CHECK(!e.reason.empty());
    CHECK(plan.on("local_lights") == (i >= 1));
    CHECK(plan.on("emissive") == (i == 2));
    CHECK((plan.pass("background") != nullptr) == (i >= 1));
    CHECK(frame.stats.draws == 2);
    CHECK(frame.stats.triangles == 4);
  }
}
