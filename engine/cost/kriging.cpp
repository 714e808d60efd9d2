#include "cost/kriging.h"

#include <algorithm>
#include <cmath>

namespace burnish::cost {
namespace {

constexpr double kLeastShare = 1e-3;  ///< of a factor in that sum: what changes nothing beside the base may do so beside something else
constexpr double kConstant = 10;      ///< variance of the mean: a hundred times that of all effects, for nothing is known of it

/// Lower triangle of L with L L^T = matrix; false where it is not positive definite.
bool factorize(std::vector<double>& m, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = m[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= m[i * n + k] * m[j * n + k];
      if (i == j) {
        if (!(sum > 0)) return false;
        m[i * n + i] = std::sqrt(sum);
      } else {
        m[i * n + j] = sum / m[j * n + j];
      }
    }
  return true;
}

}  // namespace

void invert(std::vector<double>& matrix, std::size_t n) {
  std::vector<double> lower;
  double more = 0;
  for (;; more = std::max(10 * more, 1e-10)) {
    lower = matrix;
    for (std::size_t i = 0; i < n; ++i) lower[i * n + i] += more;
    if (factorize(lower, n)) break;
  }
  // The inverse of L, in place, then its product with its transpose.
  for (std::size_t j = 0; j < n; ++j) {
    lower[j * n + j] = 1 / lower[j * n + j];
    for (std::size_t i = j + 1; i < n; ++i) {
      double sum = 0;
      for (std::size_t k = j; k < i; ++k) sum -= lower[i * n + k] * lower[k * n + j];
      lower[i * n + j] = sum / lower[i * n + i];
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 0;
      for (std::size_t k = i; k < n; ++k) sum += lower[k * n + i] * lower[k * n + j];
      matrix[i * n + j] = matrix[j * n + i] = sum;
    }
}

Covariance::Covariance(const Factors& factors, const std::vector<double>& effects) {
  double sum = 0;
  for (const double e : effects) sum += e;
  for (std::size_t f = 0; f < factors.all().size(); ++f) {
    const double weight = kWeights * std::max(sum > 0 ? effects[f] / sum : 0, kLeastShare);
    auto table = factors.all()[f].alike;
    for (auto& row : table)
      for (double& value : row) value = 1 + weight * value;
    tables_.push_back(std::move(table));
  }
}

double Covariance::operator()(const Choice& a, const Choice& b) const {
  double product = 1;
  for (std::size_t f = 0; f < tables_.size(); ++f) product *= tables_[f][a[f]][b[f]];
  return kConstant + product;
}

Kriging::Kriging(Covariance covariance, std::vector<Choice> measured, const std::vector<double>& noise) : covariance_(std::move(covariance)), measured_(std::move(measured)) {
  const std::size_t n = measured_.size();
  inverse_.resize(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) inverse_[i * n + j] = inverse_[j * n + i] = covariance_(measured_[i], measured_[j]);
  for (std::size_t i = 0; i < n; ++i) inverse_[i * n + i] += noise[i];
  invert(inverse_, n);
}

Weights Kriging::weightsAt(const Choice& choice) const {
  const std::size_t n = measured_.size();
  std::vector<double> k(n);
  for (std::size_t i = 0; i < n; ++i) k[i] = covariance_(choice, measured_[i]);
  Weights w;
  w.of.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const double* row = inverse_.data() + i * n;
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += row[j] * k[j];
    w.of[i] = sum;
  }
  w.variance = covariance_(choice, choice);
  for (std::size_t i = 0; i < n; ++i) w.variance -= k[i] * w.of[i];
  w.variance = std::max(w.variance, 0.0);
  return w;
}

}  // namespace burnish::cost
