// Whole qualities: what differs, which are on the front, what the base quality's error is made of.
#pragma once
#include <burnish/measure.h>

namespace burnish::cost {

/// "term=rung" of each term that differs, then numbers of sizes.
std::vector<std::string> settingsOf(const Quality& quality, const Quality& base);

/// Sorts by time and marks as dominated what another point beats: no slower and no less exact, and better in one.
void sortFront(std::vector<FrontPoint>& front);

/// Marks rungs as dominated (RungCost::dominated). `ratios`: of each rung's frame to the base's, in the order of `rungs`; count 0 where it was not timed: such a rung dominates nothing.
void markDominated(std::vector<RungCost>& rungs, const std::vector<Spread>& ratios);

/// Fills CostReport::contributors from its terms, base and exact. `missing`: name of the gap that the preset `exact` leaves.
void findContributors(CostReport& report, const std::string& missing);

}  // namespace burnish::cost
