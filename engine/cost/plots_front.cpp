#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cost/page_text.h"
#include "cost/plots.h"
#include "cost/plots_axis.h"

namespace burnish::cost {
namespace {

using Kind = FrontMark::Kind;
constexpr double kWidth = 960, kHeight = 540, kLeft = 78, kRight = 936, kTop = 62, kBottom = 486;

struct Box {
  double left, top, right, bottom;
  [[nodiscard]] bool meets(const Box& o) const { return left < o.right && o.left < right && top < o.bottom && o.top < bottom; }
};

/// Draws texts beside points, where neither another text nor a point is.
class Labels {
 public:
  void keepOff(const Box& box) { taken_.push_back(box); }
  void place(Svg& svg, double x, double y, std::string_view text, std::string_view style) {
    const double width = textWidth(text, 12);
    const std::array<std::pair<double, double>, 8> corners{{{10, 4}, {-10 - width, 4}, {-width / 2, -12}, {-width / 2, 22}, {9, -9}, {9, 19}, {-9 - width, -9}, {-9 - width, 19}}};
    for (const double away : {1.0, 2.0, 3.4}) {
      for (const auto& [dx, dy] : corners) {
        const double at = x + (dx < -10 ? dx - (away - 1) * 10 : dx + (away - 1) * 10), line = y + 4 + (dy - 4) * away;
        const Box box{at - 2, line - 12, at + width + 2, line + 4};
        if (box.left < kLeft || box.right > kRight || box.top < kTop || box.bottom > kBottom) continue;
        if (std::any_of(taken_.begin(), taken_.end(), [&](const Box& b) { return b.meets(box); })) continue;
        taken_.push_back(box);
        svg.text(at, line, text, style);
        return;
      }
    }
    placeAway(svg, x, y, text, style, width);
  }

 private:
  /// Farther off, with a line to its point. No room at all: the title and the table have it.
  void placeAway(Svg& svg, double x, double y, std::string_view text, std::string_view style, double width) {
    for (const double away : {36.0, 56.0, 80.0, 110.0, 150.0})
      for (int turn = 0; turn < 16; ++turn) {
        const double angle = (turn * 7 % 16) * std::numbers::pi / 8, dx = std::cos(angle), dy = std::sin(angle);
        const double cx = x + dx * (away + std::abs(dx) * width / 2), cy = y + dy * away;
        const Box box{cx - width / 2 - 2, cy - 9, cx + width / 2 + 2, cy + 7};
        if (box.left < kLeft || box.right > kRight || box.top < kTop || box.bottom > kBottom) continue;
        if (std::any_of(taken_.begin(), taken_.end(), [&](const Box& b) { return b.meets(box); })) continue;
        taken_.push_back(box);
        svg.line(x + dx * 7, y + dy * 7, std::clamp(x + dx * away, box.left, box.right), cy + (dy < 0 ? 8 : -9) * (std::abs(dy) > 0.5), "spread");
        svg.text(cx, cy + 4, text, style, "middle");
        return;
      }
  }

