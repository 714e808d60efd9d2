// Pixels shaded at a smaller size and enlarged (Quality::resolutionScale): what is flat stays exact, what stands somewhere stays there, views do not mix, depth and picks stay right.
#include <burnish/plan.h>
#include <fmt/format.h>

#include <iostream>

#include "gl/objects.h"
#include "render/transparent.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr float kScales[] = {0.25f, 0.5f, 0.67f, 0.75f};

Quality scaled(float scale) {
  Quality q;
  q.resolutionScale = scale;
  q.exposureEv = 1.0f;
  return q;
}

View flatView() {
  View v = lookAt({0, 0, 5}, {0, 0, 0});
  v.orthographic = true;
  v.height = 2;
  return v;
}

/// A shining rectangle that faces the view.
void addCard(Scene& scene, vec3 center, float halfWidth, float halfHeight, vec3 radiance) { place(scene, quad(center, {halfWidth, 0, 0}, {0, halfHeight, 0}), shining(radiance)); }

bool warned(const Report& report, std::string_view text) {
  return std::any_of(report.warnings().begin(), report.warnings().end(), [&](const Warning& w) { return w.message().find(text) != std::string::npos; });
}

}  // namespace

TEST_CASE("the plan of a scaled frame: what is shaded is smaller, what is shown is not", "[scale]") {
  Workshop w;
  Quality q = scaled(0.5f);
  q.antialiasing = Antialiasing::Edge;
  q.bloom = Bloom::Scatter;
  PlanOptions options{.size = {101, 60}};
  const FramePlan plan = makePlan(w.scene, {&w.view, 1}, q, Capabilities{}, options);
  CHECK(plan.on("upscaling"));
  for (const char* name : {"gbuffer_a", "depth", "light"}) {
    CHECK(plan.target(name)->width == 51);
    CHECK(plan.target(name)->height == 30);
  }
  CHECK(plan.target("display")->width == 101);
  const auto off = [&](const PlanOptions& o, const Quality& quality, std::string_view reason) {
    const FramePlan p = makePlan(w.scene, {&w.view, 1}, quality, Capabilities{}, o);
    for (const EffectPlan& e : p.effects)
      if (e.name == "upscaling") CHECK((!e.on && e.reason == reason));
    CHECK(p.target("depth")->width == 101);
  };
  off(options, scaled(1), "resolutionScale below 1 would call for it");
  PlanOptions depth = options, view = options, removed = options;
  depth.hostDepthIn = true;
  off(depth, q, "the target brings depth, which has its size");
  view.debugView = DebugView::Normal;
  off(view, q, "the debug view shows pixels as they are");
  removed.removed = {"upscaling"};
  CHECK(makePlan(w.scene, {&w.view, 1}, q, Capabilities{}, removed).target("depth")->width == 101);
}

TEST_CASE("what is flat is exact at every scale and size", "[scale]") {
  Stage stage;
  Scene scene;
  addCard(scene, {0, 0, 0}, 9, 9, {0.3f, 1.7f, 0.02f});
  for (const glm::ivec2 size : {glm::ivec2(64, 48), glm::ivec2(101, 67), glm::ivec2(3, 2), glm::ivec2(1, 1)})
    for (const float scale : kScales) {
      INFO(size.x << " x " << size.y << " at " << scale);
      CHECK(same(stage.linear(scene, flatView(), size, scaled(scale)), stage.linear(scene, flatView(), size, scaled(1))));
      CHECK(same(stage.display(scene, flatView(), size, scaled(scale)), stage.display(scene, flatView(), size, scaled(1))));
    }
}

