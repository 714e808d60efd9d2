#include "cost/ladder.h"

#include <algorithm>
#include <future>

#include "cost/front.h"

namespace burnish::cost {
namespace {

void addNote(RungCost& rung, const std::string& text) { rung.note += (rung.note.empty() ? "" : "; ") + text; }

std::size_t exactIndex(const Ladder& ladder) {
  return std::size_t(std::find(ladder.what.rungs.begin(), ladder.what.rungs.end(), ladder.what.exact) - ladder.what.rungs.begin());
}

Result<void> stopped() { return fail("cost", "was stopped", "run it again"); }

// How far a picture is off is found on a thread of its own while the driver makes the next one's program, which keeps one core. Times are taken once all those threads are done.

std::vector<std::string> passesOf(const Bench& bench, const std::vector<Quality>& qualities) {
  std::vector<std::string> names;
  const FramePlan first = bench.plan(qualities.front());
  for (std::size_t i = 1; i < qualities.size(); ++i)
    for (std::string& name : changedPasses(first, bench.plan(qualities[i])))
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
  return names;
}

std::vector<Quality> besideExact(const Bench& bench, const Ladder& ladder) {
  std::vector<Quality> qualities;
  const Quality exact = exactOf(bench.base());
  for (const std::size_t rung : ladder.what.rungs) qualities.push_back(ladder.what.with(exact, rung));
  return qualities;
}

}  // namespace

Quality exactOf(const Quality& base) {
  Quality exact = base;
  (void)setPreset(exact, "exact");  // the name is known
  return exact;
}

Ladder ladderOf(const Bench& bench, TermToMeasure what) {
  Ladder ladder;
  const Term& term = terms()[what.term];
  ladder.cost.name = term.name;
  ladder.cost.what = term.what;
  ladder.cost.calledBy = what.calledBy;
  ladder.cost.setting = what.setting;
  ladder.cost.exactRung = term.rungs[what.exact].name;
  for (const std::size_t rung : what.rungs) {
    RungCost& cost = ladder.cost.rungs.emplace_back();
    cost.name = term.rungs[rung].name;
    cost.inForce = rungOf(bench.base(), what.term) == rung;
    if (term.rungs[rung].forwardOnly) cost.note = "needs the forward path";
    ladder.qualities.push_back(what.with(bench.base(), rung));
  }
  ladder.what = std::move(what);
  ladder.ratios.resize(ladder.qualities.size());
  ladder.passRatios.resize(ladder.qualities.size());
  ladder.passes = passesOf(bench, ladder.qualities);
  return ladder;
}

Result<void> judge(Bench& bench, Ladder& ladder, const Against& against) {
  const auto exact = bench.picture(ladder.qualities[exactIndex(ladder)]);
  if (!exact) return fail(exact.error());
  ladder.cost.exactPicture = bench.developed(**exact);
  ladder.whole.resize(ladder.qualities.size());
  std::vector<std::future<void>> work;
  for (std::size_t i = 0; i < ladder.qualities.size(); ++i) {
    const auto picture = bench.picture(ladder.qualities[i]);
    if (!picture) return fail(picture.error());
    work.push_back(std::async(std::launch::async, [&, i, linear = *picture] {
      RungCost& rung = ladder.cost.rungs[i];
      rung.picture = bench.developed(*linear);
      rung.exact = errorOf({*linear, rung.picture}, {**exact, ladder.cost.exactPicture});
      ladder.whole[i] = against(*linear, rung.picture);
      if (against.truth()) rung.truth = ladder.whole[i];
      rung.difference = differenceOf(*linear, **exact, bench.white());
    }));
  }
  return {};  // the futures wait for their threads
}

Result<void> timeRungs(Bench& bench, Ladder& ladder, int rounds, Clock& clock) {
  const auto timings = bench.time(ladder.qualities, rounds, ladder.passes, [&] { return !clock.stopped(); });
  if (!timings) return clock.stopped() ? stopped() : Result<void>(fail(timings.error()));
  for (std::size_t i = 0; i < timings->size(); ++i) ladder.ratios[i] = (*timings)[i].ratio, ladder.passRatios[i] = (*timings)[i].passesRatio;
  return {};
}

Result<void> judgeBesideExact(Bench& bench, Ladder& ladder, Clock& clock, double share) {
  const std::vector<Quality> qualities = besideExact(bench, ladder);
  const Image* exact = nullptr;
  Image exactDisplay;
  std::vector<std::future<void>> work;
  // The exact rung first: without it the others' pictures say nothing.
  std::vector<std::size_t> order(qualities.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::iter_swap(order.begin(), order.begin() + std::ptrdiff_t(exactIndex(ladder)));
  double slowest = 0;
  for (const std::size_t i : order) {
    RungCost& rung = ladder.cost.rungs[i];
    if (clock.left(share) < slowest) {
      addNote(rung, "not rendered beside the preset exact: the time was up");
      continue;
    }
    const double before = clock.seconds();
    const auto picture = bench.picture(qualities[i]);
    if (!picture) return fail(picture.error());
    if (!exact) exact = *picture, exactDisplay = bench.developed(*exact);
    rung.exactRestKnown = true;
    work.push_back(std::async(std::launch::async, [&, linear = *picture] { rung.exactRest = errorOf({*linear, bench.developed(*linear)}, {*exact, exactDisplay}); }));
    slowest = std::max(slowest, clock.seconds() - before);
    if (clock.stopped()) return stopped();
  }
  return {};
}

Result<void> timeBesideExact(Bench& bench, Ladder& ladder, Clock& clock) {
  const std::vector<Quality> qualities = besideExact(bench, ladder);
  const auto timings = bench.time(qualities, 3, passesOf(bench, qualities), [&] { return !clock.stopped(); });
  if (!timings) return clock.stopped() ? stopped() : Result<void>(fail(timings.error()));
  for (std::size_t i = 0; i < timings->size(); ++i) ladder.cost.rungs[i].exactPassMs = (*timings)[i].passes;
  return {};
}

void finish(Ladder& ladder, const Spread& baseFrame) {
  for (std::size_t i = 0; i < ladder.ratios.size(); ++i) {
    RungCost& rung = ladder.cost.rungs[i];
    if (ladder.ratios[i].count == 0) addNote(rung, "not timed: the time was up");
    rung.frameMs = times(ladder.ratios[i], baseFrame);
    rung.passMs = times(ladder.passRatios[i], baseFrame);
  }
  markDominated(ladder.cost.rungs, ladder.ratios);
}

}  // namespace burnish::cost
