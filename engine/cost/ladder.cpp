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

// How far pictures are off is found on a thread for each. Times are taken once all those are done.

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
  const auto pictures = bench.pictures(ladder.qualities);
  if (!pictures) return fail(pictures.error());
  const Image& exact = *(*pictures)[exactIndex(ladder)];
  ladder.cost.exactPicture = bench.developed(exact);
  ladder.whole.resize(ladder.qualities.size());
  std::vector<std::future<void>> work;
  for (std::size_t i = 0; i < ladder.qualities.size(); ++i) {
    work.push_back(std::async(std::launch::async, [&, i, linear = (*pictures)[i]] {
      RungCost& rung = ladder.cost.rungs[i];
      rung.picture = bench.developed(*linear);
      rung.exact = errorOf({*linear, rung.picture}, {exact, ladder.cost.exactPicture});
      ladder.whole[i] = against(*linear, rung.picture);
      if (against.truth()) rung.truth = ladder.whole[i];
      rung.difference = differenceOf(*linear, exact, bench.white());
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

Result<void> judgeBesideExact(Bench& bench, Ladder& ladder, Clock& clock, double share, double each) {
  const std::vector<Quality> qualities = besideExact(bench, ladder);
  const auto goOn = [&] { return !clock.stopped() && clock.left(share) > each; };
  // Without the exact rung's the others' pictures say nothing.
  const Image* exact = nullptr;
  if (goOn()) {
    const auto first = bench.picture(qualities[exactIndex(ladder)]);
    if (!first) return fail(first.error());
    exact = *first;
  }
  std::vector<const Image*> pictures(qualities.size(), nullptr);
  if (exact) {
    auto made = bench.pictures(qualities, goOn);
    if (!made) return fail(made.error());
    pictures = std::move(*made);
  }
  const Image exactDisplay = exact ? bench.developed(*exact) : Image();
  std::vector<std::future<void>> work;
  for (std::size_t i = 0; i < qualities.size(); ++i) {
    RungCost& rung = ladder.cost.rungs[i];
    if (!pictures[i]) {
      addNote(rung, "not rendered beside the preset exact: the time was up");
      continue;
    }
    rung.exactRestKnown = true;
    work.push_back(std::async(std::launch::async, [&, linear = pictures[i]] { rung.exactRest = errorOf({*linear, bench.developed(*linear)}, {*exact, exactDisplay}); }));
  }
  return clock.stopped() ? stopped() : Result<void>();
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
