#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cost/page_text.h"
#include "cost/plots.h"
#include "cost/plots_axis.h"

namespace burnish::cost {
namespace {

constexpr double kWidth = 960, kLeft = 14, kRight = 720, kText = 946, kFirst = 40, kRow = 42;  // a name over each bar: they are sentences
constexpr std::size_t kMost = 14;  // bars; the table has the rest

}  // namespace

Plot contributorsPlot(const CostReport& cost) {
  std::vector<std::pair<std::string, double>> bars;
  for (const auto& [name, gain] : cost.contributors)
    if (std::isfinite(gain) && bars.size() < kMost) bars.emplace_back(name, gain);
  std::vector<double> sizes;
  for (const auto& bar : bars) sizes.push_back(std::abs(bar.second));
  const Axis axis(sizes, Axis::Scale::FromZero, kLeft, kRight, true);
  const double bottom = kFirst + kRow * static_cast<double>(std::max<std::size_t>(bars.size(), 1));
  Svg svg(kWidth, bottom + 30);
  svg.text(kLeft, 22, "gap to close, and what that takes off the error (rms)", "strong");
  svg.text(kText, 22, "share of the error", "strong", "end");
  for (const AxisTick& t : axis.ticks()) {
    svg.line(t.at, kFirst - 8, t.at, bottom + 4, "grid");
    if (!t.label.empty()) svg.text(t.at, bottom + 18, t.label, "small", "middle");
  }
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const auto& [name, gain] = bars[i];
    const double top = kFirst + kRow * static_cast<double>(i), y = top + 29;  // y: the bar's middle
    const bool share = std::isfinite(cost.base.error.rms) && cost.base.error.rms > 0;
    svg.beginGroup("row", fmt::format("{}: {} of rms", name, signedPercent(-gain)));
    svg.text(kLeft, top + 15, fitted(name, 12, kText - kLeft), "");
    // A gap whose closing adds to the error is drawn hollow: errors of terms cancel there.
    svg.rect(kLeft, y - 7, axis.at(std::abs(gain)) - kLeft, 14, gain >= 0 ? "bar gain" : "hollow", 1.5);
    svg.text(axis.at(std::abs(gain)) + 8, y + 4, signedPercent(-gain), "");
    svg.text(kText, y + 4, share ? percent(gain / cost.base.error.rms) : "n/a", "", "end");
    svg.endGroup();
  }
  if (bars.empty()) svg.text(14, kFirst + 18, "nothing was measured", "soft");
  svg.line(kLeft, kFirst - 8, kLeft, bottom + 4, "axis");
  return {"contributors", "What to improve next", fmt::format("The {} gaps whose closing takes most off the error of the base quality against {}.", bars.size(), cost.against.empty() ? "exact" : cost.against), std::move(svg)};
}

}  // namespace burnish::cost