TEST_CASE("an edge is where it was: only pixels within one shaded pixel of it differ", "[scale]") {
  Stage stage;
  const glm::ivec2 size(64, 48);
  Scene scene;
  addCard(scene, {9, 0, 0}, 9, 9, vec3(1));  // the right half: its edge lies between pixels 31 and 32
  const Picture full = stage.linear(scene, flatView(), size, scaled(1));
  for (const float scale : kScales) {
    const Picture p = stage.linear(scene, flatView(), size, scaled(scale));
    const double reach = 1 / double(scale);
    double sum = 0;
    for (int x = 0; x < size.x; ++x) {
      INFO(scale << " at " << x);
      if (std::abs(x + 0.5 - 32) > reach + 0.01) CHECK(p.at(x, 20) == full.at(x, 20));
      CHECK((p.at(x, 20).x >= 0 && p.at(x, 20).x <= 1));
      if (x > 0) CHECK(p.at(x, 20).x >= p.at(x - 1, 20).x);
      sum += p.at(x, 20).x;
    }
    // Where shaded pixels share the edge with those of the target the light is the same; else it may be off by half a shaded pixel.
    const bool shared = scale == 0.5f || scale == 0.25f || scale == 0.75f;
    CHECK(std::abs(sum - 32) <= (shared ? 1e-4 : 0.5 * reach));
  }
}

TEST_CASE("what stands somewhere stays there, and keeps its light", "[scale]") {
  Stage stage;
  const glm::ivec2 size(120, 90);
  Scene scene;
  place(scene, sphere(0.5f, 32, 64), shining(vec3(1)), translation({0.31, -0.17, 0}));
  const View view = lookAt({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.5f);
  const auto momentOf = [&](const Picture& p) {
    dvec3 m(0);
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) m += dvec3(1, x, y) * p.at(x, y).x;
    return dvec3(m.x, m.y / m.x, m.z / m.x);
  };
  const dvec3 full = momentOf(stage.linear(scene, view, size, scaled(1)));
  for (const float scale : kScales) {
    const dvec3 m = momentOf(stage.linear(scene, view, size, scaled(scale)));
    std::cout << fmt::format("  scale {}: light {:.4f} of the full picture's, moved by {:.3f}, {:.3f} pixels\n", scale, m.x / full.x, m.y - full.y, m.z - full.z);
    // A disc of N pixels, sampled at their middles, errs by some N^(1/3) of them (Gauss's circle problem): here 0.25 * 2100 * scale² pixels.
    const double pixels = full.x * double(scale) * double(scale);
    CHECK(std::abs(m.x / full.x - 1) < 2 * std::pow(pixels, 1 / 3.0) / pixels);
    CHECK(std::hypot(m.y - full.y, m.z - full.z) < 0.5);
  }
}

TEST_CASE("views side by side do not mix, whatever their size", "[scale]") {
  Stage stage;
  Scene scene;
  addCard(scene, {-50, 0, 0}, 9, 9, {1, 0, 0});
  addCard(scene, {50, 0, 0}, 9, 9, {0, 1, 0});
  View left = flatView(), right = flatView();
  left.eye.x = -50, right.eye.x = 50;
  left.viewport = {0, 0, 37, 50};
  right.viewport = {37, 0, 64, 50};
  const std::array<View, 2> views{left, right};
  for (const float scale : kScales) {
    RenderRequest request;
    request.output = Output::Linear;
    const Picture p = stage.draw(scene, views, {101, 50}, scaled(scale), request);
    int wrong = 0;
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 101; ++x) wrong += p.at(x, y) != (x < 37 ? dvec3(1, 0, 0) : dvec3(0, 1, 0));
    INFO(scale);
    CHECK(wrong == 0);
  }
}

TEST_CASE("a pixel that is no number stays as small as it was shaded", "[scale]") {
  Stage stage;
  const auto device = gl::Device::create(stage.context->procAddress(), false);
  REQUIRE(device);
  Scene scene;
  addCard(scene, {0, 0, 0}, 9, 9, vec3(1));
  RenderRequest request;
  request.output = Output::Linear;
  request.hostDraw = [&](const HostDraw& d) {
    const GladGLContext& gl = (*device)->gl;
    CHECK(d.viewport == glm::ivec4(0, 0, 32, 24));
    gl.Enable(GL_SCISSOR_TEST);
    gl.Scissor(10, 8, 1, 1);
    const float nan[4] = {NAN, NAN, NAN, 1};
    gl.ClearBufferfv(GL_COLOR, 0, nan);
  };
  const View view = flatView();
  const Picture p = stage.draw(scene, {&view, 1}, {64, 48}, scaled(0.5f), request);
  int bad = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool expected = x / 2 == 10 && (47 - y) / 2 == 8;
      bad += std::isnan(p.at(x, y).x);
      CHECK(std::isnan(p.at(x, y).x) == expected);
    }
  CHECK(bad == 4);
}

