// Choices that were rendered: their errors, their times, and how their pictures differ.
#pragma once
#include "cost/factors.h"
#include "cost/ladder.h"

namespace burnish::cost {

struct Sample {
  Choice choice;
  Spread ratio;        ///< of the frame to the base's; count 0: not timed
  PictureError error;  ///< against `Against`
  bool pictured = false;
};

class Samples {
 public:
  /// `against` must outlive this.
  explicit Samples(const Against& against);

  [[nodiscard]] const std::vector<Sample>& all() const { return samples_; }
  [[nodiscard]] const Sample* find(const Choice& choice) const;
  void time(const Choice& choice, const Spread& ratio);
  void picture(const Choice& choice, const Image& picture, const PictureError& error);
  /// Sum over pixels of the product of what two pictured samples miss, over the power of what they are held against; noise of ground truth taken off. Of one with itself: its rms, squared.
  [[nodiscard]] double product(std::size_t a, std::size_t b) const { return a < b ? products_[b][a] : products_[a][b]; }

 private:
  Sample& at(const Choice& choice);

  const Against& against_;
  std::vector<std::size_t> pixels_;  ///< that products are over: some ten thousand, spread evenly
  double power_ = 0, noise_ = 0;
  std::vector<Sample> samples_;
  std::vector<std::vector<float>> misses_;       ///< of each sample, empty where it has no picture
  std::vector<std::vector<double>> products_;  ///< lower triangle
};

}  // namespace burnish::cost
