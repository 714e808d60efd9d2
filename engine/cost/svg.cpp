#include "cost/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cost/page_text.h"

namespace burnish::cost {
namespace {

/// Two decimals without a tail of zeros; what is not finite is 0, what is far out stays on the axis's side.
std::string coordinate(double v) {
  if (!std::isfinite(v)) v = 0;
  std::string text = fmt::format("{:.2f}", std::clamp(v, -1e5, 1e5));
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

constexpr ThemeColour kColours[] = {
    {"ground", "#ffffff", "#14171b"}, {"panel", "#f5f6f7", "#1c2026"}, {"ink", "#1a1e23", "#e7e9ec"},   {"soft", "#59616c", "#a7aeb8"},   {"rule", "#dcdfe3", "#313841"},
    {"grid", "#eceef0", "#252b32"},   {"dim", "#9aa2ac", "#69727d"},   {"time", "#2a6aa6", "#6fb1ea"},  {"error", "#c24d12", "#f2924f"},  {"truth", "#8a4a93", "#d3a0dc"},
    {"best", "#00795f", "#41c3a3"},   {"budget", "#8a6a00", "#d8b64a"}, {"wash", "#e9f1f8", "#1d2b38"},
};

// `$name` is a colour. Sizes in pixels.
constexpr std::string_view kStyle = R"(
.plot text{font-family:system-ui,-apple-system,"Segoe UI",Roboto,"Noto Sans","Liberation Sans","DejaVu Sans",Arial,sans-serif;font-size:12px;fill:$ink;font-variant-numeric:tabular-nums}
.plot .back{fill:$ground}
.plot .soft{fill:$soft}
.plot .small{font-size:11px;fill:$soft}
.plot .strong{font-weight:600}
.plot .axis{stroke:$dim;stroke-width:1;fill:none}
.plot .grid{stroke:$grid;stroke-width:1;fill:none}
.plot .band{fill:$panel}
.plot .bar{fill:$time}
.plot .bar.dim{fill:$dim}
.plot .bar.gap{fill:$error}
.plot .bar.gain{fill:$best}
.plot .whisker{stroke:$ink;stroke-width:1.25;fill:none}
.plot .guide{stroke:$rule;stroke-width:1;fill:none}
.plot .front{stroke:$time;stroke-width:1.75;fill:none;stroke-linejoin:round}
.plot .dot{stroke:$ground;stroke-width:1}
.plot .time{fill:$time}
.plot .error{fill:$error}
.plot .truth{fill:$truth}
.plot .best{fill:$best}
.plot .chosen{fill:$budget}
.plot .other{fill:$ground;stroke:$dim;stroke-width:1.25}
.plot .hollow{fill:$ground;stroke:$error;stroke-width:1.5}
.plot .ring{fill:none;stroke:$budget;stroke-width:2}
.plot .spread{stroke:$soft;stroke-width:1;fill:none}
.plot .spread.dim{stroke:$dim;opacity:.55}
.plot .budget{stroke:$budget;stroke-width:1.5;stroke-dasharray:5 4;fill:none}
.plot .budgettext{fill:$budget;font-weight:600}
)";

}  // namespace

std::span<const ThemeColour> themeColours() { return kColours; }

std::string plotStyle(bool page) {
  std::string out;
  for (std::size_t at = 0; at < kStyle.size();) {
    const ThemeColour* colour = nullptr;
    if (kStyle[at] == '$')
      for (const ThemeColour& c : kColours)
        if (kStyle.substr(at + 1, c.name.size()) == c.name) colour = &c;
    if (!colour) {
      out += kStyle[at++];
      continue;
    }
    out += page ? fmt::format("var(--{})", colour->name) : std::string(colour->light);
    at += 1 + colour->name.size();
  }
  return out;
}

double textWidth(std::string_view text, double size) {
  double ems = 0;
  for (const char c : text) {
    const auto byte = static_cast<std::uint8_t>(c);
    if ((byte & 0xC0) == 0x80) continue;
    if (byte >= 0xE1) ems += 1;  // from U+1000 on: as wide as high, mostly
    else if (std::string_view("iljI.,:;'|! ()[]/-ft").find(c) != std::string_view::npos) ems += 0.40;
    else if (std::string_view("mwMW%@").find(c) != std::string_view::npos) ems += 0.98;
    else if (c >= 'A' && c <= 'Z') ems += 0.72;
    else ems += 0.63;
  }
  return ems * size;
}

std::string fitted(std::string_view text, double size, double width) {
  std::string clean = cleanText(text);
  if (textWidth(clean, size) <= width) return clean;
  const double mark = size;
  while (!clean.empty() && textWidth(clean, size) + mark > width) {
    while (!clean.empty() && (static_cast<std::uint8_t>(clean.back()) & 0xC0) == 0x80) clean.pop_back();
    if (!clean.empty()) clean.pop_back();
  }
  return clean + "…";
}

void Svg::line(double x1, double y1, double x2, double y2, std::string_view style) {
  body_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" class=\"{}\"/>\n", coordinate(x1), coordinate(y1), coordinate(x2), coordinate(y2), style);
}

