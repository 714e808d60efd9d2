// The plots of a cost report.
#pragma once
#include <burnish/measure.h>

#include <string>
#include <vector>

#include "cost/svg.h"

namespace burnish::cost {

struct Plot {
  std::string name;         ///< of its files, without an ending; also its id on the page
  std::string title, about;  ///< about: what it shows, in a sentence, for those who do not see it
  Svg drawing;
};

/// Time against error of whole qualities: presets, the base, the front, what it dominates, budgets.
Plot frontPlot(const CostReport& cost, const std::vector<BudgetResult>& budgets);
/// The rungs of a term from cheap to exact, with time and error. `name`: of its files.
Plot ladderPlot(const CostReport& cost, const TermCost& term, std::string name);
/// What closing each gap would take off the base quality's error.
Plot contributorsPlot(const CostReport& cost);

/// A point of the front's plot: what the page's table lists as well.
struct FrontMark {
  enum class Kind { Dominated, Front, Chosen, Preset, Exact, Base };  ///< a quality that is several of them is the last
  const FrontPoint* point = nullptr;
  Kind kind = Kind::Dominated;
  std::string label;   ///< "default (base)"; empty on plain points
  std::string chosen;  ///< for which budgets, "budget 12 ms"; empty: for none
};
/// Each quality once, by time; those without a time or an error are left out.
std::vector<FrontMark> frontMarks(const CostReport& cost, const std::vector<BudgetResult>& budgets);
/// "budget 12.3 ms", "error under 2.0 %", "budget".
std::string budgetName(const BudgetResult& budget);
/// "fresnel=none, lobe=pow" or `same` where there are none.
std::string settingsText(const FrontPoint& point, std::string_view same);
/// Names of the ladders' files, one a term, none twice.
std::vector<std::string> ladderNames(const CostReport& cost);

}  // namespace burnish::cost
