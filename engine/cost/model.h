// What a choice that was not measured is expected to cost and to miss.
#pragma once
#include "cost/kriging.h"
#include "cost/samples.h"

namespace burnish::cost {

struct Predicted {
  double error = 0;      ///< rms of the picture that is expected
  double sure = 0;       ///< rms that is expected: the other, and what is not known of the picture
  double ratio = 0;      ///< of the frame to the base's
  double deviation = 0;  ///< standard, of ratio
};

class Model {
 public:
  /// `most`: times beyond this ratio are not looked at; they say little about those that matter. The base must have been pictured and timed.
  Model(const Factors& factors, const Samples& samples, double most);
  [[nodiscard]] Predicted at(const Choice& choice) const;

 private:
  Kriging pictures_, times_;
  std::vector<double> products_;  ///< of the pictured samples, a full matrix
  std::vector<double> ratios_;    ///< of the timed ones
  double pictureScale_ = 0, timeScale_ = 0;  ///< what the covariance's unit is: rms squared, ratio squared
};

}  // namespace burnish::cost
