// Antialiasing over time, where nothing moves: it converges to the mean over each pixel, and stays. What begins it anew, what gets into it and what does not.
#include <fmt/format.h>

#include <iostream>
#include <limits>

#include "render/temporal.h"
#include "render/workshop.h"

using namespace burnish;
using namespace burnish::test;

namespace {

Picture after(Easel& easel, const Scene& scene, const View& view, glm::ivec2 size, const Quality& quality, int frames) {
  Picture p;
  for (int i = 0; i < frames; ++i) p = easel.develop(scene, {&view, 1}, size, quality);
  return p;
}

bool lists(const FramePlan& plan, const std::string& program) {
  return std::any_of(plan.programs.begin(), plan.programs.end(), [&](const ProgramPlan& p) { return p.name == program; });
}

}  // namespace

TEST_CASE("temporal antialiasing of a still picture converges to the mean over each pixel, and then stays", "[temporal]") {
  const glm::ivec2 size(48, 36);
  for (const double degrees : {8.0, 30.0, 64.0}) {
    Easel easel;
    const Scene scene = slanted(degrees, 0.9f, 0.05f);
    const View view = facing();
    const Picture exact = reduced(easel.develop(scene, {&view, 1}, size * 16, temporal(false)), 16), none = easel.develop(scene, {&view, 1}, size, temporal(false));
    double error[4] = {}, change = 0;
    Picture last, before;
    for (int frame = 1; frame <= 80; ++frame) {
      before = std::move(last);
      last = easel.develop(scene, {&view, 1}, size, temporal());
      if (frame == 4 || frame == 16 || frame == 64 || frame == 80) error[frame == 4 ? 0 : frame == 16 ? 1 : frame == 64 ? 2 : 3] = rms(last, exact);
      if (frame > 65) change = std::max(change, difference(last, before, 1).largest);
    }
    const double one = rms(none, exact);
    std::cout << fmt::format("  {:2.0f} degrees: rms error {:.4f} with one sample; {:.4f}, {:.4f}, {:.4f}, {:.4f} after 4, 16, 64, 80 frames; largest change in a frame after 65: {:.4f}\n", degrees, one, error[0],
                             error[1], error[2], error[3], change);
    CHECK(error[0] < one / 1.25);
    CHECK(error[1] < one / 4);
    CHECK(error[2] < one / 8);
    CHECK(error[3] == error[2]);
    CHECK(change == 0);
  }
}

TEST_CASE("temporal antialiasing of linear output is the plain mean of its samples", "[temporal]") {
  Stage stage;
  const Scene scene = slanted(20, 0.9f, 0.05f);
  const View view = facing();
  const glm::ivec2 size(32, 24);
  Quality q;
  const Picture exact = reduced(stage.linear(scene, view, size * 16, q), 16);
  const double one = rms(stage.linear(scene, view, size, q), exact);
  q.antialiasing = Antialiasing::Temporal;
  Picture p;
  for (int i = 0; i < 64; ++i) p = stage.linear(scene, view, size, q);
  std::cout << fmt::format("  rms error {:.4f} with one sample, {:.4f} after 64 frames; mean {:.4f}, exact {:.4f}\n", one, rms(p, exact), meanOf(p).y, meanOf(exact).y);
  CHECK(stage.renderer->lastPlan().target("history_a")->format == "RGBA32F");
  CHECK(rms(p, exact) < one / 8);
  CHECK(meanOf(p).y == Approx(meanOf(exact).y).epsilon(2e-3));
}

