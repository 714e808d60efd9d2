// The page of a cost report: one HTML file that needs nothing else.
#pragma once
#include <burnish/measure.h>

#include <string>
#include <string_view>
#include <vector>

#include "cost/page_pictures.h"
#include "cost/plots.h"

namespace burnish::cost {

/// What the parts of a page are made of.
struct PageInput {
  const CostReport& cost;
  const std::vector<BudgetResult>& budgets;
  const std::vector<Plot>& ladders;  ///< one a term
  PagePictures& pictures;
};

/// The whole page. Pictures shrink until it is under some 15 MB; what does not fit is left out with a warning.
std::string costPage(const CostReport& cost, const std::vector<BudgetResult>& budgets, const std::vector<Plot>& ladders, Report& report);

// Its parts, from top to bottom, each an HTML section.
std::string pageHead(const PageInput& in);      ///< scene, machine, command
std::string pageBase(const PageInput& in);      ///< the base quality against ground truth, what to improve next
std::string pageFront(const PageInput& in);     ///< time against error
std::string pageBudgets(const PageInput& in);   ///< what was chosen, what the next millisecond buys
std::string pageTerms(const PageInput& in, bool choices);  ///< ladders with tables and pictures
std::string pageTail(const PageInput& in);      ///< what was not exercised, how sure the figures are, warnings, glossary
std::string pageStyle();
std::string_view pageScript();

/// The table of a term's rungs and their pictures beside the exact one.
std::string rungTable(const PageInput& in, const TermCost& term);
std::string rungPictures(const PageInput& in, const TermCost& term);

// Small pieces.
std::string plotBox(const Plot& plot);                                           ///< scrolls sideways where the screen is narrow
std::string scrollBox(std::string_view label, std::string_view table);           ///< the same of a table; the keyboard reaches it
std::string colourBar(const PageInput& in);                                      ///< the scale of difference pictures
/// Two pictures in one place: the first, and while it is checked the second.
std::string flipBox(const PageInput& in, const Image& first, std::string_view firstName, const Image& second, std::string_view secondName);
std::string baseName(const CostReport& cost);                                    ///< "default", or "base"

}  // namespace burnish::cost
