#include "cost/spender.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace burnish::cost {
namespace {

constexpr int kRounds = 3, kVerifyRounds = 11;
constexpr std::size_t kBatch = 6, kStarts = 4, kVerified = 4, kHeardAgain = 3, kNeighbours = 24, kTogether = 6;
constexpr std::array kSlack{0.0, 0.02, 0.0, 0.05, 0.0, 0.1};  ///< how much more than the goal is looked at after so many batches without a better one, for models err; after the last the search ends
constexpr double kClearly = 2e-3;  ///< an error is lower where it is so by this share, and by the noise of ground truth
constexpr double kWorthTiming = 1.25;  ///< of the best error so far: what misses more is not timed
constexpr double kHopeless = 1.1;  ///< times the largest goal: what takes longer even with all that other settings save
constexpr double kFarTimes = 3;    ///< times beyond this many times the largest goal say nothing

bool clearlyLower(const PictureError& a, const PictureError& b) { return a.rms + std::max(kClearly * b.rms, a.rmsSpread) < b.rms; }

/// Seconds that are left for what has a share of the clock's time.
bool timeLeft(const Clock& clock, double until) { return !clock.stopped() && clock.left(until) > 0; }

}  // namespace

bool Spender::fits(const Goal& goal, const Sample& s) const {
  if (s.ratio.count == 0 || !s.pictured) return false;
  if (goal.ratio == 0) return s.error.rms <= goal.error;
  // The base's ratio to itself is no figure: it is 1. While the search goes on, what was timed but for it is judged by its median; in the end, and what was verified, all by their whole spread.
  if (s.choice == factors_.base()) return goal.ratio >= 1;
  return (decided_ || verified_.contains(s.choice) ? s.ratio.high : s.ratio.median) <= goal.ratio;
}

std::vector<Choice> Spender::ranked(const Goal& goal, std::size_t most) const {
  std::vector<std::pair<double, Choice>> sorted;
  for (const Sample& s : samples_.all())
    if (s.pictured && s.ratio.count > 0) sorted.emplace_back(fits(goal, s) ? (goal.ratio > 0 ? s.error.rms : s.ratio.median) : kUnfit + (goal.ratio > 0 ? s.ratio.median : s.error.rms), s.choice);
  std::sort(sorted.begin(), sorted.end());
  std::vector<Choice> out;
  for (auto& [score, choice] : sorted)
    if (out.size() < most) out.push_back(std::move(choice));
  return out;
}

const Sample* Spender::best(const Goal& goal) const {
  const auto first = ranked(goal, 1);
  return first.empty() ? nullptr : samples_.find(first.front());
}

const Sample* Spender::next(const Sample& best) const {
  const Sample* found = nullptr;
  for (const Sample& s : samples_.all())
    if (s.pictured && s.ratio.count > 0 && s.ratio.median > best.ratio.median && clearlyLower(s.error, best.error) && (!found || s.ratio.median < found->ratio.median)) found = &s;
  return found;
}

/// Those that there is no picture of yet.
Result<void> Spender::prepare(const std::vector<Choice>& choices) {
  if (!instrument_.prepare) return {};
  std::vector<Choice> wanted;
  for (const Choice& choice : choices)
    if (const Sample* sample = samples_.find(choice); !sample || !sample->pictured) wanted.push_back(choice);
  return wanted.empty() ? Result<void>() : instrument_.prepare(wanted);
}

Result<void> Spender::picture(const Choice& choice) {
  auto picture = instrument_.picture(choice);
  if (!picture) return fail(picture.error());
  samples_.picture(choice, picture->first, picture->second);
  ++measured_;
  return {};
}

Result<void> Spender::measure(const std::vector<Choice>& choices, const Goal& goal) {
  std::vector<Choice> timed;
  if (auto done = prepare(choices); !done) return done;
  for (const Choice& choice : choices) {
    const Sample* sample = samples_.find(choice);
    if (!sample || !sample->pictured)
      if (auto done = picture(choice); !done) return done;
    sample = samples_.find(choice);
    const Sample* leader = best(goal);
    const bool worth = goal.ratio == 0 || !leader || !fits(goal, *leader) || sample->error.rms <= kWorthTiming * leader->error.rms;
    if (sample->ratio.count == 0 && worth) timed.push_back(choice);
    if (auto end = stopped(); !end) return end;
  }
  if (timed.empty()) return {};
  const auto ratios = instrument_.time(timed, kRounds);
  if (!ratios) return fail(ratios.error());
  for (std::size_t i = 0; i < timed.size(); ++i) samples_.time(timed[i], (*ratios)[i]);
  return {};
}

