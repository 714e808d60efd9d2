#include "cost/search.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace burnish::cost {
namespace {

constexpr int kKicks = 3;         ///< changed copies of each start
constexpr int kKicked = 3;        ///< factors that are changed in one
constexpr double kSame = 1e-4;    ///< choices whose predicted error and time differ by less are one

class Descent {
 public:
  Descent(const Model& model, const Factors& factors, const Goal& goal, Manner manner) : model_(model), factors_(factors), goal_(goal), manner_(manner) {}

  double score(const Choice& choice) {
    const auto [at, fresh] = seen_.try_emplace(choice);
    if (fresh) {
      Predicted& p = at->second.predicted = model_.at(choice);
      at->second.choice = choice;
      const double hope = std::sqrt(std::max(2 * p.error * p.error - p.sure * p.sure, 0.0));
      switch (manner_) {
        case Manner::Bold: at->second.score = scoreOf(goal_, p.error, p.ratio); break;
        case Manner::Careful: at->second.score = scoreOf(goal_, p.sure, p.ratio + p.deviation); break;
        case Manner::Hopeful: at->second.score = scoreOf(goal_, hope, p.ratio - p.deviation); break;
      }
    }
    return at->second.score;
  }
  /// To where no single change is better.
  Choice from(Choice choice, std::mt19937& random) {
    std::vector<std::size_t> order(choice.size());
    for (std::size_t f = 0; f < order.size(); ++f) order[f] = f;
    double best = score(choice);
    for (bool moved = true; moved;) {
      moved = false;
      std::shuffle(order.begin(), order.end(), random);
      for (const std::size_t f : order)
        for (std::size_t level = 0; level < factors_.all()[f].levels.size(); ++level) {
          Choice next = choice;
          next[f] = std::uint16_t(level);
          if (const double s = score(next); s < best) best = s, choice = next, moved = true;
        }
    }
    return choice;
  }
  [[nodiscard]] std::vector<Proposal> found(const std::set<Choice>& known) const {
    std::vector<Proposal> out;
    for (const auto& [choice, proposal] : seen_)
      if (!known.contains(choice)) out.push_back(proposal);
    std::stable_sort(out.begin(), out.end(), [](const Proposal& a, const Proposal& b) { return a.score < b.score; });
    return out;
  }

 private:
  const Model& model_;
  const Factors& factors_;
  const Goal& goal_;
  Manner manner_;
  std::map<Choice, Proposal> seen_;
};

/// Without those that are expected to be as another one is.
std::vector<Proposal> distinct(const std::vector<Proposal>& sorted, std::size_t most) {
  std::vector<Proposal> out;
  for (const Proposal& p : sorted) {
    const auto same = [&](const Proposal& o) { return std::abs(o.predicted.error - p.predicted.error) < kSame * p.predicted.error && std::abs(o.predicted.ratio - p.predicted.ratio) < kSame * p.predicted.ratio; };
    if (std::none_of(out.begin(), out.end(), same)) out.push_back(p);
    if (out.size() == most) break;
  }
  return out;
}

constexpr std::size_t kMostProposals = 32;

}  // namespace

double scoreOf(const Goal& goal, double error, double ratio) {
  if (goal.ratio > 0) return ratio <= goal.ratio ? error : kUnfit + ratio - goal.ratio;
  return error <= goal.error ? ratio : kUnfit + error - goal.error;
}

std::vector<Proposal> propose(const Model& model, const Factors& factors, const std::vector<Choice>& starts, const Goal& goal, const std::set<Choice>& known, Manner manner, std::mt19937& random) {
  Descent descent(model, factors, goal, manner);
  const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
  for (const Choice& start : starts) {
    const Choice settled = descent.from(start, random);
    for (int kick = 0; kick < kKicks; ++kick) {
      Choice changed = settled;
      for (int i = 0; i < kKicked; ++i) {
        const std::size_t f = below(changed.size());
        changed[f] = std::uint16_t(below(factors.all()[f].levels.size()));
      }
      descent.from(changed, random);
    }
  }
  return distinct(descent.found(known), kMostProposals);
}

std::vector<Proposal> neighbours(const Model& model, const Factors& factors, const Choice& center, const Goal& goal, const std::set<Choice>& known, std::size_t most) {
  Descent descent(model, factors, goal, Manner::Bold);
  std::vector<std::pair<double, std::pair<std::size_t, std::uint16_t>>> singles;
  for (std::size_t f = 0; f < center.size(); ++f)
    for (std::size_t level = 0; level < factors.all()[f].levels.size(); ++level) {
      Choice next = center;
      next[f] = std::uint16_t(level);
      if (level != center[f]) singles.push_back({descent.score(next), {f, std::uint16_t(level)}});
    }
  std::sort(singles.begin(), singles.end());
  if (singles.size() > most) singles.resize(most);
  for (const auto& a : singles)
    for (const auto& b : singles) {
      Choice next = center;
      next[a.second.first] = a.second.second;
      next[b.second.first] = b.second.second;
      descent.score(next);
    }
  return distinct(descent.found(known), kMostProposals);
}

}  // namespace burnish::cost
