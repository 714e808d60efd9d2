#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cost/page_text.h"
#include "cost/plots.h"
#include "cost/plots_axis.h"

namespace burnish::cost {
namespace {

constexpr double kWidth = 960, kName = 14, kTimeLeft = 262, kTimeRight = 540, kTimeText = 612, kErrorLeft = 650, kErrorRight = 868, kErrorText = 946;
constexpr double kFirst = 52, kRow = 28;

/// What all rungs of a plot are timed by: the passes that they change, or the frame where no rung has those.
using Time = Spread RungCost::*;
Time timeOf(const TermCost& term) {
  return std::any_of(term.rungs.begin(), term.rungs.end(), [](const RungCost& r) { return measured(r.passMs); }) ? &RungCost::passMs : &RungCost::frameMs;
}

std::string tags(const TermCost& term, const RungCost& rung) {
  std::string text;
  for (const auto& [is, tag] : {std::pair{rung.inForce, "base"}, std::pair{rung.name == term.exactRung, "exact"}, std::pair{rung.dominated, "dominated"}})
    if (is) text += (text.empty() ? "" : " · ") + std::string(tag);
  return text;
}

void diamond(Svg& svg, double x, double y, double r, std::string_view style) {
  const double points[] = {x, y - r, x + r, y, x, y + r, x - r, y};
  svg.polyline(points, style, true);
}

void timeMark(Svg& svg, const Axis& axis, const RungCost& rung, const Spread& ms, double y) {
  if (!measured(ms)) {
    svg.text(kTimeText, y + 4, "n/a", "small", "end");
    return;
  }
  const double x = axis.at(ms.median);
  if (axis.logarithmic()) {
    svg.line(kTimeLeft, y, x, y, "guide");
    svg.circle(x, y, 5, rung.dominated ? "bar dim" : "bar");
  } else {
    svg.rect(kTimeLeft, y - 7, x - kTimeLeft, 14, rung.dominated ? "bar dim" : "bar", 1.5);
  }
  if (ms.count > 1 && std::isfinite(ms.low) && std::isfinite(ms.high)) {
    const double low = axis.at(ms.low), high = axis.at(ms.high);
    if (!axis.logarithmic() || high - low > 10) svg.line(low, y, high, y, "whisker");
    for (const double end : {low, high})
      if (!axis.logarithmic() || high - low > 10) svg.line(end, y - 4, end, y + 4, "whisker");
  }
  svg.text(kTimeText, y + 4, number(ms.median, 4), "", "end");
}

void errorMarks(Svg& svg, const Axis& axis, const TermCost& term, const RungCost& rung, double y) {
  svg.line(kErrorLeft, y, kErrorRight, y, "guide");
  if (measured(rung.truth)) {
    const double x = axis.at(rung.truth.rms);
    if (rung.truth.rmsSpread > 0 && std::isfinite(rung.truth.rmsSpread))
      svg.line(axis.at(rung.truth.rms - rung.truth.rmsSpread), y, axis.at(rung.truth.rms + rung.truth.rmsSpread), y, "spread");
    svg.rect(x - 4, y - 4, 8, 8, "dot truth");
  }
  if (measured(rung.exactRest) && rung.name != term.exactRung) svg.circle(axis.at(rung.exactRest.rms), y, 5, "hollow");
  if (measured(rung.exact)) {
    if (rung.name == term.exactRung) diamond(svg, axis.at(rung.exact.rms), y, 6.5, "dot best");
    else svg.circle(axis.at(rung.exact.rms), y, 5, "dot error");
  }
  svg.text(kErrorText, y + 4, measured(rung.exact) ? percent(rung.exact.rms) : "n/a", measured(rung.exact) ? "" : "small", "end");
}

void legend(Svg& svg, const TermCost& term, double y) {
  double x = kErrorRight;
  const auto entry = [&](std::string_view text, const auto& symbol) {
    x -= textWidth(text, 11);
    svg.text(x, y + 4, text, "small");
    x -= 12;
    symbol(x, y);
    x -= 20;
  };
  const auto any = [&](PictureError RungCost::* error) { return std::any_of(term.rungs.begin(), term.rungs.end(), [&](const RungCost& r) { return measured(r.*error); }); };
  if (any(&RungCost::truth)) entry("against ground truth", [&](double sx, double sy) { svg.rect(sx - 4, sy - 4, 8, 8, "dot truth"); });
  entry("the exact rung", [&](double sx, double sy) { diamond(svg, sx, sy, 6, "dot best"); });
  if (any(&RungCost::exactRest)) entry("the rest exact", [&](double sx, double sy) { svg.circle(sx, sy, 4.5, "hollow"); });
  entry("against exact, the rest as in the base", [&](double sx, double sy) { svg.circle(sx, sy, 4.5, "dot error"); });
}

std::string rowLabel(const TermCost& term, const RungCost& rung, const Spread& ms) {
  const std::string marks = tags(term, rung);
  std::string text = fmt::format("{}{}: {} ms, error against exact {}", rung.name, marks.empty() ? "" : " (" + marks + ")", spreadText(ms),
                                 measured(rung.exact) ? percent(rung.exact.rms) : "n/a");
  if (measured(rung.truth)) text += ", against ground truth " + percent(rung.truth.rms);
  return text;
}

}  // namespace

Plot ladderPlot(const CostReport& cost, const TermCost& term, std::string name) {
  const Time timed = timeOf(term);
  std::vector<double> times, errors;
  for (const RungCost& r : term.rungs) {
    if (measured(r.*timed)) times.insert(times.end(), {(r.*timed).median, (r.*timed).high});
    for (const PictureError* e : {&r.exact, &r.exactRest, &r.truth})
      if (measured(*e)) errors.push_back(e->rms);
  }
  const auto largest = std::max_element(times.begin(), times.end()), least = std::min_element(times.begin(), times.end());
  // Bars start from zero; where one rung takes many times as long as another, dots on a logarithmic axis.
  const bool wide = !times.empty() && *largest > 8 * *least;
  const Axis time(times, wide ? Axis::Scale::Logarithmic : Axis::Scale::FromZero, kTimeLeft, kTimeRight, false), error(errors, Axis::Scale::Logarithmic, kErrorLeft, kErrorRight, true);
  const double bottom = kFirst + kRow * static_cast<double>(std::max<std::size_t>(term.rungs.size(), 1)), height = bottom + 62;
  Svg svg(kWidth, height);
  svg.text(kName, 24, term.choice ? "setting" : "rung, cheap to exact ↓", "strong");
  svg.text(kTimeLeft, 24, fitted(fmt::format("{}, ms of {}{}", timed == &RungCost::frameMs ? "frame" : "its passes", cost.clock.empty() ? "time" : cost.clock, wide ? ", logarithmic" : ""), 12, kTimeText - kTimeLeft), "strong");
  svg.text(kErrorLeft, 24, "error: rms, logarithmic", "strong");
  for (std::size_t i = 0; i < term.rungs.size(); ++i)
    if (term.rungs[i].inForce) svg.rect(6, kFirst + kRow * static_cast<double>(i), kWidth - 12, kRow, "band", 3);
  for (const Axis* axis : {&time, &error})
    for (const AxisTick& t : axis->ticks()) {
      svg.line(t.at, kFirst - 8, t.at, bottom + 4, "grid");
      if (!t.label.empty()) svg.text(t.at, bottom + 18, t.label, "small", "middle");
    }
  for (std::size_t i = 0; i < term.rungs.size(); ++i) {
    const RungCost& rung = term.rungs[i];
    const double y = kFirst + kRow * (static_cast<double>(i) + 0.5);
    svg.beginGroup("row", rowLabel(term, rung, rung.*timed));
    const std::string tag = tags(term, rung);
    const double tagWidth = tag.empty() ? 0 : textWidth(tag, 11) + 8;
    svg.text(kName, y + 4, fitted(rung.name, 12, kTimeLeft - kName - 10 - tagWidth), rung.inForce ? "strong" : "");
    if (!tag.empty()) svg.text(kTimeLeft - 10, y + 4, tag, "small", "end");
    timeMark(svg, time, rung, rung.*timed, y);
    errorMarks(svg, error, term, rung, y);
    svg.endGroup();
  }
  if (term.rungs.empty()) svg.text(kName, kFirst + 18, "nothing was measured", "soft");
  svg.line(kTimeLeft, kFirst - 8, kTimeLeft, bottom + 4, "axis");
  legend(svg, term, height - 16);
  return {std::move(name), fmt::format("{}: time and error of its {}", term.name, term.choice ? "settings" : "rungs"),
          fmt::format("{} {} from cheap to exact, with the time of their passes and their error against {}.", term.rungs.size(), term.choice ? "settings" : "rungs",
                      term.exactRung.empty() ? "the exact one" : term.exactRung),
          std::move(svg)};
}

}  // namespace burnish::cost
