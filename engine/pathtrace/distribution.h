// Drawing an index with a probability in proportion to its weight.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace burnish::pathtrace {

/// By inverting the running sum, so that evenly spread numbers stay so. Weights: finite, not negative.
class Distribution {
 public:
  Distribution() = default;
  explicit Distribution(std::span<const float> weights) {
    double sum = 0;
    for (const float w : weights) sum += double(w);
    total_ = sum;
    ends_.reserve(weights.size());
    double running = 0;
    for (const float w : weights) ends_.push_back(float((running += double(w)) / std::max(sum, 1e-300)));
    // Rounding must not leave a gap at the end, nor give what has no weight.
    for (std::size_t i = ends_.size(); i-- > 0 && sum > 0;) {
      ends_[i] = 1;
      if (weights[i] > 0) break;
    }
  }
  [[nodiscard]] bool empty() const { return !(total_ > 0); }
  [[nodiscard]] double total() const { return total_; }
  [[nodiscard]] float probability(std::size_t i) const { return ends_[i] - start(i); }
  struct Pick {
    std::size_t index = 0;
    float rest = 0;  ///< where in the index's share u lay, [0, 1)
  };
  /// u in [0, 1). Not to be asked when empty.
  [[nodiscard]] Pick at(float u) const {
    const auto found = std::upper_bound(ends_.begin(), ends_.end(), u);
    const std::size_t i = std::min(std::size_t(found - ends_.begin()), ends_.size() - 1);
    const float p = probability(i);
    return {i, p > 0 ? std::clamp((u - start(i)) / p, 0.0f, 0.99999994f) : 0};
  }

 private:
  [[nodiscard]] float start(std::size_t i) const { return i == 0 ? 0 : ends_[i - 1]; }
  std::vector<float> ends_;
  double total_ = 0;
};

}  // namespace burnish::pathtrace
