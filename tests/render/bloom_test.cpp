// Bloom: energy is kept, the spread is symmetric and the same at every resolution, values that are no numbers stay where they are, views do not mix, and off it is not there.
#include <fmt/format.h>

#include <iostream>
#include <limits>
#include <random>

#include "render/painted.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

Quality blooming(float share) {
  Quality q = plainQuality();
  q.bloom = Bloom::Scatter;
  q.bloomShare = share;
  return q;
}

std::vector<Patch> confetti(glm::ivec2 size, unsigned seed) {
  std::mt19937 random(seed);
  const auto one = [&] { return float(random() % 1000) / 1000; };
  std::vector<Patch> patches;
  for (int i = 0; i < 60; ++i) {
    Patch p;
    p.width = 1 + int(random() % unsigned(size.x / 4)), p.height = 1 + int(random() % unsigned(size.y / 4));
    p.x = int(random() % unsigned(size.x)), p.y = int(random() % unsigned(size.y));
    p.light = vec3(one(), one(), one()) * 0.9f;
    patches.push_back(p);
  }
  return patches;
}

}  // namespace

TEST_CASE("bloom keeps energy: pictures keep their mean, a bright pixel its light") {
  Easel easel;
  for (const glm::ivec2 size : {glm::ivec2(192, 108), glm::ivec2(97, 61), glm::ivec2(250, 33)}) {
    const auto patches = confetti(size, unsigned(size.x));
    const dvec3 before = meanOf(easel.paint(size, plainQuality(), patches)), after = meanOf(easel.paint(size, blooming(0.08f), patches)), all = meanOf(easel.paint(size, blooming(1), patches));
    for (int c = 0; c < 3; ++c) {
      CHECK(after[c] == Approx(before[c]).epsilon(0.002));
      CHECK(all[c] == Approx(before[c]).epsilon(0.01));
    }
    std::cout << fmt::format("  {}x{}: mean with bloom / without: {:.5f} with a share of 0.08, {:.5f} with 1\n", size.x, size.y, after.y / before.y, all.y / before.y);
  }
  // Wherever it stands on the pyramid's grid: nothing flickers as it moves.
  double least = 2, most = 0;
  for (int i = 0; i < 9; ++i) {
    const glm::ivec2 at(96 + 5 * i, 95 - 3 * i);
    const double all = meanOf(easel.paint({256, 192}, blooming(1), {{at.x, at.y, 1, 1, vec3(1)}})).y * 256 * 192;
    least = std::min(least, all), most = std::max(most, all);
  }
  std::cout << fmt::format("  a bright pixel: {:.4f} to {:.4f} of its light arrives, by where it stands\n", least, most);
  CHECK(least > 0.99);
  CHECK(most < 1.01);
}

TEST_CASE("bloom spreads evenly to all sides and falls off") {
  Easel easel;
  constexpr int kSide = 256;
  const Picture p = easel.paint({kSide, kSide}, blooming(1), {{kSide / 2 - 1, kSide / 2 - 1, 2, 2, vec3(40)}});
  double last = 10;
  for (int d = 0; d < kSide / 2; ++d) {
    const int a = kSide / 2 + d, b = kSide / 2 - 1 - d, m = kSide / 2;
    const double right = p.at(a, m).y;
    CHECK(p.at(b, m).y == Approx(right).epsilon(0.004).margin(1e-6));
    CHECK(p.at(m, a).y == Approx(right).epsilon(0.004).margin(1e-6));
    CHECK(p.at(m, b).y == Approx(right).epsilon(0.004).margin(1e-6));
    CHECK(right <= last * 1.002 + 1e-6);
    last = right;
  }
  CHECK(p.at(kSide / 2 + 40, kSide / 2).y > 1e-4);
  // Round: as far along the diagonal it is as bright as along the axis.
  for (const int d : {8, 16, 32}) {
    const int e = int(std::lround(d * std::sqrt(0.5)));
    CHECK(p.at(kSide / 2 + e, kSide / 2 + e).y == Approx(p.at(kSide / 2 + d, kSide / 2).y).epsilon(0.35));
  }
}

TEST_CASE("bloom has the same shape at every resolution") {
  Easel easel;
  constexpr double kRadii[] = {0.04, 0.06, 0.09, 0.13, 0.18, 0.25, 0.35, 0.5};
  // Light within a radius, as a share of all.
  const auto within = [&](int height) {
    const int side = height / 16;
    const Picture p = easel.paint({height, height}, blooming(1), {{height / 2 - side / 2, height / 2 - side / 2, side, side, vec3(1)}});
    std::vector<double> shares(std::size(kRadii), 0);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < height; ++x)
        for (std::size_t i = 0; i < shares.size(); ++i)
          if (std::hypot(x + 0.5 - height / 2, y + 0.5 - height / 2) < kRadii[i] * height) shares[i] += p.at(x, y).y / (side * side);
    return shares;
  };
  const auto reference = within(512);
  double worst = 0;
  for (const int height : {192, 256, 384, 720}) {
    const auto shares = within(height);
    for (std::size_t i = 0; i < shares.size(); ++i) worst = std::max(worst, std::abs(shares[i] - reference[i]));
  }
  std::cout << fmt::format("  light within any radius, 192 to 720 pixels high: within {:.3f} of what 512 pixels show\n", worst);
  CHECK(worst < 0.06);
  CHECK(reference[0] < 0.7);
  CHECK(reference[5] > 0.8);
}

