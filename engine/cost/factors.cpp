#include "cost/factors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "cost/terms.h"

namespace burnish::cost {
namespace {

constexpr std::array<std::string_view, 5> kLobeTerms{"specular", "distribution", "geometry", "normalization", "lobe"};
/// Left as the base has them: what pictures are compared without, and the format of the light buffer.
constexpr std::array<std::string_view, 4> kLeftAlone{"antialiasing", "specular-antialiasing", "bloom", "light-buffer"};
constexpr std::array<int, 4> kShadowResolutions{256, 512, 1024, 2048};
constexpr std::array<float, 5> kScales{0.3536f, 0.5f, 0.7071f, 0.85f, 1};
constexpr double kSharedRung = 0.5;  ///< Factor::alike of two lobes for each rung in which they differ, and of neighbours in size

template <class List>
bool contains(const List& list, std::string_view name) { return std::find(list.begin(), list.end(), name) != list.end(); }

Factor factorOf(const TermToMeasure& term) {
  Factor f;
  f.name = terms()[term.term].name;
  for (const std::size_t rung : term.rungs) f.levels.push_back({{{term.term, rung}}, 0, 0});
  return f;
}

/// All combinations of the rungs of the lobe's terms in which none is idle.
Factor lobeFactor(const std::vector<const TermToMeasure*>& parts, const Quality& base) {
  Factor f;
  f.name = "lobe model";
  std::size_t count = 1;
  for (const TermToMeasure* part : parts) count *= part->rungs.size();
  for (std::size_t i = 0; i < count; ++i) {
    Level level;
    Quality q;  // of other terms nothing is idle
    std::size_t rest = i;
    for (const TermToMeasure* part : parts) {
      level.rungs.emplace_back(part->term, part->rungs[rest % part->rungs.size()]);
      rest /= part->rungs.size();
    }
    level.apply(q);
    if (idleRungs(q).empty() || level.holds(base)) f.levels.push_back(std::move(level));
  }
  return f;
}

int differences(const Level& a, const Level& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.rungs.size(); ++i) count += a.rungs[i].second != b.rungs[i].second ? 1 : 0;
  return count;
}

/// Puts the base's own setting in where it is none of the levels, and finds it.
void settle(Factor& f, const Level& own, const Quality& base) {
  const auto found = std::find_if(f.levels.begin(), f.levels.end(), [&](const Level& l) { return l.holds(base); });
  f.base = std::size_t(found - f.levels.begin());
  if (found == f.levels.end()) f.levels.push_back(own);
  f.alike.assign(f.levels.size(), std::vector<double>(f.levels.size(), 0));
  for (std::size_t i = 0; i < f.levels.size(); ++i)
    for (std::size_t j = 0; j < f.levels.size(); ++j) {
      if (i == j) f.alike[i][j] = 1;
      else if (f.levels[i].rungs.size() > 1) f.alike[i][j] = std::pow(kSharedRung, differences(f.levels[i], f.levels[j]));
      else if (f.levels[i].rungs.empty()) f.alike[i][j] = std::pow(kSharedRung, std::abs(double(i) - double(j)));
    }
}

/// The level that the quality has. A rung that does not apply here (it is none of the levels) is what it falls back to, the next cheaper one.
auto levelOf(const Factor& f, const Quality& quality) {
  const auto at = [&](const Quality& q) { return std::find_if(f.levels.begin(), f.levels.end(), [&](const Level& l) { return l.holds(q); }); };
  auto found = at(quality);
  if (f.levels.front().rungs.size() != 1) return found;
  const std::size_t term = f.levels.front().rungs.front().first;
  Quality q = quality;
  for (std::size_t rung = rungOf(q, term); found == f.levels.end() && rung > 0 && !terms()[term].rungs[rung].forwardOnly; found = at(q)) setRung(q, term, --rung);
  return found;
}

Level ownLevel(const Factor& f, const Quality& base) {
  Level own = f.levels.front();
  for (auto& [term, rung] : own.rungs) rung = rungOf(base, term);
  if (own.shadowResolution > 0) own.shadowResolution = base.shadowResolution;
  if (own.resolutionScale > 0) own.resolutionScale = base.resolutionScale;
  return own;
}

}  // namespace

