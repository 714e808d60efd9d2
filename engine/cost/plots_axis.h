// Axes of plots: which numbers lie where, and which of them are written.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace burnish::cost {

struct AxisTick {
  double value = 0, at = 0;  ///< at: pixels
  std::string label;         ///< empty: a mark without a number
};

/// Maps values to pixels. Values that are not finite have no place; on a logarithmic axis, 0 and what is far below the rest lie in a slot of their own at the low end, labelled 0.
class Axis {
 public:
  enum class Scale {
    FromZero,     ///< linear, 0 at the low end
    Logarithmic,  ///< at least a decade
    Automatic,    ///< logarithmic where the largest value is over three times the least, else linear around them
  };
  /// `from`, `to`: pixels of the low and the high end; an axis that runs to smaller numbers is a vertical one. `percent`: ticks are written as percentages.
  Axis(std::span<const double> values, Scale scale, double from, double to, bool percent);

  [[nodiscard]] double at(double value) const;  ///< inside of from and to, whatever the value
  [[nodiscard]] bool logarithmic() const { return logarithmic_; }
  [[nodiscard]] bool hasZeroSlot() const { return zeroSlot_; }
  [[nodiscard]] std::span<const AxisTick> ticks() const { return ticks_; }

 private:
  void fit(std::span<const double> values, Scale scale);
  void mark(bool percent);
  double low_ = 0, high_ = 1, from_, to_, start_;  ///< start_: pixels of low_, beyond the slot of zero
  bool logarithmic_ = false, zeroSlot_ = false;
  std::vector<AxisTick> ticks_;
};

}  // namespace burnish::cost
