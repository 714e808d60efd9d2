// What the two builds of a plan, with an effect not called for and with it taken off the list, cost to make and to execute. Reported, not asserted:
// test_zero_cost "[times]" (docs/zero_cost.md).
#include <catch2/catch.hpp>

#include <chrono>

#include "zero_cost/cases.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr int kRounds = 21;

struct Spread {
  double low = 0, median = 0, high = 0;
};
Spread spreadOf(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return {v[v.size() / 4], v[v.size() / 2], v[v.size() * 3 / 4]};
}
std::string text(const Spread& s) { return fmt::format("{:8.3f} ({:.3f} to {:.3f})", s.median, s.low, s.high); }

template <class F>
double milliseconds(F&& f) {
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

PlanOptions optionsOf(const Subject& s, std::vector<std::string> removed) {
  PlanOptions o;
  o.size = s.size;
  o.output = s.output;
  o.removed = std::move(removed);
  return o;
}

}  // namespace

TEST_CASE("zero cost: times of the two builds of a plan", "[.][times]") {
  const auto context = openContext({.backend = testBackend()});
  for (const std::string_view name : kSamples) {
    Subject subject = sample(name);
    subject.size = {320, 180};
    auto target = OffscreenTarget::create(context->procAddress(), subject.size, Output::Display);
    REQUIRE(target);
    const auto rendererWithout = [&](std::vector<std::string> removed) {
      RendererOptions o;
      o.removedEffects = std::move(removed);
      auto made = Renderer::create(context->procAddress(), o);
      REQUIRE(made);
      return std::move(*made);
    };
    const auto off = rendererWithout({});
    const auto frame = [&](Renderer& r) {
      const auto drawn = r.render(subject.scene, {&subject.view, 1}, (*target)->target(), subject.quality, {.timing = TimingMode::Profile});
      REQUIRE(drawn);
    };
    for (int i = 0; i < 3; ++i) frame(*off);
    const FramePlan plan = off->lastPlan();
    fmt::print("{}: milliseconds, median (quartiles) of {} rounds in turns\n  {:<22} {:<28} {:<28} {:<28} {:<28}\n", name, kRounds, "effect, off", "plan", "plan, off the list", "frame", "frame, off the list");
    for (const EffectPlan& e : plan.effects) {
      if (e.on) continue;
      const auto without = rendererWithout({e.name});
      for (int i = 0; i < 3; ++i) frame(*without);
      std::vector<double> times[4];
      for (int i = 0; i < kRounds; ++i) {
        times[0].push_back(milliseconds([&] { (void)makePlan(subject.scene, {&subject.view, 1}, subject.quality, off->capabilities(), optionsOf(subject, {})); }));
        times[1].push_back(milliseconds([&] { (void)makePlan(subject.scene, {&subject.view, 1}, subject.quality, off->capabilities(), optionsOf(subject, {e.name})); }));
        times[2].push_back(milliseconds([&] { frame(*off); }));
        times[3].push_back(milliseconds([&] { frame(*without); }));
      }
      fmt::print("  {:<22} {:<28} {:<28} {:<28} {:<28}\n", e.name, text(spreadOf(times[0])), text(spreadOf(times[1])), text(spreadOf(times[2])), text(spreadOf(times[3])));
    }
  }
}