TEST_CASE("bloom's firewall: what is no number stays in its pixel and is reported; what is too large is held (H16, H17)") {
  Easel easel;
  const glm::ivec2 size(96, 64);
  const auto around = confetti(size, 5);
  const auto with = [&](const vec3& value) {
    auto patches = around;
    patches.push_back({40, 30, 1, 1, value});
    return patches;
  };
  const Picture black = easel.paint(size, blooming(0.3f), with(vec3(0)), true);
  CHECK(black.stats.nonfinitePixels == 0);
  for (const vec3& bad : {vec3(kNan), vec3(0.5f, kNan, 0.5f)}) {
    const Picture p = easel.paint(size, blooming(0.3f), with(bad), true);
    CHECK(p.stats.nonfinitePixels == 1);
    int others = 0;
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) others += (x != 40 || y != size.y - 1 - 30) && !(glm::length(p.at(x, y) - black.at(x, y)) < 1e-6);
    CHECK(others == 0);
  }
  const auto& warnings = easel.stage.renderer->report().warnings();
  CHECK(std::any_of(warnings.begin(), warnings.end(), [](const Warning& w) { return w.message() == "bloom: 1 pixels of the light buffer are not finite: they scatter nothing (view 'nonfinite' shows them)"; }));
  for (const float large : {65504.0f, 1e9f, kInf}) {
    const Picture one = easel.paint(size, blooming(0.3f), with(vec3(large))), all = easel.paint(size, blooming(0.3f), {{0, 0, size.x, size.y, vec3(large)}});
    CHECK(finite(one));
    CHECK(one.at(42, size.y - 1 - 30).y > 0.99);
    CHECK(finite(all));
    for (const int x : {0, 40, 95}) CHECK(all.at(x, 20).y > 0.99);
  }
  // The automatic exposure sees none of it either.
  Quality automatic = blooming(0.3f);
  automatic.exposureEv.reset();
  std::vector<Patch> lit{{0, 0, size.x, size.y, vec3(0.5f)}};
  const Picture usual = easel.paint(size, automatic, lit, true);
  lit.push_back({48, 32, 3, 3, vec3(kNan)});
  lit.push_back({10, 10, 3, 3, vec3(kInf)});
  const Picture hurt = easel.paint(size, automatic, lit, true);
  CHECK(hurt.stats.exposureEv == Approx(usual.stats.exposureEv).margin(1e-3));
  CHECK(hurt.stats.nonfinitePixels == 18);
}

TEST_CASE("bloom of views side by side: none lights another, each is as it is alone") {
  Easel easel;
  View left = lookAt({0, 0, 1}, {0, 0, 0}), right = left, alone = left;
  left.viewport = {0, 0, 60, 48};
  right.viewport = {60, 0, 61, 48};
  const std::vector<Patch> patches{{40, 10, 20, 20, vec3(1)}};
  const View both[] = {left, right};
  const Picture p = easel.develop(Scene{}, both, {121, 48}, blooming(0.5f), patches), one = easel.develop(Scene{}, {&alone, 1}, {60, 48}, blooming(0.5f), patches);
  for (int y = 0; y < 48; ++y) {
    for (int x = 60; x < 121; ++x) REQUIRE(p.at(x, y) == dvec3(0));
    for (int x = 0; x < 60; ++x) REQUIRE(p.at(x, y) == one.at(x, y));
  }
}

TEST_CASE("bloom at the smallest and oddest sizes leaves an even picture as it is") {
  Easel easel;
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(3, 5), glm::ivec2(1, 200), glm::ivec2(200, 1), glm::ivec2(17, 16), glm::ivec2(2, 1031)}) {
    const Picture p = easel.paint(size, blooming(1), {{0, 0, size.x, size.y, vec3(0.5f, 0.25f, 0.125f)}});
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) REQUIRE(glm::length(p.at(x, y) - dvec3(0.5, 0.25, 0.125)) < 2e-3);
  }
}

TEST_CASE("bloom that is not asked for is not there, nor with linear output") {
  const Scene scene;
  const View view;
  PlanOptions options{.size = {640, 360}};
  Quality quality;
  const FramePlan off = makePlan(scene, {&view, 1}, quality, {}, options);
  quality.bloom = Bloom::Scatter;
  const FramePlan on = makePlan(scene, {&view, 1}, quality, {}, options);
  options.output = Output::Linear;
  const FramePlan linear = makePlan(scene, {&view, 1}, quality, {}, options);
  for (const FramePlan* plan : {&off, &linear}) {
    CHECK(!plan->on("bloom"));
    CHECK(plan->pass("bloom") == nullptr);
    CHECK(plan->target("bloom") == nullptr);
  }
  REQUIRE(on.pass("bloom"));
  REQUIRE(on.target("bloom"));
  CHECK(on.pass("bloom")->programs.size() == 3);
  CHECK(on.target("bloom")->bytes < 640u * 360 * 8 / 2);
  CHECK(on.target("bloom")->levels == 6);
}
