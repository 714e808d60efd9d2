#include "cost/plots_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cost/svg.h"

namespace burnish::cost {
namespace {

constexpr double kSlot = 34;        // pixels of the slot of zero
constexpr double kDecades = 6;      // below the largest value; what is less counts as 0
constexpr double kMost = 1e100;     // no figure of this world; counts as infinite
constexpr double kRatio = 3;        // from here on an automatic axis is logarithmic
constexpr double kTickSpace = 62;   // pixels that a tick's number takes, more or less
constexpr double kSize = 11, kGap = 8, kLine = 16;  // pixels: text, between two numbers, between two lines of text

/// 1, 2 or 5 times a power of ten, so that the range has `count` ticks or a little more.
double niceStep(double range, int count) {
  const double rough = range / std::max(count, 1), power = std::pow(10, std::floor(std::log10(rough)));
  const double lead = rough / power;
  return power * (lead <= 1.0001 ? 1 : lead <= 2.0001 ? 2 : lead <= 5.0001 ? 5 : 10);
}

/// As short as it can be: "0.5", "20", "1000".
std::string tickText(double value, bool percent) {
  const double v = percent ? value * 100 : value;
  if (v == 0) return percent ? "0 %" : "0";
  std::string text = std::abs(v) < 1e-4 || std::abs(v) >= 1e7 ? fmt::format("{:.2g}", v) : fmt::format("{:.6f}", v);
  if (text.find('e') == std::string::npos && text.find('.') != std::string::npos) {
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
  }
  return percent ? text + " %" : text;
}

}  // namespace

Axis::Axis(std::span<const double> values, Scale scale, double from, double to, bool percent) : from_(from), to_(to), start_(from) {
  fit(values, scale);
  if (zeroSlot_) start_ += to_ > from_ ? kSlot : -kSlot;
  mark(percent);
}

void Axis::fit(std::span<const double> values, Scale scale) {
  double least = INFINITY, most = 0;
  for (const double v : values)
    if (std::abs(v) < kMost && v > 0) most = std::max(most, v);
  const double floor = most * std::pow(10, -kDecades);
  for (const double v : values) {
    if (!(std::abs(v) < kMost)) continue;
    if (v > floor) least = std::min(least, v);
    else zeroSlot_ = true;
  }
  logarithmic_ = scale == Scale::Logarithmic || (scale == Scale::Automatic && most > kRatio * least);
  if (!(most > 0)) {  // nothing, or zeros alone
    low_ = logarithmic_ ? 0.1 : 0, high_ = 1;
    zeroSlot_ = zeroSlot_ && logarithmic_;
    return;
  }
  zeroSlot_ = zeroSlot_ && logarithmic_;
  if (logarithmic_) {
    low_ = least / 1.3, high_ = most * 1.3;
    if (high_ < low_ * 10) {  // a decade, the values in its middle
      const double middle = std::sqrt(low_) * std::sqrt(high_);
      low_ = middle / std::sqrt(10.0), high_ = middle * std::sqrt(10.0);
    }
  } else if (scale == Scale::FromZero) {
    low_ = 0, high_ = most * 1.06;
  } else {
    const double room = std::max(most - least, most * 0.05) * 0.15;
    low_ = std::max(least - room, 0.0), high_ = most + room;
  }
}

double Axis::at(double value) const {
  if (std::isnan(value)) return from_;
  if (zeroSlot_ && value < low_) return from_ + (start_ - from_) * 0.35;
  const double v = std::clamp(value, low_, high_);
  const double share = logarithmic_ ? std::log(v / low_) / std::log(high_ / low_) : (v - low_) / (high_ - low_);
  return start_ + (to_ - start_) * share;
}

void Axis::mark(bool percent) {
  const bool vertical = to_ < from_;
  const int count = std::max(2, static_cast<int>(std::abs(to_ - start_) / kTickSpace));
  if (zeroSlot_) ticks_.push_back({0, at(0), "0"});
  std::vector<double> values;
  if (logarithmic_) {
    const int first = static_cast<int>(std::floor(std::log10(low_))), last = static_cast<int>(std::ceil(std::log10(high_)));
    const auto collect = [&](std::initializer_list<int> leads) {
      values.clear();
      for (int d = first; d <= last; ++d)
        for (const int lead : leads)
          if (const double v = lead * std::pow(10, d); v >= low_ * 0.999 && v <= high_ * 1.001) values.push_back(v);
    };
    collect({1, 2, 5});
    if (static_cast<int>(values.size()) > count + 1) collect({1, 3});
    if (static_cast<int>(values.size()) > count + 1) collect({1});
  } else {
    const double step = niceStep(high_ - low_, count);
    for (double i = std::ceil(low_ / step - 1e-9); i * step <= high_ * (1 + 1e-9) && values.size() < 100; ++i) values.push_back(i * step);
  }
  for (const double v : values) ticks_.push_back({v, at(v), tickText(v, percent)});
  // A number that would touch the one before stays away; its mark does not.
  const AxisTick* before = nullptr;
  for (AxisTick& t : ticks_) {
    const double need = vertical ? kLine : before ? (textWidth(t.label, kSize) + textWidth(before->label, kSize)) / 2 + kGap : 0;
    if (before && std::abs(t.at - before->at) < need) t.label.clear();
    else before = &t;
  }
}

}  // namespace burnish::cost
