#include "cost/model.h"

#include <algorithm>
#include <cmath>

namespace burnish::cost {
namespace {

constexpr double kPictureNoise = 1e-8;  ///< of the covariance's unit: pictures of one choice are the same to the last bit, the rest is what keeps the matrix regular
constexpr double kLeastDeviation = 3e-3;  ///< of a ratio of times, however little its rounds scattered

/// The factor in which alone a choice differs from the base; the number of factors where there is none or more than one.
std::size_t onlyDifference(const Choice& choice, const Choice& base) {
  std::size_t found = base.size();
  for (std::size_t f = 0; f < base.size(); ++f)
    if (choice[f] != base[f]) {
      if (found < base.size()) return base.size();
      found = f;
    }
  return found;
}

/// Of each factor the mean over samples that differ in it alone of `effect(sample)`.
template <class F>
std::vector<double> effectsOf(const Factors& factors, const Samples& samples, F&& effect) {
  std::vector<double> sum(factors.all().size(), 0), count(factors.all().size(), 0);
  for (std::size_t i = 0; i < samples.all().size(); ++i) {
    const std::size_t f = onlyDifference(samples.all()[i].choice, factors.base());
    const double value = f < sum.size() ? effect(i) : -1;
    if (value >= 0) sum[f] += value, count[f] += 1;
  }
  for (std::size_t f = 0; f < sum.size(); ++f) sum[f] = count[f] > 0 ? sum[f] / count[f] : 0;
  return sum;
}

std::vector<std::size_t> pictured(const Samples& samples) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < samples.all().size(); ++i)
    if (samples.all()[i].pictured) out.push_back(i);
  return out;
}
std::vector<std::size_t> timed(const Samples& samples, double most) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < samples.all().size(); ++i)
    if (const Spread& r = samples.all()[i].ratio; r.count > 0 && r.median <= most) out.push_back(i);
  return out;
}
std::vector<Choice> choicesOf(const Samples& samples, const std::vector<std::size_t>& which) {
  std::vector<Choice> out;
  for (const std::size_t i : which) out.push_back(samples.all()[i].choice);
  return out;
}

double deviationOf(const Spread& ratio) { return std::max((ratio.high - ratio.low) / 3.92, kLeastDeviation); }  // 95 of 100 lie within 1.96 deviations

std::size_t indexOfBase(const Factors& factors, const Samples& samples) { return std::size_t(samples.find(factors.base()) - samples.all().data()); }

std::vector<double> pictureEffects(const Factors& factors, const Samples& samples) {
  const std::size_t base = indexOfBase(factors, samples);
  return effectsOf(factors, samples, [&](std::size_t i) { return samples.all()[i].pictured ? std::max(samples.product(i, i) + samples.product(base, base) - 2 * samples.product(i, base), 0.0) : -1; });
}
std::vector<double> timeEffects(const Factors& factors, const Samples& samples, double most) {
  return effectsOf(factors, samples, [&](std::size_t i) {
    const Spread& r = samples.all()[i].ratio;
    return r.count > 0 && r.median <= most ? (r.median - 1) * (r.median - 1) : -1;
  });
}

/// The covariance's unit, from the effects that it was made of.
double scaleOf(const std::vector<double>& effects) {
  double sum = 0;
  for (const double e : effects) sum += e;
  return std::max(sum, 1e-12) / (2 * Covariance::kWeights);
}

std::vector<double> timeNoise(const Samples& samples, const std::vector<std::size_t>& which, double scale) {
  std::vector<double> noise;
  for (const std::size_t i : which) noise.push_back(std::pow(deviationOf(samples.all()[i].ratio), 2) / scale);
  return noise;
}

}  // namespace

Model::Model(const Factors& factors, const Samples& samples, double most)
    : pictures_(Covariance(factors, pictureEffects(factors, samples)), choicesOf(samples, pictured(samples)), std::vector<double>(pictured(samples).size(), kPictureNoise)),
      times_(Covariance(factors, timeEffects(factors, samples, most)), choicesOf(samples, timed(samples, most)), timeNoise(samples, timed(samples, most), scaleOf(timeEffects(factors, samples, most)))),
      pictureScale_(scaleOf(pictureEffects(factors, samples))),
      timeScale_(scaleOf(timeEffects(factors, samples, most))) {
  const std::vector<std::size_t> seen = pictured(samples);
  for (const std::size_t a : seen)
    for (const std::size_t b : seen) products_.push_back(samples.product(a, b));
  for (const std::size_t i : timed(samples, most)) ratios_.push_back(samples.all()[i].ratio.median);
}

Predicted Model::at(const Choice& choice) const {
  Predicted p;
  const Weights picture = pictures_.weightsAt(choice);
  const std::size_t n = picture.of.size();
  double square = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += products_[i * n + j] * picture.of[j];
    square += sum * picture.of[i];
  }
  p.error = std::sqrt(std::max(square, 0.0));
  p.sure = std::sqrt(std::max(square, 0.0) + picture.variance * pictureScale_);
  const Weights time = times_.weightsAt(choice);
  for (std::size_t i = 0; i < time.of.size(); ++i) p.ratio += time.of[i] * (ratios_[i] - 1);  // effects from the base on, so that weights need not sum to 1
  p.ratio = std::max(p.ratio + 1, 0.0);
  p.deviation = std::sqrt(time.variance * timeScale_);
  return p;
}

}  // namespace burnish::cost
