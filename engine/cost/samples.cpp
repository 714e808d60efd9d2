#include "cost/samples.h"

#include <algorithm>
#include <cmath>

namespace burnish::cost {
namespace {

constexpr std::size_t kMostPixels = 40'000;

const float* valuesAt(const Image& image, std::size_t pixel) { return image.f32() + std::size_t(image.channels) * pixel; }
bool finite(const float* v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

}  // namespace

Samples::Samples(const Against& against) : against_(against) {
  const Image& other = *against.linear;
  const std::size_t count = other.pixelCount(), stride = count / kMostPixels + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const float* o = valuesAt(other, i);
    if ((i * 2654435761u >> 12) % stride != 0 || !finite(o)) continue;  // Knuth's multiplicative hash: no pattern of rows
    double power = 0, noise = 0;
    for (int c = 0; c < 3; ++c) {
      power += double(o[c]) * double(o[c]);
      if (against.truth()) noise += double(valuesAt(*against.variance, i)[c]);
    }
    if (noise > power) continue;  // says nothing of itself
    pixels_.push_back(i);
    power_ += power - noise, noise_ += noise;
  }
  power_ = std::max(power_, 1e-300);
}

const Sample* Samples::find(const Choice& choice) const {
  const auto found = std::find_if(samples_.begin(), samples_.end(), [&](const Sample& s) { return s.choice == choice; });
  return found == samples_.end() ? nullptr : &*found;
}

Sample& Samples::at(const Choice& choice) {
  if (const Sample* found = find(choice)) return samples_[std::size_t(found - samples_.data())];
  samples_.push_back({choice, {}, {}, false});
  misses_.emplace_back();
  products_.emplace_back(samples_.size(), 0.0);
  return samples_.back();
}

void Samples::time(const Choice& choice, const Spread& ratio) { at(choice).ratio = ratio; }

void Samples::picture(const Choice& choice, const Image& picture, const PictureError& error) {
  Sample& sample = at(choice);
  if (sample.pictured) return;
  sample.error = error;
  sample.pictured = true;
  const std::size_t own = std::size_t(&sample - samples_.data());
  std::vector<float>& miss = misses_[own];
  miss.reserve(3 * pixels_.size());
  for (const std::size_t i : pixels_) {
    const float *p = valuesAt(picture, i), *o = valuesAt(*against_.linear, i);
    for (int c = 0; c < 3; ++c) miss.push_back(finite(p) ? p[c] - o[c] : 0.0f);
  }
  for (std::size_t other = 0; other < samples_.size(); ++other) {
    if (!samples_[other].pictured) continue;
    double sum = 0;
    for (std::size_t i = 0; i < miss.size(); i += 3) {  // in pieces: a double for all would be as exact and slower
      const float *a = miss.data() + i, *b = misses_[other].data() + i;
      sum += double(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
    }
    products_[std::max(own, other)][std::min(own, other)] = (sum - noise_) / power_;
  }
}

}  // namespace burnish::cost
