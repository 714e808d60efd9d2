// Edge antialiasing: slanted edges come nearer to a supersampled picture, what is flat stays bit for bit, thin lines stay, views do not mix.
#include <fmt/format.h>

#include <iostream>

#include "render/painted.h"
#include "render/reduced.h"

using namespace burnish;
using namespace burnish::test;

namespace {

Quality smoothed(bool on = true) {
  Quality q = plainQuality();
  q.antialiasing = on ? Antialiasing::Edge : Antialiasing::None;
  return q;
}

/// A glowing bar turned by `degrees` before another brightness.
Scene slanted(double degrees, float bright, float dark) {
  Scene scene;
  Material m;
  m.unlit = true;
  m.albedo = vec3(bright);
  const double a = degrees * kPi / 180;
  place(scene, quad({0, 0, 0}, vec3(0.7 * std::cos(a), 0.7 * std::sin(a), 0), vec3(-0.3 * std::sin(a), 0.3 * std::cos(a), 0)), m);
  m.albedo = vec3(dark);
  place(scene, quad({0, 0, -0.5f}, {4, 0, 0}, {0, 4, 0}), m);
  return scene;
}

double rms(const Picture& a, const Picture& b) {
  double sum = 0;
  for (int y = 0; y < a.image.height; ++y)
    for (int x = 0; x < a.image.width; ++x) sum += glm::dot(a.at(x, y) - b.at(x, y), a.at(x, y) - b.at(x, y));
  return std::sqrt(sum / (3.0 * a.image.width * a.image.height));
}

View front() {
  View v = lookAt({0, 0, 2}, {0, 0, 0});
  v.orthographic = true;
  v.height = 2;
  v.far = 10;
  return v;
}

}  // namespace

TEST_CASE("edge antialiasing brings slanted edges nearer to a supersampled picture, and leaves flat areas bit for bit") {
  Easel easel;
  const View view = front();
  const glm::ivec2 size(128, 96);
  double worst = 1e9, mean = 0;
  for (const double degrees : {3.0, 8.0, 18.0, 30.0, 41.0, 64.0, 86.0})
    for (const auto& [bright, dark] : {std::pair(0.9f, 0.05f), std::pair(0.4f, 0.2f)}) {
      const Scene scene = slanted(degrees, bright, dark);
      const Picture exact = reduced(easel.develop(scene, {&view, 1}, size * 8, smoothed(false)), 8);
      const Picture none = easel.develop(scene, {&view, 1}, size, smoothed(false)), edge = easel.develop(scene, {&view, 1}, size, smoothed());
      const double factor = rms(none, exact) / rms(edge, exact);
      worst = std::min(worst, factor);
      mean += factor / 14;
      std::cout << fmt::format("  {:2.0f} degrees, {:.2f} on {:.2f}: rms error {:.4f} without, {:.4f} with: {:.2f} times less\n", degrees, bright, dark, rms(none, exact), rms(edge, exact), factor);
      // Flat: no other value within a pixel.
      const Picture plain = easel.stage.display(scene, view, size, smoothed(false)), smooth = easel.stage.display(scene, view, size, smoothed());
      for (int y = 1; y < size.y - 1; ++y)
        for (int x = 1; x < size.x - 1; ++x) {
          bool flat = true;
          for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) flat &= plain.at(x + i, y + j) == plain.at(x, y);
          if (flat) REQUIRE(smooth.at(x, y) == plain.at(x, y));
        }
    }
  CHECK(worst > 1.35);  // toward 45 degrees, where every step is a pixel
  CHECK(mean > 2.1);
}