TEST_CASE("depth out has the target's size; depth in keeps the picture at full size and says so", "[scale]") {
  Stage stage;
  const glm::ivec2 size(64, 48);
  const auto device = gl::Device::create(stage.context->procAddress(), false);
  REQUIRE(device);
  auto depth = gl::Texture::create(**device, {.format = GL_DEPTH_COMPONENT32F, .width = size.x, .height = size.y}, "host depth");
  auto target = OffscreenTarget::create(stage.context->procAddress(), size, Output::Display);
  REQUIRE((depth && target));
  Scene scene;
  addCard(scene, {9, 0, 0}, 9, 9, vec3(1));
  const View view = lookAt({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.5f);
  Target out = (*target)->target();
  out.depthOut = HostDepth{.texture = depth->id(), .near = 0.1f, .far = 100};
  std::vector<float> full(std::size_t(size.x) * std::size_t(size.y)), half = full;
  for (const float scale : {1.0f, 0.5f}) {
    REQUIRE(stage.renderer->render(scene, {&view, 1}, out, scaled(scale), {}));
    depth->read(0, std::as_writable_bytes(std::span(scale == 1 ? full : half)));
  }
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) CHECK(half[std::size_t(y * size.x + x)] == Approx(full[std::size_t(y * size.x + x)]).margin(1e-6));  // the edge is shared
  // A host's depth in: everything at full size.
  std::vector<float> far(full.size(), 1.0f);
  depth->upload(0, far.data());
  Target in = (*target)->target();
  in.depthIn = HostDepth{.texture = depth->id(), .near = 0.1f, .far = 100};
  Picture pictures[2];
  for (const float scale : {1.0f, 0.5f}) {
    REQUIRE(stage.renderer->render(scene, {&view, 1}, in, scaled(scale), {}));
    CHECK(warned(stage.renderer->report(), "no effect where the target brings depth") == (scale < 1));
    pictures[scale < 1].image = std::move(*(*target)->read());
  }
  CHECK(same(pictures[0], pictures[1]));
}

TEST_CASE("antialiasing, bloom, glass and the forward path work at any scale", "[scale]") {
  Workshop w;
  place(w.scene, sphere(0.4f, 24, 48), glassOf(1.5f, 1, 0.2f), translation({0.1, 0.3, 1.4}));
  const glm::ivec2 size(98, 71);
  Quality q = scaled(0.67f);
  const auto check = [&](const char* what) {
    Stage stage;
    Picture p, full;
    Quality one = q;
    one.resolutionScale = 1;
    const int frames = q.antialiasing == Antialiasing::Temporal ? 32 : 1;
    for (int i = 0; i < frames; ++i) p = stage.display(w.scene, w.view, size, q);
    for (int i = 0; i < frames; ++i) full = stage.display(w.scene, w.view, size, one);
    // Edges differ; most pixels do not by much.
    const Errors e = difference(p, full, 0.06);
    INFO(what << ": " << e.share() << " within, largest " << e.largest);
    CHECK(e.share() > 0.8);
    CHECK(!same(p, full));
  };
  check("plain");
  q.antialiasing = Antialiasing::Edge;
  check("edge");
  q.antialiasing = Antialiasing::Temporal;
  check("temporal");
  q.antialiasing = Antialiasing::None;
  q.bloom = Bloom::Scatter;
  q.occlusion = Occlusion::Screen8;
  check("bloom and occlusion");
  q.path = Path::Forward;
  check("forward");
}

TEST_CASE("a scale out of its range is held, and said", "[scale]") {
  Stage stage;
  Scene scene;
  addCard(scene, {0, 0, 0}, 9, 9, vec3(1));
  for (const float scale : {0.0f, -1.0f, 2.0f, NAN}) {
    stage.linear(scene, flatView(), {32, 24}, scaled(scale));
    CHECK(warned(stage.renderer->report(), "Quality::resolutionScale is"));
  }
}
