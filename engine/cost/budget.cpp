// spendBudget: the quality for each budget, found by measuring combinations (docs/budget.md).
#include <fmt/format.h>

#include <algorithm>

#include "cost/front.h"
#include "cost/spender.h"

namespace burnish {
namespace {

using namespace cost;

// Shares of the time: single settings until the first, all goals until the second; the rest times the winners again.
constexpr double kSinglesUntil = 0.4, kSearchUntil = 0.85;

Result<void> check(const CostOptions& options, std::span<const BudgetOptions> budgets, const CostReport& cost) {
  for (const BudgetOptions& b : budgets)
    if (!(b.ms > 0) && !(b.targetError > 0)) return fail("budget", "asks for no time and no error", "set ms or targetError above 0");
  if (cost.size != options.size || cost.base.ms.count == 0) return fail("budget", "the report is not of this size, or has no times", "give what measureCost returned for the same options");
  if (options.truth && (options.truth->radiance.width != options.size.x || options.truth->radiance.height != options.size.y)) return fail("budget", "the reference is of another size", "give the one that measureCost had");
  return {};
}

FrontPoint pointOf(const Sample& sample, const Factors& factors, const CostReport& cost) {
  FrontPoint point;
  point.quality = factors.quality(sample.choice);
  point.settings = settingsOf(point.quality, cost.base.quality);
  point.ms = times(sample.ratio, cost.base.ms);
  point.error = sample.error;
  return point;
}

/// What was measured is on the front, each once, with its last times.
void extendFront(CostReport& cost, const Samples& samples, const Factors& factors) {
  for (const Sample& sample : samples.all()) {
    if (!sample.pictured || sample.ratio.count == 0 || sample.choice == factors.base()) continue;
    FrontPoint point = pointOf(sample, factors, cost);
    const auto known = std::find_if(cost.front.begin(), cost.front.end(), [&](const FrontPoint& p) { return factors.choiceOf(p.quality) == std::optional(sample.choice); });
    if (known == cost.front.end()) cost.front.push_back(std::move(point));
    else known->ms = point.ms;
  }
  sortFront(cost.front);
}

Quality exactBeside(const Quality& base) {
  Quality exact = base;
  (void)setPreset(exact, "exact");  // the name is known
  return exact;
}

/// Ground truth, or a copy of the exact picture that outlives the bench's.
struct Yardstick {
  Bench::Truth truth;
  Image exact;
  Against against;
};
Result<void> makeYardstick(Bench& bench, const CostOptions& options, Yardstick& out) {
  if (options.truth) {
    out.truth = bench.held(*options.truth);
    out.against = {&out.truth.radiance, &out.truth.variance, bench.developed(out.truth.radiance)};
    return {};
  }
  const auto picture = bench.picture(exactBeside(bench.base()));
  if (!picture) return fail(picture.error());
  out.exact = **picture;
  out.against = {&out.exact, nullptr, bench.developed(out.exact)};
  return {};
}

Instrument instrumentOf(Bench& bench, const Factors& factors, const Against& against) {
  Instrument out;
  out.picture = [&](const Choice& choice) -> Result<std::pair<Image, PictureError>> {
    const auto picture = bench.picture(factors.quality(choice));
    if (!picture) return fail(picture.error());
    return std::pair<Image, PictureError>{**picture, against(**picture, bench.developed(**picture))};
  };
  out.prepare = [&](const std::vector<Choice>& choices) -> Result<void> {
    bench.forget();
    std::vector<Quality> qualities;
    for (const Choice& choice : choices) qualities.push_back(factors.quality(choice));
    const auto pictures = bench.pictures(qualities);
    return pictures ? Result<void>() : fail(pictures.error());
  };
  out.time = [&](const std::vector<Choice>& choices, int rounds) -> Result<std::vector<Spread>> {
    std::vector<Quality> qualities;
    for (const Choice& choice : choices) qualities.push_back(factors.quality(choice));
    const auto timings = bench.time(qualities, rounds);
    if (!timings) return fail(timings.error());
    std::vector<Spread> ratios;
    for (const Timing& t : *timings) ratios.push_back(t.ratio);
    return ratios;
  };
  return out;
}

}  // namespace

Result<std::vector<BudgetResult>> spendBudget(const ProcAddress& getProcAddress, const Scene& scene, const View& view, const CostOptions& options, std::span<const BudgetOptions> budgets, CostReport& cost,
                                              Report& report) {
  if (auto good = check(options, budgets, cost); !good) return fail(good.error());
  if (budgets.empty()) return std::vector<BudgetResult>{};
  double minutes = 0;
  bool limited = true;
  for (const BudgetOptions& b : budgets) minutes += b.minutes, limited = limited && b.minutes > 0;
  Clock clock(limited ? minutes : 0, budgets.front().progress);
  auto bench = Bench::create(getProcAddress, scene, view, options.size, options.base, report);
  if (!bench) return fail(bench.error());
  (*bench)->assist(options.secondContext);
  Yardstick yardstick;
  if (auto made = makeYardstick(**bench, options, yardstick); !made) return fail(made.error());

  const Factors factors(**bench, options.terms, options.choices);
  std::vector<Goal> goals;
  for (const BudgetOptions& b : budgets) goals.push_back(b.ms > 0 ? Goal{b.ms / cost.base.ms.median, 0} : Goal{0, b.targetError});
  const Instrument instrument = instrumentOf(**bench, factors, yardstick.against);
  Spender spender(instrument, factors, yardstick.against, clock);
  if (auto done = spender.begin(cost, goals, kSinglesUntil); !done) return fail(done.error());
  const double from = limited ? std::min(clock.seconds() / (60 * minutes), kSinglesUntil) : 0;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const double until = from + (kSearchUntil - from) * double(i + 1) / double(goals.size());
    clock.tell(from + (kSearchUntil - from) * double(i) / double(goals.size()), budgets[i].ms > 0 ? fmt::format("combinations for {:.4g} ms", budgets[i].ms) : fmt::format("combinations for an error of {:.4g}", budgets[i].targetError));
    if (auto done = spender.search(goals[i], until); !done) return fail(done.error());
  }
  clock.tell(kSearchUntil, "the winners again");
  auto fresh = Bench::create(getProcAddress, scene, view, options.size, options.base, report);
  if (!fresh) return fail(fresh.error());
  if (auto done = spender.verify(instrumentOf(**fresh, factors, yardstick.against), goals); !done) return fail(done.error());

  extendFront(cost, spender.samples(), factors);
  std::vector<BudgetResult> results;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    BudgetResult result;
    result.ms = budgets[i].ms > 0 ? budgets[i].ms : 0;
    result.targetError = budgets[i].ms > 0 ? 0 : budgets[i].targetError;
    const Sample& best = *spender.best(goals[i]);
    result.met = spender.fits(goals[i], best);
    result.best = pointOf(best, factors, cost);
    if (const Sample* next = spender.next(best)) result.next = pointOf(*next, factors, cost);
    result.measured = spender.measured();
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace burnish