void Svg::rect(double x, double y, double width, double height, std::string_view style, double radius) {
  body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{} class=\"{}\"/>\n", coordinate(x), coordinate(y), coordinate(std::max(width, 0.0)), coordinate(std::max(height, 0.0)),
                       radius > 0 ? fmt::format(" rx=\"{}\"", coordinate(radius)) : "", style);
}

void Svg::circle(double x, double y, double radius, std::string_view style) {
  body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" class=\"{}\"/>\n", coordinate(x), coordinate(y), coordinate(radius), style);
}

void Svg::polyline(std::span<const double> points, std::string_view style, bool closed) {
  std::string list;
  for (std::size_t i = 0; i + 1 < points.size(); i += 2) list += fmt::format("{}{},{}", i ? " " : "", coordinate(points[i]), coordinate(points[i + 1]));
  body_ += fmt::format("<{} points=\"{}\" class=\"{}\"/>\n", closed ? "polygon" : "polyline", list, style);
}

void Svg::text(double x, double y, std::string_view text, std::string_view style, std::string_view anchor) {
  body_ += fmt::format("<text x=\"{}\" y=\"{}\"{}{}>{}</text>\n", coordinate(x), coordinate(y), anchor == "start" ? "" : fmt::format(" text-anchor=\"{}\"", anchor),
                       style.empty() ? "" : fmt::format(" class=\"{}\"", style), escaped(text));
}

void Svg::textUpward(double x, double y, std::string_view text, std::string_view style) {
  body_ += fmt::format("<text transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\" class=\"{}\">{}</text>\n", coordinate(x), coordinate(y), style, escaped(text));
}

void Svg::beginGroup(std::string_view style, std::string_view label, bool focus) {
  if (label.empty()) {
    body_ += fmt::format("<g class=\"{}\">\n", style);
    return;
  }
  const std::string name = escaped(label);
  body_ += fmt::format("<g class=\"{}\" role=\"img\" aria-label=\"{}\"{}><title>{}</title>\n", style, name, focus ? " tabindex=\"0\"" : "", name);
}

void Svg::endGroup() { body_ += "</g>\n"; }

std::string Svg::file(std::string_view title, std::string_view description) const {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" role=\"img\" "
      "aria-labelledby=\"title description\">\n<title id=\"title\">{2}</title>\n<desc id=\"description\">{3}</desc>\n<style>{4}</style>\n<rect width=\"{0}\" height=\"{1}\" "
      "class=\"back\"/>\n{5}</svg>\n",
      coordinate(width_), coordinate(height_), escaped(title), escaped(description), plotStyle(false), body_);
}

std::string Svg::inlined(std::string_view id, std::string_view title, std::string_view description) const {
  return fmt::format(
      "<svg class=\"plot\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"group\" aria-labelledby=\"{2}-title {2}-desc\">\n<title id=\"{2}-title\">{3}</title>\n<desc "
      "id=\"{2}-desc\">{4}</desc>\n{5}</svg>\n",
      coordinate(width_), coordinate(height_), id, escaped(title), escaped(description), body_);
}

}  // namespace burnish::cost
