// The choices that are no terms of the lighting equation: layouts, formats, sizes, how surroundings are filtered, probes. Each is a TermCost with `choice` set.
#pragma once
#include "cost/clock.h"
#include "cost/ladder.h"

namespace burnish::cost {

/// What was measured, and what was not, with the reason.
struct Choices {
  std::vector<TermCost> terms;
  std::vector<std::pair<std::string, std::string>> idle;
  /// Those that are settings of Quality, each with its ratio to the base's frame: points for the front.
  std::vector<std::pair<FrontPoint, Spread>> points;
};
struct ChoicesRun {
  const ProcAddress& getProcAddress;
  Bench& bench;
  const Against& against;
  const CostOptions& options;  ///< rounds, terms (names of choices among them; empty: all)
  Clock& clock;
  double share = 1;            ///< of the clock's time that may be used up when this ends
};
/// Measures what the scene exercises. When the time is short: fewer rounds, then no times, then nothing but the reason in `idle`.
Result<Choices> measureChoices(const ChoicesRun& run);

}  // namespace burnish::cost