TEST_CASE("temporal antialiasing begins anew after a cut, another size, and another scene, and is the same each time", "[temporal]") {
  Easel easel, other;
  const Scene scene = slanted(20, 0.9f, 0.05f), elsewhere = slanted(70, 0.5f, 0.1f);
  const View view = facing();
  const glm::ivec2 size(40, 30);
  std::vector<Picture> first;
  for (int i = 0; i < 6; ++i) first.push_back(other.develop(scene, {&view, 1}, size, temporal()));
  for (const char* why : {"nothing before", "cut", "size", "scene", "setting"}) {
    CAPTURE(why);
    View begun = facing(0.4, 0.1);
    if (std::string_view(why) == "cut") after(easel, scene, begun, size, temporal(), 3);
    if (std::string_view(why) == "size") after(easel, scene, view, {41, 30}, temporal(), 3);
    if (std::string_view(why) == "scene") after(easel, elsewhere, view, size, temporal(), 3);
    if (std::string_view(why) == "setting") after(easel, scene, begun, size, temporal(false), 1);
    for (int i = 0; i < 6; ++i) {
      View now = view;
      now.cut = i == 0 && std::string_view(why) == "cut";
      REQUIRE(same(easel.develop(scene, {&now, 1}, size, temporal()), first[std::size_t(i)]));
    }
  }
}

TEST_CASE("sequences have histories of their own, and so have views side by side", "[temporal]") {
  Easel easel;
  const Scene scene = slanted(20, 0.9f, 0.05f);
  View left = facing(), right = facing(0.3, 0.2), alone = left;
  left.viewport = {0, 0, 40, 30};
  right.viewport = {40, 0, 41, 30};
  const View both[] = {left, right};
  Picture p, one;
  for (int i = 0; i < 5; ++i) p = easel.develop(scene, both, {81, 30}, temporal());
  one = after(easel, scene, alone, {40, 30}, temporal(), 5);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) REQUIRE(p.at(x, y) == one.at(x, y));
  // Two that take turns, of different sizes: as if each were alone.
  RenderRequest first, second;
  second.sequence = 1;
  Stage stage;
  Picture a, b;
  for (int i = 0; i < 4; ++i) {
    a = stage.draw(scene, {&alone, 1}, {40, 30}, temporal(), first);
    b = stage.draw(scene, {&alone, 1}, {23, 17}, temporal(), second);
  }
  Stage lone;
  Picture c;
  for (int i = 0; i < 4; ++i) c = lone.draw(scene, {&alone, 1}, {40, 30}, temporal(), first);
  CHECK(same(a, c));
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(3, 5), glm::ivec2(1, 90), glm::ivec2(90, 1)})
    for (int i = 0; i < 3; ++i) {
      const View moving = facing(0.1 * i, 0);
      CHECK(finite(easel.develop(scene, {&moving, 1}, size, temporal())));
    }
}

TEST_CASE("H17: a sample that is no number stays out of the mean over frames", "[temporal]") {
  Easel easel;
  Scene scene;
  Material m;
  m.unlit = true;
  m.albedo = vec3(0.4f, 0.3f, 0.2f);
  place(scene, quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}), m);
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  const glm::ivec2 size(24, 18);
  for (const bool moving : {false, true})
    for (int bad = 0; bad < 3; ++bad) {
      CAPTURE(moving, bad);
      Picture p;
      for (int i = 0; i < 24; ++i) {
        View view = facing(moving ? 0.02 * i : 0, 0);
        view.cut = i == 0;
        // Infinity is held: it fades with the mean, or is clipped with its neighbours.
        const std::vector<Patch> patch = i == bad ? std::vector<Patch>{{10, 8, 2, 2, vec3(nan)}, {4, 4, 1, 1, vec3(infinite)}, {16, 12, 1, 1, vec3(-infinite)}} : std::vector<Patch>{{0, 0, 1, 1, m.albedo}};
        p = easel.develop(scene, {&view, 1}, size, temporal(), patch, i == bad);
        REQUIRE(finite(p));
        if (i != bad) continue;
        CHECK(p.stats.nonfinitePixels == 6);
        // Where there was a mean, it shows.
        if (i > 0 && !moving) CHECK(glm::length(p.at(10, 18 - 9) - dvec3(m.albedo)) < 4e-3);
      }
      CHECK(glm::length(p.at(10, 18 - 9) - dvec3(m.albedo)) < 4e-3);
      CHECK(glm::length(p.at(4, 18 - 5) - dvec3(m.albedo)) < 4e-3);
      CHECK(glm::length(p.at(16, 18 - 13) - dvec3(m.albedo)) < 4e-3);
    }
  const auto& warnings = easel.stage.renderer->report().warnings();
  CHECK(std::any_of(warnings.begin(), warnings.end(), [](const Warning& w) { return w.place == "antialiasing"; }));
}

