// The search for budgets: measures choices, models them, goes where the model promises most.
#pragma once
#include <functional>

#include "cost/clock.h"
#include "cost/search.h"

namespace burnish::cost {

/// What measures.
struct Instrument {
  /// Makes these pictures ready at once, and drops others; may be empty.
  std::function<Result<void>(const std::vector<Choice>&)> prepare;
  std::function<Result<std::pair<Image, PictureError>>(const Choice&)> picture;  ///< F32 RGB, and how far it is from Against
  std::function<Result<std::vector<Spread>>(const std::vector<Choice>&, int rounds)> time;  ///< frames over the base's
};

class Spender {
 public:
  /// All must outlive it.
  Spender(const Instrument& instrument, const Factors& factors, const Against& against, Clock& clock) : instrument_(instrument), factors_(factors), clock_(clock), samples_(against) {}

  /// Takes the times of what was measured before, and renders the settings one by one, those that no goal can afford left out. `until`: share of the clock's time.
  Result<void> begin(const CostReport& cost, const std::vector<Goal>& goals, double until);
  /// Measures combinations until none is promised to be better, or the share of the clock's time is used up.
  Result<void> search(const Goal& goal, double until);
  /// Times again what is best for each goal, with an instrument whose programs and buffers are made anew; Samples then have these times. A quality that fits by chance is found out here, and one that failed by chance.
  Result<void> verify(const Instrument& fresh, const std::vector<Goal>& goals);

  [[nodiscard]] const Samples& samples() const { return samples_; }
  /// The sample that meets the goal best; where none does, the nearest. nullptr before there is any.
  [[nodiscard]] const Sample* best(const Goal& goal) const;
  /// The cheapest that was measured with a clearly lower error; nullptr: none is known.
  [[nodiscard]] const Sample* next(const Sample& best) const;
  [[nodiscard]] bool fits(const Goal& goal, const Sample& sample) const;
  [[nodiscard]] int measured() const { return measured_; }

 private:
  Result<void> measure(const std::vector<Choice>& choices, const Goal& goal);
  Result<void> hearAgain(const Instrument& fresh, const std::vector<Goal>& goals);
  Result<void> prepare(const std::vector<Choice>& choices);
  Result<void> picture(const Choice& choice);
  Result<bool> batch(const Goal& goal, const Goal& wanted);
  [[nodiscard]] std::vector<Choice> ranked(const Goal& goal, std::size_t most) const;
  [[nodiscard]] Result<void> stopped() const { return clock_.stopped() ? Result<void>(fail("budget", "was stopped", "run it again")) : Result<void>(); }

  const Instrument& instrument_;
  const Factors& factors_;
  Clock& clock_;
  Samples samples_;
  std::set<Choice> verified_;
  bool decided_ = false;  ///< what there was to verify was verified
  std::mt19937 random_{1};
  double mostRatio_ = 0;  ///< that any goal can use
  int measured_ = 0;
};

}  // namespace burnish::cost