  std::vector<Box> taken_;
};

void diamond(Svg& svg, double x, double y, double r, std::string_view style) {
  const double points[] = {x, y - r, x + r, y, x, y + r, x - r, y};
  svg.polyline(points, style, true);
}

void symbol(Svg& svg, Kind kind, double x, double y) {
  if (kind == Kind::Dominated) svg.circle(x, y, 3, "other");
  if (kind == Kind::Front) svg.circle(x, y, 4.5, "dot time");
  if (kind == Kind::Preset) diamond(svg, x, y, 6.5, "dot truth");
  if (kind == Kind::Base) svg.rect(x - 5, y - 5, 10, 10, "dot error");
  if (kind == Kind::Exact) diamond(svg, x, y, 7, "dot best");
  if (kind == Kind::Chosen) svg.circle(x, y, 5, "dot chosen");
}

/// Two rows of what the symbols mean, over the plot.
void legend(Svg& svg, const std::vector<FrontMark>& marks, bool budgets) {
  double x = kLeft;
  const auto entry = [&](Kind kind, std::string_view text) {
    if (std::none_of(marks.begin(), marks.end(), [&](const FrontMark& m) { return m.kind == kind; })) return;
    symbol(svg, kind, x + 7, 20);
    svg.text(x + 19, 24, text, "soft");
    x += 19 + textWidth(text, 12) + 16;
  };
  entry(Kind::Base, "base");
  entry(Kind::Preset, "preset");
  entry(Kind::Exact, "exact");
  entry(Kind::Front, "on the front");
  entry(Kind::Dominated, "dominated");
  entry(Kind::Chosen, "chosen for a budget");
  if (budgets && x + 90 < kRight) {
    svg.line(x, 20, x + 22, 20, "budget");
    svg.text(x + 28, 24, "budget", "soft");
  }
}

void axes(Svg& svg, const Axis& time, const Axis& error, const CostReport& cost) {
  for (const AxisTick& t : time.ticks()) {
    svg.line(t.at, kTop, t.at, kBottom, "grid");
    if (!t.label.empty()) svg.text(t.at, kBottom + 18, t.label, "small", "middle");
  }
  for (const AxisTick& t : error.ticks()) {
    svg.line(kLeft, t.at, kRight, t.at, "grid");
    if (!t.label.empty()) svg.text(kLeft - 8, t.at + 4, t.label, "small", "end");
  }
  svg.line(kLeft, kBottom, kRight, kBottom, "axis");
  svg.line(kLeft, kTop, kLeft, kBottom, "axis");
  const std::string clock = cost.clock.empty() ? "time" : cost.clock;
  svg.text((kLeft + kRight) / 2, kHeight - 14, fitted(fmt::format("{} of a frame, ms{}", clock, time.logarithmic() ? " (logarithmic)" : ""), 12, kRight - kLeft), "soft", "middle");
  const std::string against = cost.against.empty() ? "exact" : cost.against;
  svg.textUpward(20, (kTop + kBottom) / 2, fitted(fmt::format("error: rms against {}{}", against, error.logarithmic() ? " (logarithmic)" : ""), 12, kBottom - kTop), "soft");
}

std::string markLabel(const FrontMark& mark, const CostReport& cost) {
  const FrontPoint& p = *mark.point;
  const char* kind = mark.kind == Kind::Dominated ? "dominated" : mark.kind == Kind::Front ? "on the front" : "";
  std::string name = mark.label.empty() ? kind : mark.label + (mark.kind != Kind::Dominated && p.dominated ? ", dominated" : "");
  if (!mark.chosen.empty()) name += (name.empty() ? "" : ", ") + ("chosen for " + mark.chosen);
  return fmt::format("{}: {} ms, error {}. {}", name, spreadText(p.ms), percent(p.error.rms), settingsText(p, p.quality == cost.base.quality ? "the base quality" : "nothing differs from the base"));
}

void staircase(Svg& svg, const std::vector<FrontMark>& marks, const Axis& time, const Axis& error, Labels& labels) {
  std::vector<double> line;
  double best = INFINITY;
  for (const FrontMark& m : marks) {
    if (m.point->dominated || m.point->error.rms >= best) continue;
    const double x = time.at(m.point->ms.median), y = error.at(m.point->error.rms);
    if (!line.empty()) line.push_back(x), line.push_back(line[line.size() - 2]);
    line.push_back(x), line.push_back(y);
    best = m.point->error.rms;
  }
  if (line.size() > 2) svg.polyline(line, "front", false);
  for (std::size_t i = 0; i + 3 < line.size(); i += 2)
    labels.keepOff({std::min(line[i], line[i + 2]) - 1, std::min(line[i + 1], line[i + 3]) - 1, std::max(line[i], line[i + 2]) + 1, std::max(line[i + 1], line[i + 3]) + 1});
}

bool hasSpread(const FrontMark& m) { return m.point->ms.count > 1 && std::isfinite(m.point->ms.low) && std::isfinite(m.point->ms.high); }

void spreads(Svg& svg, const FrontMark& m, const Axis& time, const Axis& error) {
  const FrontPoint& p = *m.point;
  const char* style = m.kind == Kind::Dominated ? "spread dim" : "spread";
  const double x = time.at(p.ms.median), y = error.at(p.error.rms);
  if (hasSpread(m)) svg.line(time.at(p.ms.low), y, time.at(p.ms.high), y, style);
  if (p.error.rmsSpread > 0 && std::isfinite(p.error.rmsSpread)) svg.line(x, error.at(p.error.rms - p.error.rmsSpread), x, error.at(p.error.rms + p.error.rmsSpread), style);
}

}  // namespace

Plot frontPlot(const CostReport& cost, const std::vector<BudgetResult>& budgets) {
  const std::vector<FrontMark> marks = frontMarks(cost, budgets);
  std::vector<double> times, errors;
  for (const FrontMark& m : marks) times.push_back(m.point->ms.median), errors.push_back(m.point->error.rms);
  for (const BudgetResult& b : budgets) {
    if (b.ms > 0) times.push_back(b.ms);
    if (b.targetError > 0) errors.push_back(b.targetError);
  }
  const Axis time(times, Axis::Scale::Automatic, kLeft, kRight, false), error(errors, Axis::Scale::Automatic, kBottom, kTop, true);
  Svg svg(kWidth, kHeight);
  axes(svg, time, error, cost);
  bool lines = false;
  Labels labels;
  for (const FrontMark& m : marks) {
    const double x = time.at(m.point->ms.median), y = error.at(m.point->error.rms), r = !m.chosen.empty() ? 9 : m.kind == Kind::Dominated ? 3 : 6;
    labels.keepOff({x - r, y - r, x + r, y + r});
    if (m.kind != Kind::Dominated && hasSpread(m)) labels.keepOff({time.at(m.point->ms.low), y - 1, time.at(m.point->ms.high), y + 1});
  }
  for (const BudgetResult& b : budgets) {
    if (b.ms > 0 && std::isfinite(b.ms)) {
      const double x = time.at(b.ms);
      svg.line(x, kTop, x, kBottom, "budget");
      labels.keepOff({x - 1, kTop, x + 1, kBottom});
      labels.place(svg, x - 4, kTop + 9, fmt::format("{} ms", number(b.ms)), "budgettext");
      lines = true;
    } else if (b.targetError > 0 && std::isfinite(b.targetError)) {
      svg.line(kLeft, error.at(b.targetError), kRight, error.at(b.targetError), "budget");
      lines = true;
    }
  }
  staircase(svg, marks, time, error, labels);
  for (const bool plain : {true, false}) {
    for (const FrontMark& m : marks) {
      if ((m.kind == Kind::Dominated) != plain) continue;
      svg.beginGroup("point", markLabel(m, cost), !plain);
      spreads(svg, m, time, error);
      symbol(svg, m.kind, time.at(m.point->ms.median), error.at(m.point->error.rms));
      if (!m.chosen.empty()) svg.circle(time.at(m.point->ms.median), error.at(m.point->error.rms), 10, "ring");
      svg.endGroup();
    }
  }
  for (const Kind kind : {Kind::Base, Kind::Exact, Kind::Preset, Kind::Chosen})
    for (const FrontMark& m : marks)
      if (m.kind == kind && !m.label.empty()) labels.place(svg, time.at(m.point->ms.median), error.at(m.point->error.rms), fitted(m.label, 12, 200), "strong");
  if (marks.empty()) svg.text((kLeft + kRight) / 2, (kTop + kBottom) / 2, "nothing was measured", "soft", "middle");
  legend(svg, marks, lines);
  return {"front", "Time against error",
          fmt::format("{} qualities by time of a frame and error against {}; the line joins those that no other one beats in both.", marks.size(), cost.against.empty() ? "exact" : cost.against), std::move(svg)};
}

}  // namespace burnish::cost
