// A cost report and its budgets as JSON (docs/cost_page.md has the schema).
#pragma once
#include <burnish/measure.h>

#include <string>
#include <vector>

namespace burnish::cost {

/// UTF-8, indented, with a line end. Numbers that are not finite, and what was not measured, are null.
std::string costJson(const CostReport& cost, const std::vector<BudgetResult>& budgets);

}  // namespace burnish::cost
