// What the search for a budget may change: one factor for each thing that is chosen by itself, its levels the settings.
#pragma once
#include <optional>

#include "cost/bench.h"

namespace burnish::cost {

/// One setting of a factor. Terms and sizes that the factor has no part in stay as they are.
struct Level {
  std::vector<std::pair<std::size_t, std::size_t>> rungs;  ///< term and rung, of each term of the factor
  int shadowResolution = 0;                                ///< 0: none of this factor's
  float resolutionScale = 0;                               ///< likewise
  void apply(Quality& quality) const;
  [[nodiscard]] bool holds(const Quality& quality) const;  ///< the quality is so already
};
struct Factor {
  std::string name;
  std::vector<Level> levels;
  std::size_t base = 0;                    ///< of the base quality
  std::vector<std::vector<double>> alike;  ///< 0 to 1: how much of what one level does another does too, for all that is known before anything is measured
};
/// One level of each factor.
using Choice = std::vector<std::uint16_t>;

class Factors {
 public:
  /// The factors of the scene in this view. The terms that together are the lobe (specular, distribution, geometry, normalization, lobe) are one factor, whose levels are the combinations in which no
  /// rung is idle. Not among them: what errors do not see (antialiasing in all its forms, bloom, the format
  /// of the light buffer).
  Factors(const Bench& bench, const std::vector<std::string>& only, bool sizes);
  /// These alone. Each has a level that the base is at.
  Factors(const Quality& base, std::vector<Factor> factors);

  [[nodiscard]] const std::vector<Factor>& all() const { return factors_; }
  [[nodiscard]] Choice base() const;
  [[nodiscard]] Quality quality(const Choice& choice) const;
  /// The choice that looks and costs as the quality does; none where it differs in what is no factor.
  [[nodiscard]] std::optional<Choice> choiceOf(const Quality& quality) const;

 private:
  Quality base_;
  std::vector<Factor> factors_;
  std::vector<std::size_t> idle_;  ///< terms that have no effect in this view
};

}  // namespace burnish::cost