Result<void> Spender::begin(const CostReport& cost, const std::vector<Goal>& goals, double until) {
  const double base = cost.base.ms.median;
  const Choice own = factors_.base();
  samples_.time(own, {1, 1, 1, cost.base.ms.count});
  for (const FrontPoint& point : cost.front) {
    const auto choice = factors_.choiceOf(point.quality);
    if (choice && *choice != own && point.ms.count > 0) samples_.time(*choice, {point.ms.median / base, point.ms.low / base, point.ms.high / base, point.ms.count});
  }
  // A setting alone can only be part of what a goal affords if the most that all others may save makes up for it.
  std::vector<double> saves(own.size(), 0);
  std::vector<Choice> singles{own};
  for (std::size_t f = 0; f < own.size(); ++f)
    for (std::size_t level = 0; level < factors_.all()[f].levels.size(); ++level) {
      Choice c = own;
      c[f] = std::uint16_t(level);
      const Sample* known = samples_.find(c);
      if (known && known->ratio.count > 0) saves[f] = std::max(saves[f], 1 - known->ratio.median);
      // Of the lobe's many combinations those that were measured stand for the rest.
      if (level != own[f] && (known || factors_.all()[f].levels[level].rungs.size() <= 1)) singles.push_back(c);
    }
  double most = 0, allSaves = 0;
  for (const double s : saves) allSaves += s;
  for (const Goal& goal : goals) most = std::max(most, goal.ratio > 0 ? goal.ratio : 1e9);
  mostRatio_ = kFarTimes * most;
  for (const auto& s : std::vector<Sample>(samples_.all())) {
    const bool single = std::find(singles.begin(), singles.end(), s.choice) != singles.end();
    if (!single && s.ratio.median <= mostRatio_) singles.push_back(s.choice);  // presets
  }
  const auto timed = [&](const Choice& c) {
    const Sample* known = samples_.find(c);
    return known && known->ratio.count > 0;
  };
  std::erase_if(singles, [&](const Choice& c) { return c != own && timed(c) && samples_.find(c)->ratio.median - allSaves > kHopeless * most; });
  std::vector<Choice> untimed;
  for (std::size_t i = 0; i < singles.size(); ++i) {
    if (i > 0 && !timeLeft(clock_, until)) break;
    clock_.tell(until * double(i) / double(singles.size()), "single settings");
    if (i % kTogether == 0)
      if (auto done = prepare({singles.begin() + std::ptrdiff_t(i), singles.begin() + std::ptrdiff_t(std::min(i + kTogether, singles.size()))}); !done) return done;
    if (auto done = picture(singles[i]); !done) return done;
    if (!timed(singles[i])) untimed.push_back(singles[i]);
    if (auto end = stopped(); !end) return end;
  }
  return measure(untimed, {0, 1e9});
}

/// Measures what the model promises for `wanted`; true: the best for `goal` is better now.
Result<bool> Spender::batch(const Goal& goal, const Goal& wanted) {
  const Model model(factors_, samples_, mostRatio_);
  std::set<Choice> known;
  for (const Sample& s : samples_.all())
    if (s.pictured) known.insert(s.choice);
  const Sample* leader = best(goal);
  const PictureError before = leader->error;
  const double ratioBefore = leader->ratio.median;
  const bool fitBefore = fits(goal, *leader);
  const std::vector<Choice> starts = ranked(wanted, kStarts);
  std::vector<std::vector<Proposal>> lists;
  for (const Manner manner : {Manner::Bold, Manner::Careful, Manner::Hopeful}) lists.push_back(propose(model, factors_, starts, wanted, known, manner, random_));
  lists.push_back(neighbours(model, factors_, starts.front(), wanted, known, kNeighbours));
  // In turn one of each list: what is expected, what is sure, what is hoped for, what is near.
  std::vector<Choice> chosen;
  for (std::size_t i = 0; i < kBatch; ++i)
    for (const auto& list : lists)
      if (chosen.size() < kBatch && i < list.size() && list[i].score < kUnfit && std::find(chosen.begin(), chosen.end(), list[i].choice) == chosen.end()) chosen.push_back(list[i].choice);
  if (chosen.empty())
    for (const auto& list : lists)
      if (!list.empty() && chosen.empty()) chosen.push_back(list.front().choice);  // nothing is promised to fit: what comes nearest
  if (auto done = measure(chosen, wanted); !done) return fail(done.error());
  leader = best(goal);
  if (fits(goal, *leader) != fitBefore) return true;
  return goal.ratio > 0 && fitBefore ? clearlyLower(leader->error, before) : leader->ratio.median < ratioBefore * (1 - kClearly);
}

