// Choices that are settings of Quality: which the scene exercises, with which settings.
#pragma once
#include "cost/bench.h"

namespace burnish::cost {

struct Setting {
  std::string name, note;
  Quality quality;
  bool inForce = false;  ///< the base quality has it
};
struct QualityChoice {
  std::string name, what;
  std::string calledBy;           ///< what in the scene exercises it
  std::vector<Setting> settings;  ///< cheap to exact
  std::size_t exact = 0;          ///< what errors count against
  std::vector<std::string> passes;  ///< that it changes, beside those that the plans tell apart
};
/// Choices in this view, but for those that `only` leaves out (empty: none). `idle`: what the scene does not exercise, with the reason.
std::vector<QualityChoice> choicesOf(const Bench& bench, const std::vector<std::string>& only, std::vector<std::pair<std::string, std::string>>& idle);

/// Nothing is asked for in `only`, or this is.
bool asked(const std::vector<std::string>& only, std::string_view name);

}  // namespace burnish::cost
