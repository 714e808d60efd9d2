// What burnish cost prints.
#pragma once
#include <burnish/measure.h>

namespace cli {

/// A table for each term, then the whole qualities, then what the error is made of.
void printCost(const burnish::CostReport& cost);

}  // namespace cli
