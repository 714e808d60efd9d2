// The ladder of one term: pictures, errors and times of its rungs.
#pragma once
#include "cost/bench.h"
#include "cost/clock.h"
#include "cost/metrics.h"
#include "cost/terms.h"

namespace burnish::cost {

/// What whole qualities are held against: ground truth, or the picture of the preset `exact`.
struct Against {
  const Image* linear = nullptr;
  const Image* variance = nullptr;  ///< of ground truth
  Image display;                    ///< `linear`, developed
  [[nodiscard]] bool truth() const { return variance != nullptr; }
  [[nodiscard]] PictureError operator()(const Image& picture, const Image& developed) const { return errorOf({picture, developed}, {*linear, display}, variance); }
};

/// A term on its way through the measurement.
struct Ladder {
  TermToMeasure what;
  TermCost cost;
  std::vector<Quality> qualities;     ///< of each rung, the rest as in the base quality
  std::vector<PictureError> whole;    ///< of each rung's picture against Against
  std::vector<Spread> ratios, passRatios;  ///< of each rung's frame and changed passes to the base's frame; count 0: not timed
  std::vector<std::string> passes;    ///< that the rungs change
};

Ladder ladderOf(const Bench& bench, TermToMeasure what);
/// Pictures of all rungs and what they miss, the rest as in the base quality.
Result<void> judge(Bench& bench, Ladder& ladder, const Against& against);
/// Times of all rungs. Without time it leaves the ladder as it is.
Result<void> timeRungs(Bench& bench, Ladder& ladder, int rounds, Clock& clock);
/// Errors with the rest as in the preset `exact`. None is begun with less than `each` seconds left of that share of the time; those rungs get a note.
Result<void> judgeBesideExact(Bench& bench, Ladder& ladder, Clock& clock, double share, double each);
/// Times with the rest as in the preset `exact`, three rounds.
Result<void> timeBesideExact(Bench& bench, Ladder& ladder, Clock& clock);
/// Times in milliseconds once the base's frame is known, and the marks.
void finish(Ladder& ladder, const Spread& baseFrame);

/// The base quality with the rungs of the preset `exact`.
Quality exactOf(const Quality& base);

}  // namespace burnish::cost
