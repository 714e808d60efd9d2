// How a frame is stored: the G-buffer's normals and the light buffer in each format, against the forward path, closed forms and each format's own step.
#include <burnish/plan.h>
#include <fmt/format.h>

#include <iostream>

#include "gl/objects.h"
#include "render/transparent.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize(96, 72);
constexpr double kWorstDegrees[] = {0.942, 0.0589, 0.0037};  // of shading/normals.h, by NormalStorage
constexpr NormalStorage kStorages[] = {NormalStorage::Oct8, NormalStorage::Oct12, NormalStorage::Oct16};
constexpr LightBuffer kBuffers[] = {LightBuffer::R11G11B10, LightBuffer::Rgba16F, LightBuffer::Rgba32F};

FramePlan planOf(const Scene& scene, const View& view, const Quality& q, const PlanOptions& options = {.size = kSize}) { return makePlan(scene, {&view, 1}, q, Capabilities{}, options); }

double rms(const Picture& a, const Picture& b) {
  double sum = 0;
  for (int y = 0; y < a.image.height; ++y)
    for (int x = 0; x < a.image.width; ++x) {
      const dvec3 d = a.at(x, y) - b.at(x, y);
      sum += glm::dot(d, d);
    }
  return std::sqrt(sum / (3.0 * a.image.width * a.image.height));
}

/// A ball of that roughness in the light of one sun.
struct Ball {
  Scene scene;
  View view = lookAt({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.5f);
  explicit Ball(float roughness) {
    Material m;
    m.albedo = vec3(1);  // exact in the G-buffer
    m.roughness = roughness;
    place(scene, sphere(1, 64, 128), m);
    addLight(scene, light(LightKind::Directional, vec3(1), float(kPi)), {}, {-0.5, -0.7, -1});
  }
};

/// Lit, shining, blended and refracting surfaces before a background.
struct Shelf {
  Scene scene;
  View view = lookAt({0, 0.6, 5}, {0, 0, 0}, {0, 1, 0}, 0.6f);
  Shelf() {
    Material floor;
    floor.albedo = {0.6f, 0.5f, 0.4f};
    floor.roughness = 0.7f;
    place(scene, box({-2, -0.9f, -2}, {2, -0.8f, 2}), floor);
    Material lamp = floor;
    lamp.emission = {0.8f, 0.4f, 0.2f};
    place(scene, sphere(0.5f, 24, 48), lamp, translation({-0.8, -0.2, 0}));
    Material veil = floor;
    veil.blend = true;
    veil.opacity = 0.5f;
    place(scene, quad({-0.6f, 0, 1}, {0.5f, 0, 0}, {0, 0.5f, 0}), veil);
    place(scene, sphere(0.5f, 24, 48), glassOf(1.5f, 1, 0.3f), translation({0.8, -0.2, 0.5}));
    addLight(scene, light(LightKind::Directional, vec3(1), 3), {}, {-0.5, -0.7, -1});
    scene.environment.color = {0.5f, 0.6f, 0.8f};
    scene.environment.scale = 1;
  }
};

}  // namespace

TEST_CASE("the plan says how a frame is stored: formats and bytes", "[storage]") {
  const Shelf s;
  Quality q;
  CHECK(planOf(s.scene, s.view, q).target("gbuffer_b")->format == "RGBA8");
  CHECK(planOf(s.scene, s.view, q).gbufferBytesPerPixel == 8);
  CHECK(planOf(s.scene, s.view, q).target("light")->format == "RGBA16F");
  q.normalStorage = NormalStorage::Oct8;
  q.lightBuffer = LightBuffer::R11G11B10;
  const FramePlan small = planOf(s.scene, s.view, q);
  CHECK(small.target("gbuffer_b")->format == "RGBA8");
  CHECK(small.target("light")->format == "R11F_G11F_B10F");
  CHECK(small.target("light")->bytes == 4u * 96 * 72);
  CHECK(small.target("scene_color")->format == small.target("light")->format);
  q.normalStorage = NormalStorage::Oct16;
  q.lightBuffer = LightBuffer::Rgba32F;
  const FramePlan large = planOf(s.scene, s.view, q);
  CHECK(large.target("gbuffer_b")->format == "RGBA16");
  CHECK(large.gbufferBytesPerPixel == 12);
  CHECK(large.target("light")->bytes == 16u * 96 * 72);
  // Linear output has 32-bit floats, unless the light is asked for as a display would have it.
  PlanOptions linear{.size = kSize};
  linear.output = Output::Linear;
  q.lightBuffer = LightBuffer::R11G11B10;
  CHECK(planOf(s.scene, s.view, q, linear).target("light")->format == "RGBA32F");
  linear.displayLight = true;
  CHECK(planOf(s.scene, s.view, q, linear).target("light")->format == "R11F_G11F_B10F");
  // No preset has a say in it.
  for (const std::string_view preset : presetNames()) {
    REQUIRE(setPreset(q, preset));
    CHECK((q.normalStorage == NormalStorage::Oct16 && q.lightBuffer == LightBuffer::R11G11B10));
  }
}

