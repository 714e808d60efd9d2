// What unmeasured choices are expected to give, from measured ones: Gaussian process regression over settings (Rasmussen and Williams 2006, chapter 2). Pictures are predicted, not errors: light
// adds, so the differences that settings make nearly add too, while errors do not.
#pragma once
#include "cost/factors.h"

namespace burnish::cost {

/// Covariance of two choices: a constant, and the product over factors of 1 + weight · alike. Multiplied out it is each factor's own effect, pairs of factors, and so on, each a tenth of the one before (Duvenaud, Nickisch and
/// Rasmussen 2011, additive Gaussian processes). With one measurement for each setting beside the base it predicts that effects add; every combination that is measured corrects that.
class Covariance {
 public:
  /// `effects`: of each factor the mean square of what its levels change; only their proportions count.
  Covariance(const Factors& factors, const std::vector<double>& effects);
  [[nodiscard]] double operator()(const Choice& a, const Choice& b) const;
  /// Sum of the factors' weights. The mean square difference between two levels of a factor is twice its weight.
  static constexpr double kWeights = 0.1;

 private:
  std::vector<std::vector<std::vector<double>>> tables_;  ///< of each factor 1 + weight · alike
};

/// The weights that measured choices have in one that is not.
struct Weights {
  std::vector<double> of;  ///< sum to almost 1
  double variance = 0;     ///< that is left, in units of the covariance
};

class Kriging {
 public:
  /// `noise`: variance of each measurement in units of the covariance.
  Kriging(Covariance covariance, std::vector<Choice> measured, const std::vector<double>& noise);
  [[nodiscard]] Weights weightsAt(const Choice& choice) const;
  [[nodiscard]] const std::vector<double>& inverse() const { return inverse_; }  ///< of the covariance matrix, row by row
  [[nodiscard]] std::size_t count() const { return measured_.size(); }

 private:
  Covariance covariance_;
  std::vector<Choice> measured_;
  std::vector<double> inverse_;
};

/// Inverts a symmetric positive definite matrix in place (Cholesky); what is not quite definite gets more on its diagonal.
void invert(std::vector<double>& matrix, std::size_t n);

}  // namespace burnish::cost
