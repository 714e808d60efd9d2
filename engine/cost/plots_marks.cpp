#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "cost/page_text.h"
#include "cost/plots.h"

namespace burnish::cost {

std::string settingsText(const FrontPoint& point, std::string_view same) {
  if (point.settings.empty()) return std::string(same);
  return fmt::format("{}", fmt::join(point.settings, ", "));
}

std::string budgetName(const BudgetResult& budget) {
  if (budget.ms > 0) return fmt::format("budget {} ms", number(budget.ms));
  if (budget.targetError > 0) return "error under " + percent(budget.targetError);
  return "budget";
}

std::vector<std::string> ladderNames(const CostReport& cost) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const TermCost& term : cost.terms) {
    const std::string first = "ladder-" + slug(term.name);
    std::string name = first;
    for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}-{}", first, i);
    names.push_back(name);
  }
  return names;
}

std::vector<FrontMark> frontMarks(const CostReport& cost, const std::vector<BudgetResult>& budgets) {
  using Kind = FrontMark::Kind;
  std::vector<FrontMark> marks;
  const auto add = [&](const FrontPoint& point, Kind kind, const std::string& label) {
    if (!measured(point.ms) || !measured(point.error)) return;
    for (FrontMark& m : marks)
      if (m.point->quality == point.quality) {
        std::string& text = kind == Kind::Chosen ? m.chosen : m.label;
        if (!label.empty() && text.find(label) == std::string::npos) text += text.empty() ? label : kind == Kind::Chosen ? ", " + label : " (" + label + ")";
        m.kind = std::max(m.kind, kind);
        return;
      }
    marks.push_back({&point, kind, kind == Kind::Chosen ? "" : label, kind == Kind::Chosen ? label : ""});
  };
  // Points of the list first: they say whether they are dominated.
  for (const FrontPoint& p : cost.front) {
    const std::string preset(presetOf(cost, p));
    add(p, preset == "exact" ? Kind::Exact : !preset.empty() ? Kind::Preset : p.dominated ? Kind::Dominated : Kind::Front, preset);
  }
  add(cost.exact, Kind::Exact, "exact");
  for (const BudgetResult& b : budgets) add(b.best, Kind::Chosen, budgetName(b));
  add(cost.base, Kind::Base, "base");
  std::stable_sort(marks.begin(), marks.end(), [](const FrontMark& a, const FrontMark& b) { return a.point->ms.median < b.point->ms.median; });
  return marks;
}

}  // namespace burnish::cost