TEST_CASE("normals of the G-buffer shade a white ball within their format's worst angle of the forward path", "[storage]") {
  Stage stage;
  const Ball ball(1);
  Quality q;
  q.diffuse = Diffuse::Lambert;
  q.specular = Specular::Microfacet;
  Quality forward = q;
  forward.path = Path::Forward;
  const Picture truth = stage.linear(ball.scene, ball.view, kSize, forward);
  double error[3] = {};
  for (const NormalStorage storage : kStorages) {
    q.normalStorage = storage;
    const Picture p = stage.linear(ball.scene, ball.view, kSize, q);
    // E/pi = 1: diffuse light turns by sin(angle) at most. The widest lobe adds a fourth part of F0 = 0.04 and, toward grazing, F's own slope.
    const double bound = 1.25 * kWorstDegrees[int(storage)] * kPi / 180 + 2e-5;
    const Errors e = difference(p, truth, bound);
    error[int(storage)] = rms(p, truth);
    std::cout << fmt::format("  {}: off by {:.2e} at most, {:.2e} rms; {:.2e} is the bound\n", terms()[22].rungs[std::size_t(storage)].name, e.largest, error[int(storage)], bound);
    CHECK(e.share() == 1);
  }
  // Steps are 254, 4094 and 65534 to an axis.
  CHECK(error[1] < error[0] / 10);
  CHECK(error[2] < error[1] / 5);
}

TEST_CASE("highlights come nearer to the forward path with more bits of the normal", "[storage]") {
  Stage stage;
  for (const float roughness : {0.1f, 0.2f, 0.4f}) {
    const Ball ball(roughness);
    Quality q, forward;
    forward.path = Path::Forward;
    const Picture truth = stage.linear(ball.scene, ball.view, kSize, forward);
    double error[3] = {};
    for (const NormalStorage storage : kStorages) {
      q.normalStorage = storage;
      error[int(storage)] = rms(stage.linear(ball.scene, ball.view, kSize, q), truth);
    }
    std::cout << fmt::format("  roughness {}: rms {:.2e}, {:.2e}, {:.2e}\n", roughness, error[0], error[1], error[2]);
    CHECK(error[1] < error[0]);
    CHECK(error[2] < error[1] / 3);
  }
}

TEST_CASE("brushed and rough surfaces, screen-space occlusion and debug views read normals of every format", "[storage]") {
  Stage stage;
  Workshop w;
  Material& m = *w.scene.materials.edit(w.material);
  m.anisotropy = 0.7f;
  m.diffuseRoughness = 0.4f;
  Quality q;
  q.occlusion = Occlusion::Screen8;
  const Picture usual = stage.linear(w.scene, w.view, kSize, q);
  RenderRequest normals;
  normals.debugView = DebugView::Normal;
  const Picture usualNormals = stage.draw(w.scene, {&w.view, 1}, kSize, q, normals);
  double mean = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) mean += (usual.at(x, y).x + usual.at(x, y).y + usual.at(x, y).z) / (3.0 * kSize.x * kSize.y);
  for (const NormalStorage storage : {NormalStorage::Oct8, NormalStorage::Oct16}) {
    q.normalStorage = storage;
    // 0.94 + 0.06 degrees are 2.3 and a rounding of 255 levels of sRGB about the middle.
    CHECK(difference(stage.draw(w.scene, {&w.view, 1}, kSize, q, normals), usualNormals, 4.0 / 255).share() == 1);
    const double off = rms(stage.linear(w.scene, w.view, kSize, q), usual) / mean;
    std::cout << fmt::format("  {}: {:.4f} of the mean from oct-12\n", terms()[22].rungs[std::size_t(storage)].name, off);
    CHECK(off < (storage == NormalStorage::Oct8 ? 0.05 : 0.01));
  }
}

TEST_CASE("lights are culled by normals of every format: no light is lost", "[storage]") {
  RendererOptions reduce;
  reduce.tileBounds = TileBounds::Reduction;  // which reads no normals
  Stage stage, reducing(reduce);
  Workshop w;
  for (int i = 0; i < 40; ++i) addLight(w.scene, light(LightKind::Point, {1, 0.8f, 0.6f}, 0.5f, 1.2f), {std::sin(i * 2.4) * 1.5, -0.6 + 0.04 * i, std::cos(i * 2.4) * 1.5});
  for (const NormalStorage storage : kStorages) {
    Quality q;
    q.normalStorage = storage;
    const Picture culled = stage.linear(w.scene, w.view, kSize, q), all = reducing.linear(w.scene, w.view, kSize, q);
    const Errors e = difference(culled, all, 1e-5);
    INFO(terms()[22].rungs[std::size_t(storage)].name << ": " << e.largest);
    CHECK(e.share() == 1);
    CHECK(culled.stats.lightsInView > 10);
  }
}