void Level::apply(Quality& quality) const {
  for (const auto& [term, rung] : rungs) setRung(quality, term, rung);
  if (shadowResolution > 0) quality.shadowResolution = shadowResolution;
  if (resolutionScale > 0) quality.resolutionScale = resolutionScale;
}

bool Level::holds(const Quality& quality) const {
  return std::all_of(rungs.begin(), rungs.end(), [&](const auto& r) { return rungOf(quality, r.first) == r.second; }) && (shadowResolution == 0 || quality.shadowResolution == shadowResolution) &&
         (resolutionScale == 0 || quality.resolutionScale == resolutionScale);
}

Factors::Factors(const Bench& bench, const std::vector<std::string>& only, bool sizes) : base_(bench.base()) {
  const auto planOf = [&](const Quality& q) { return bench.plan(q); };
  const TermsToMeasure found = termsToMeasure(bench.scene(), bench.view(), bench.size(), base_, planOf, only);
  std::vector<const TermToMeasure*> lobe;
  for (const TermToMeasure& term : found.terms) {
    const std::string_view name = terms()[term.term].name;
    if (contains(kLeftAlone, name)) continue;
    if (contains(kLobeTerms, name)) lobe.push_back(&term);
    else factors_.push_back(factorOf(term));
  }
  if (!lobe.empty()) factors_.insert(factors_.begin(), lobeFactor(lobe, base_));
  const auto changes = [&](const Factor& f) {
    return std::any_of(f.levels.begin(), f.levels.end(), [&](const Level& level) {
      Quality other = base_;
      level.apply(other);
      return !changedPasses(bench.plan(base_), bench.plan(other)).empty();
    });
  };
  for (std::size_t t = 0; t < terms().size(); ++t) {
    const std::string_view name = terms()[t].name;
    if (contains(kLeftAlone, name) || std::any_of(found.terms.begin(), found.terms.end(), [&](const TermToMeasure& m) { return m.term == t; })) continue;
    if (std::any_of(found.idle.begin(), found.idle.end(), [&](const auto& i) { return i.first == name; })) {
      idle_.push_back(t);
    } else if (sizes && only.empty()) {  // measured among the choices, as how the G-buffer holds normals
      TermToMeasure all;
      all.term = t;
      for (std::size_t r = 0; r < terms()[t].rungs.size(); ++r) all.rungs.push_back(r);
      if (Factor f = factorOf(all); changes(f)) factors_.push_back(std::move(f));
    }
  }
  if (sizes) {
    Factor shadows, scale;
    shadows.name = "shadow-resolution", scale.name = "resolution-scale";
    for (const int texels : kShadowResolutions) shadows.levels.push_back({{}, texels, 0});
    for (const float s : kScales) scale.levels.push_back({{}, 0, s});
    for (Factor& f : {std::ref(shadows), std::ref(scale)})
      if (changes(f)) factors_.push_back(std::move(f));
  }
  for (Factor& f : factors_) settle(f, ownLevel(f, base_), base_);
}

Factors::Factors(const Quality& base, std::vector<Factor> factors) : base_(base), factors_(std::move(factors)) {
  for (Factor& f : factors_) settle(f, ownLevel(f, base_), base_);
}

Choice Factors::base() const {
  Choice c;
  for (const Factor& f : factors_) c.push_back(std::uint16_t(f.base));
  return c;
}

Quality Factors::quality(const Choice& choice) const {
  Quality q = base_;
  for (std::size_t i = 0; i < factors_.size(); ++i) factors_[i].levels[choice[i]].apply(q);
  return q;
}

std::optional<Choice> Factors::choiceOf(const Quality& quality) const {
  Choice c;
  Quality rest = quality;
  for (const Factor& f : factors_) {
    const auto found = levelOf(f, quality);
    if (found == f.levels.end()) return {};
    c.push_back(std::uint16_t(found - f.levels.begin()));
    f.levels[f.base].apply(rest);
  }
  for (const std::size_t t : idle_) setRung(rest, t, rungOf(base_, t));
  return rest == base_ ? std::optional(c) : std::nullopt;
}

}  // namespace burnish::cost
