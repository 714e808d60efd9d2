// A small SVG writer: what plots need. Text is escaped here; numbers are finite. Colours come from classes, so that one drawing is a file of its own (light colours) and part of a page that has
// both themes.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace burnish::cost {

/// A colour of the report by its role, in both themes.
struct ThemeColour {
  std::string_view name, light, dark;
};
std::span<const ThemeColour> themeColours();
/// Style of all plots. `page`: colours are the page's variables; else the light ones themselves.
std::string plotStyle(bool page);

/// How wide text is, in pixels, at most (the widest of the usual sans fonts).
double textWidth(std::string_view text, double size);
/// Cut with an ellipsis so that it is no wider.
std::string fitted(std::string_view text, double size, double width);

class Svg {
 public:
  Svg(double width, double height) : width_(width), height_(height) {}

  void line(double x1, double y1, double x2, double y2, std::string_view style);
  void rect(double x, double y, double width, double height, std::string_view style, double radius = 0);
  void circle(double x, double y, double radius, std::string_view style);
  /// A polygon through pairs of x and y, or an open line.
  void polyline(std::span<const double> points, std::string_view style, bool closed);
  /// anchor: start, middle or end.
  void text(double x, double y, std::string_view text, std::string_view style, std::string_view anchor = "start");
  /// Turned a quarter to the left around its anchor.
  void textUpward(double x, double y, std::string_view text, std::string_view style);
  /// A group that is read out as `label` and shows it where the pointer rests; `focus`: the keyboard reaches it.
  void beginGroup(std::string_view style, std::string_view label, bool focus = false);
  void endGroup();

  /// A file of its own, in light colours, with its style.
  [[nodiscard]] std::string file(std::string_view title, std::string_view description) const;
  /// A part of a page. `id` is a prefix for the ids of title and description; letters, digits, '-'.
  [[nodiscard]] std::string inlined(std::string_view id, std::string_view title, std::string_view description) const;
  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }

 private:
  double width_, height_;
  std::string body_;
};

}  // namespace burnish::cost
