// makePlan: what the scene, the views, the quality and the machine call for. Nothing else decides what a frame does.
#include "plan/plan.h"

#include <algorithm>

#include "plan/builder.h"
#include "plan/effects.h"
#include "plan/scaling.h"
#include "plan/temporal.h"

namespace burnish {
namespace {

template <class Row>
const Row* byName(const std::vector<Row>& rows, std::string_view name) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.name == name; });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace

bool FramePlan::on(std::string_view effect) const {
  const EffectPlan* e = byName(effects, effect);
  return e && e->on;
}
const PassPlan* FramePlan::pass(std::string_view name) const { return byName(passes, name); }
const TargetPlan* FramePlan::target(std::string_view name) const { return byName(targets, name); }

bool plan::reads(const FramePlan& plan, std::string_view what) {
  return std::any_of(plan.passes.begin(), plan.passes.end(), [what](const PassPlan& p) { return std::find(p.reads.begin(), p.reads.end(), what) != p.reads.end(); });
}

FramePlan plan::planOf(const Scene& scene, std::span<const Seen> views, const Quality& quality, const Capabilities& caps, const PlanOptions& options, const Facts* whole) {
  Situation situation{scene, views, quality, caps, options, shadedSize(quality, options), factsOf(scene, views, quality, options), whole, {}};
  judgeEffects(situation);
  Builder builder(situation);
  for (Step step : steps()) step(builder);
  return builder.finish();
}

FramePlan makePlan(const Scene& scene, std::span<const View> views, const Quality& quality, const Capabilities& caps, const PlanOptions& options) {
  scene::Derived derived;
  derived.update(scene);
  Report report;
  std::vector<plan::Seen> inView(views.size()), everywhere(views.size());
  const glm::ivec2 shaded = plan::shadedSize(quality, options);
  for (std::size_t i = 0; i < views.size(); ++i) {
    plan::look(scene, derived, views[i], options.size, quality, report, inView[i], {0, 0}, shaded);
    plan::lookEverywhere(scene, derived, views[i], options.size, quality, report, everywhere[i], shaded);
  }
  // Whatever is there may move one day.
  if (options.wholeScene && plan::keepsHistory(quality, options))
    for (plan::Seen& seen : everywhere)
      for (std::uint32_t i = 0; i < seen.instances.size(); ++i) seen.moved.push_back({i, {}});
  const plan::Facts whole = plan::factsOf(scene, everywhere, quality, options);
  return plan::planOf(scene, options.wholeScene ? everywhere : inView, quality, caps, options, &whole);
}

}  // namespace burnish
