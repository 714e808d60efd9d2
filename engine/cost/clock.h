// Wall time that a measurement may take, and whoever watches it.
#pragma once
#include <burnish/measure.h>

#include <chrono>

namespace burnish::cost {

class Clock {
 public:
  /// minutes 0: no limit.
  Clock(double minutes, std::function<bool(double, std::string_view)> progress) : minutes_(minutes), progress_(std::move(progress)) {}

  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  /// Until that share of the time is used up; very much where there is no limit.
  [[nodiscard]] double left(double share = 1) const { return minutes_ > 0 ? 60 * minutes_ * share - seconds() : 1e9; }
  /// Tells how far the work is; false once somebody wants it to end.
  bool tell(double share, std::string_view what) {
    if (progress_ && !stopped_) stopped_ = !progress_(share, what);
    return !stopped_;
  }
  [[nodiscard]] bool stopped() const { return stopped_; }

 private:
  double minutes_;
  std::function<bool(double, std::string_view)> progress_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool stopped_ = false;
};

}  // namespace burnish::cost