TEST_CASE("the host's pixels are told apart in every format", "[storage]") {
  Stage stage;
  const Ball ball(0.5f);
  const auto device = gl::Device::create(stage.context->procAddress(), false);
  REQUIRE(device);
  auto depth = gl::Texture::create(**device, {.format = GL_DEPTH_COMPONENT32F, .width = kSize.x, .height = kSize.y}, "host depth");
  auto target = OffscreenTarget::create(stage.context->procAddress(), kSize, Output::Display);
  REQUIRE((depth && target));
  // The left half is the host's, nearer than anything; nothing is in the right one.
  std::vector<float> values(std::size_t(kSize.x) * std::size_t(kSize.y));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = int(i) % kSize.x < kSize.x / 2 ? 0.5f : 1.0f;
  depth->upload(0, values.data());
  std::vector<Picture> pictures;
  for (const NormalStorage storage : kStorages) {
    Quality q;
    q.normalStorage = storage;
    q.exposureEv = 0.0f;
    Target t = (*target)->target();
    (*device)->gl.BindFramebuffer(GL_FRAMEBUFFER, t.framebuffer);
    (*device)->gl.ClearColor(0, 1, 0, 1);
    (*device)->gl.Clear(GL_COLOR_BUFFER_BIT);
    (*device)->gl.ClearColor(0, 0, 0, 0);
    (*device)->gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    t.depthIn = HostDepth{.texture = depth->id(), .near = 0.1f, .far = 100};
    REQUIRE(stage.renderer->render(ball.scene, {&ball.view, 1}, t, q, {}));
    auto image = (*target)->read();
    REQUIRE(image);
    pictures.push_back({std::move(*image), {}});
    for (int y = 0; y < kSize.y; y += 7)
      for (int x = 0; x < kSize.x / 2; x += 5) CHECK(pictures.back().at(x, y) == dvec3(0, 1, 0));
    CHECK(pictures.back().at(kSize.x / 2 + 2, kSize.y / 2) != dvec3(0, 1, 0));
  }
}

TEST_CASE("the light buffer's formats hold lit, shining, blended and refracting surfaces within their steps", "[storage]") {
  Stage stage;
  const Shelf s;
  Quality q;
  q.exposureEv = 1.0f;
  const Picture exact = stage.linear(s.scene, s.view, kSize, q);
  RenderRequest request;
  request.output = Output::Linear;
  request.displayLight = true;
  // A step of each format's mantissa (blue has one bit less), for each of at most four writes: lighting, emission or background, then a veil, or glass that reads the picture (and its mean) behind it.
  constexpr double kStep[] = {1.0 / 32, 1.0 / 1024, 1e-6};
  double error[3] = {};
  for (const LightBuffer buffer : kBuffers) {
    q.lightBuffer = buffer;
    const Picture p = stage.draw(s.scene, {&s.view, 1}, kSize, q, request);
    double worst = 0;
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x)
        for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(p.at(x, y)[c] - exact.at(x, y)[c]) / std::max(exact.at(x, y)[c], 1e-3));
    error[int(buffer)] = rms(p, exact);
    std::cout << fmt::format("  {}: off by {:.2e} of the value at most, {:.2e} rms\n", terms()[23].rungs[std::size_t(buffer)].name, worst, error[int(buffer)]);
    CHECK(worst <= 4 * kStep[int(buffer)]);
  }
  CHECK(error[1] < error[0] / 8);
  CHECK(error[2] < error[1] / 8);
}

TEST_CASE("pictures for a display are the same in every light buffer's format but for its steps; bloom and temporal antialiasing work in each", "[storage]") {
  Shelf s;
  addLight(s.scene, light(LightKind::Point, vec3(1), 40, 3), {0.6, 0.6, 0.6});
  Quality q;
  q.exposureEv = 2.0f;
  Stage stage;
  RenderRequest request;
  request.countNonfinite = true;
  for (const Antialiasing antialiasing : {Antialiasing::None, Antialiasing::Temporal})
    for (const Bloom bloom : {Bloom::None, Bloom::Scatter}) {
      q.antialiasing = antialiasing;
      q.bloom = bloom;
      std::vector<Picture> pictures;
      for (const LightBuffer buffer : kBuffers) {
        q.lightBuffer = buffer;
        ++request.sequence;  // a history of its own
        pictures.push_back(stage.draw(s.scene, {&s.view, 1}, kSize, q, request));
        CHECK(pictures.back().stats.nonfinitePixels == 0);
      }
      // sRGB's curve takes 1/32 of a value to at most 1/32/2.2 + its toe; four writes.
      CHECK(difference(pictures[0], pictures[1], 4.0 / 32 / 2).share() == 1);
      CHECK(difference(pictures[2], pictures[1], 2.0 / 255).share() == 1);
      CHECK(!same(pictures[0], pictures[1]));
    }
}