TEST_CASE("temporal antialiasing follows the exposure at once: the history is light, not its picture", "[temporal]") {
  Easel easel;
  const Scene scene = slanted(20, 0.8f, 0.1f);
  const View view = facing();
  const glm::ivec2 size(40, 30);
  Quality q = temporal(), darker = q;
  darker.exposureEv = *q.exposureEv + 1;
  after(easel, scene, view, size, q, 16);
  const Picture changed = easel.develop(scene, {&view, 1}, size, darker);
  Easel other;
  const Picture exact = after(other, scene, view, size, darker, 17);
  std::cout << fmt::format("  largest difference to a sequence that had this exposure all along: {:.4f}\n", difference(changed, exact, 1).largest);
  // At edges the frame of the change is clipped to its own neighbours; elsewhere light is as it was.
  CHECK(rms(changed, exact) < 0.03);
  CHECK(glm::length(changed.at(20, 15) - dvec3(0.4)) < 5e-3);
  CHECK(glm::length(changed.at(1, 1) - dvec3(0.05)) < 2e-3);
}

TEST_CASE("temporal antialiasing that is not asked for is not there; a still scene has no motion vectors", "[temporal]") {
  Stage stage;
  Workshop w;
  const View* view = &w.view;
  stage.draw(w.scene, {view, 1}, {48, 32}, {}, {});
  for (const char* name : {"history_a", "history_b", "history_distance_a", "history_distance_b", "velocity"}) CHECK(stage.renderer->lastPlan().target(name) == nullptr);
  CHECK(stage.renderer->lastPlan().pass("temporal_antialiasing") == nullptr);
  CHECK(!lists(stage.renderer->lastPlan(), "temporal"));
  for (int i = 0; i < 2; ++i) stage.draw(w.scene, {view, 1}, {48, 32}, temporal(), {});
  const FramePlan still = stage.renderer->lastPlan();
  CHECK(still.on("temporal_antialiasing"));
  CHECK(still.target("history_a")->bytes == 48u * 32 * 8);
  CHECK(!still.on("motion_vectors"));
  CHECK(still.target("velocity") == nullptr);
  CHECK(!lists(still, "motion_vectors"));
  // One instance moves: vectors in that frame, and no longer.
  w.scene.nodes.edit(w.scene.instances.get(w.objects[1])->node)->local[3].x += 0.05;
  stage.draw(w.scene, {view, 1}, {48, 32}, temporal(), {});
  CHECK(stage.renderer->lastPlan().on("motion_vectors"));
  CHECK(stage.renderer->lastPlan().target("velocity")->format == "RGBA16F");
  CHECK(lists(stage.renderer->lastPlan(), "motion_vectors"));
  stage.draw(w.scene, {view, 1}, {48, 32}, temporal(), {});
  CHECK(!stage.renderer->lastPlan().on("motion_vectors"));
  // Views of buffers are what they are.
  RenderRequest debug;
  debug.debugView = DebugView::Normal;
  const Picture with = stage.draw(w.scene, {view, 1}, {48, 32}, temporal(), debug), without = stage.draw(w.scene, {view, 1}, {48, 32}, temporal(false), debug);
  CHECK(!stage.renderer->lastPlan().on("temporal_antialiasing"));
  CHECK(same(with, without));
  // A plan of everything holds what may be called for later.
  CHECK(lists(makePlan(w.scene, {view, 1}, temporal(), {}, {.size = {48, 32}, .wholeScene = true}), "motion_vectors"));
}
