// Reports made up for tests of the page: no renderer, the same figures and pictures every time.
#pragma once
#include <burnish/measure.h>

namespace burnish::test {

struct MadeReport {
  CostReport cost;
  std::vector<BudgetResult> budgets;
};
/// Everything that a report can hold: six terms and a choice, pictures, a front of 40 qualities, budgets by time (met and not) and by error, warnings.
MadeReport fullReport();
/// Texts that try to be markup, script, formulas, control characters, broken UTF-8 and far too long; figures that are not finite; a term of 60 rungs; a term of none; pictures of no size.
MadeReport hostileReport();

}  // namespace burnish::test
