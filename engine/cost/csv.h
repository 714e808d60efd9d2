// The rungs of a cost report as a table (RFC 4180).
#pragma once
#include <burnish/measure.h>

#include <string>
#include <string_view>

namespace burnish::cost {

/// A text as a cell: quoted where it must be; what a spreadsheet would take for a formula gets an apostrophe in front.
std::string csvCell(std::string_view text);
/// A header with units, then a row a rung. Lines end with CR LF. What was not measured, or is not finite, is an empty cell.
std::string costCsv(const CostReport& cost);

}  // namespace burnish::cost