Result<void> Spender::search(const Goal& goal, double until) {
  int dry = 0;
  while (dry < int(kSlack.size()) && timeLeft(clock_, until)) {
    const double more = 1 + kSlack[std::size_t(dry)];
    const auto better = batch(goal, {goal.ratio * more, goal.error * more});
    if (!better) return fail(better.error());
    dry = *better ? 0 : dry + 1;
    const Sample* leader = best(goal);
    if (goal.ratio > 0 && fits(goal, *leader) && leader->error.rms == 0) break;
  }
  // A little beyond: what the next milliseconds buy.
  for (const double more : {1.06, 1.15, 1.3}) {
    if (goal.ratio == 0 || !timeLeft(clock_, until)) break;
    if (const auto done = batch(goal, {goal.ratio * more, 0}); !done) return fail(done.error());
  }
  return stopped();
}

Result<void> Spender::verify(const Instrument& fresh, const std::vector<Goal>& goals) {
  // Thrice at most: what was refused makes room for the next.
  for (int turn = 0; turn < 3; ++turn) {
    std::vector<Choice> choices;
    for (const Goal& goal : goals)
      for (const Choice& choice : ranked(goal, turn == 0 ? kVerified : 2))
        if (choice != factors_.base() && !verified_.contains(choice) && std::find(choices.begin(), choices.end(), choice) == choices.end()) choices.push_back(choice);
    const bool settled = std::all_of(goals.begin(), goals.end(), [&](const Goal& goal) { return best(goal)->choice == factors_.base() || verified_.contains(best(goal)->choice); });
    if (choices.empty() || (turn > 0 && settled)) break;
    const auto ratios = fresh.time(choices, kVerifyRounds);
    if (!ratios) return fail(ratios.error());
    for (std::size_t i = 0; i < choices.size(); ++i) samples_.time(choices[i], (*ratios)[i]), verified_.insert(choices[i]);
  }
  decided_ = true;
  for (int turn = 0; turn < 2; ++turn)
    if (auto done = hearAgain(fresh, goals); !done) return done;
  return {};
}

/// What is more exact than the winner and may fit, if its spread is believed: times are disturbed in both directions.
Result<void> Spender::hearAgain(const Instrument& fresh, const std::vector<Goal>& goals) {
  std::vector<Choice> choices;
  for (const Goal& goal : goals) {
    const Sample* leader = best(goal);
    if (goal.ratio == 0 || !leader) continue;
    std::vector<const Sample*> doubtful;
    for (const Sample& s : samples_.all())
      if (s.pictured && s.ratio.count > 0 && s.ratio.low <= goal.ratio && !fits(goal, s) && (!fits(goal, *leader) || clearlyLower(s.error, leader->error))) doubtful.push_back(&s);
    const auto over = [&](const Sample* s) { return s->ratio.median > goal.ratio; };
    std::sort(doubtful.begin(), doubtful.end(), [&](const Sample* a, const Sample* b) { return std::pair(over(a), a->error.rms) < std::pair(over(b), b->error.rms); });
    if (doubtful.size() > kHeardAgain) doubtful.resize(kHeardAgain);
    for (const Sample* s : doubtful)
      if (std::find(choices.begin(), choices.end(), s->choice) == choices.end()) choices.push_back(s->choice);
  }
  if (choices.empty()) return {};
  const auto ratios = fresh.time(choices, kVerifyRounds);
  if (!ratios) return fail(ratios.error());
  for (std::size_t i = 0; i < choices.size(); ++i) samples_.time(choices[i], (*ratios)[i]), verified_.insert(choices[i]);
  return {};
}

}  // namespace burnish::cost