TEST_CASE("edge antialiasing leaves even, smooth and axis-aligned pictures bit for bit") {
  Stage stage;
  const View view = front();
  Scene scene = slanted(0, 0.9f, 0.05f);
  const glm::ivec2 size(64, 48);
  const Picture none = stage.display(scene, view, size, smoothed(false)), edge = stage.display(scene, view, size, smoothed());
  int changed = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) changed += none.at(x, y) != edge.at(x, y);
  std::cout << fmt::format("  an upright bar: {} pixels changed\n", changed);
  CHECK(changed <= 4);  // its corners, at most
  Scene ball;
  Material m;
  m.albedo = vec3(0.5f);
  m.roughness = 1;
  place(ball, sphere(6, 96, 192), m);
  addLight(ball, light(LightKind::Directional, vec3(1), 2), {0, 0, 0}, {-0.3, -0.5, -1});
  const View close = lookAt({0, 0, 8}, {0, 0, 0}, {0, 1, 0}, 0.4f);
  CHECK(same(stage.display(ball, close, size, smoothed(false)), stage.display(ball, close, size, smoothed())));
}

TEST_CASE("edge antialiasing keeps thin lines: stripes, strokes and dots of a pixel") {
  Easel easel;
  const glm::ivec2 size(64, 48);
  const auto contrast = [&](const std::vector<Patch>& patches, glm::ivec2 on, glm::ivec2 off) {
    const Picture p = easel.paint(size, smoothed(), patches);
    return p.at(on.x, size.y - 1 - on.y).y - p.at(off.x, size.y - 1 - off.y).y;
  };
  const vec3 white(1);
  std::vector<Patch> stripes, rows, dots;
  for (int x = 0; x < 64; x += 2) stripes.push_back({x, 0, 1, 48, white});
  for (int y = 0; y < 48; y += 3) rows.push_back({0, y, 64, 1, white});
  for (int x = 0; x < 64; x += 4) dots.push_back({x, 20, 1, 1, white});
  const double kept[] = {contrast(stripes, {32, 20}, {33, 20}), contrast(rows, {32, 21}, {32, 22}), contrast(dots, {32, 20}, {34, 20}), contrast({{32, 10, 1, 20, white}}, {32, 20}, {35, 20}),
                         contrast({{20, 20, 12, 1, white}, {20, 24, 12, 1, white}, {20, 20, 1, 5, white}}, {26, 20}, {26, 22})};
  std::cout << fmt::format("  contrast kept: stripes {:.2f}, rows {:.2f}, dots {:.2f}, a stroke {:.2f}, a letter {:.2f}\n", kept[0], kept[1], kept[2], kept[3], kept[4]);
  for (const double k : kept) CHECK(k > 0.55);
}

TEST_CASE("edge antialiasing of views side by side is each view's own, at any size") {
  Easel easel;
  const Scene scene = slanted(20, 0.9f, 0.05f);
  View left = front(), right = left, alone = left;
  left.viewport = {0, 0, 60, 48};
  right.viewport = {60, 0, 61, 48};
  const View both[] = {left, right};
  const Picture p = easel.develop(scene, both, {121, 48}, smoothed()), one = easel.develop(scene, {&alone, 1}, {60, 48}, smoothed());
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 60; ++x) REQUIRE(p.at(x, y) == one.at(x, y));
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(3, 5), glm::ivec2(1, 200), glm::ivec2(200, 1)}) CHECK(finite(easel.develop(scene, {&alone, 1}, size, smoothed())));
}

TEST_CASE("edge antialiasing adds a target and a pass only when it is on") {
  const Scene scene;
  const View view;
  PlanOptions options{.size = {640, 360}};
  Quality quality;
  const FramePlan off = makePlan(scene, {&view, 1}, quality, {}, options);
  quality.antialiasing = Antialiasing::Edge;
  const FramePlan on = makePlan(scene, {&view, 1}, quality, {}, options);
  options.output = Output::Linear;
  const FramePlan linear = makePlan(scene, {&view, 1}, quality, {}, options);
  for (const FramePlan* plan : {&off, &linear}) {
    CHECK(plan->target("display") == nullptr);
    CHECK(plan->pass("edge_antialiasing") == nullptr);
    REQUIRE(plan->pass("tonemap"));
    CHECK(plan->pass("tonemap")->writes == std::vector<std::string>{"target"});
  }
  CHECK(on.target("display")->format == "RGBA8");
  CHECK(on.pass("tonemap")->writes == std::vector<std::string>{"display"});
}
