// Figures of how far pictures are apart, against closed forms and synthetic noise.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "cost/bench.h"
#include "cost/metrics.h"

using namespace burnish;
using namespace burnish::cost;

namespace {

Image flat(int width, int height, float value) {
  Image image = makeImage(width, height, 3, PixelType::F32);
  std::fill_n(image.f32(), image.pixelCount() * 3, value);
  return image;
}
Image code(int width, int height, int value) {
  Image image = makeImage(width, height, 3, PixelType::U8);
  std::fill_n(image.u8(), image.pixelCount() * 3, std::uint8_t(value));
  return image;
}
/// A ramp of radiance from 1 to 3.
Image ramp(int width, int height) {
  Image image = makeImage(width, height, 3, PixelType::F32);
  for (std::size_t i = 0; i < image.pixelCount() * 3; ++i) image.f32()[i] = 1 + 2 * float(i) / float(image.pixelCount() * 3);
  return image;
}
Image scaled(const Image& image, float factor) {
  Image out = image;
  for (std::size_t i = 0; i < out.pixelCount() * 3; ++i) out.f32()[i] *= factor;
  return out;
}
const Image kNone;

}  // namespace

TEST_CASE("measure: known offsets have their closed forms") {
  const Image truth = ramp(64, 48);
  const PictureError brighter = errorOf({scaled(truth, 1.1f), code(64, 48, 105)}, {truth, code(64, 48, 100)});
  CHECK(brighter.rms == Approx(0.1).epsilon(1e-5));
  CHECK(brighter.energy == Approx(0.1).epsilon(1e-5));
  CHECK(brighter.rmsSpread == 0);
  CHECK(brighter.psnr == Approx(20 * std::log10(255.0 / 5)));
  const PictureError same = errorOf({truth, code(64, 48, 100)}, {truth, code(64, 48, 100)});
  CHECK(same.rms == 0);
  CHECK(same.perceptual == 0);
  CHECK(same.p999 == 0);
  CHECK(std::isinf(same.psnr));
}

TEST_CASE("measure: the 99.9th percentile is that of pixels, and what is not finite is counted") {
  Image truth = flat(50, 40, 1), picture = truth;
  for (int i = 0; i < 2; ++i)
    for (int c = 0; c < 3; ++c) picture.f32()[std::size_t(3 * i + c)] = 2;
  CHECK(errorOf({picture, kNone}, {truth, kNone}).p999 == Approx(0.5));  // 1 over 1 + 1, on 2 pixels of 2000
  for (int c = 0; c < 3; ++c) picture.f32()[3 + c] = 1;
  CHECK(errorOf({picture, kNone}, {truth, kNone}).p999 == 0);  // on 1 pixel of 2000
  picture.f32()[0] = std::nanf("");
  truth.f32()[7] = INFINITY;
  const PictureError error = errorOf({picture, kNone}, {truth, kNone});
  CHECK(error.skipped == 2);
  CHECK(error.rms == 0);
}

TEST_CASE("measure: the noise of the other is taken off, within the spread that is said") {
  const Image truth = ramp(160, 90), picture = scaled(truth, 1.1f);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  double inside = 0, sum = 0, square = 0, said = 0;
  constexpr int kSeeds = 60;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Image noisy = truth, variance = truth;
    for (std::size_t i = 0; i < truth.pixelCount(); ++i) {
      const double n = normal(random);
      for (std::size_t c = 0; c < 3; ++c) {
        const double sigma = 0.2 * double(truth.f32()[3 * i + c]);
        noisy.f32()[3 * i + c] += float(n * sigma);
        variance.f32()[3 * i + c] = float(sigma * sigma);
      }
    }
    const PictureError raw = errorOf({picture, kNone}, {noisy, kNone}), error = errorOf({picture, kNone}, {noisy, kNone}, &variance);
    CHECK(raw.rms > 0.21);  // sqrt(0.1^2 + 0.2^2) over sqrt(1 + 0.2^2)
    inside += std::abs(error.rms - 0.1) < 2 * error.rmsSpread ? 1 : 0;
    sum += error.rms, square += error.rms * error.rms, said += error.rmsSpread / kSeeds;
  }
  const double mean = sum / kSeeds, scatter = std::sqrt(square / kSeeds - mean * mean);
  CHECK(std::abs(mean - 0.1) < 4 * said / std::sqrt(double(kSeeds)));
  CHECK(scatter < 1.5 * said);
  CHECK(scatter > said / 1.5);
  CHECK(inside >= 0.85 * kSeeds);
}

TEST_CASE("measure: a firefly of the other is left out and counted") {
  const Image truth = ramp(64, 48), picture = scaled(truth, 1.05f);
  Image noisy = truth, variance = flat(64, 48, 1e-6f);
  for (std::size_t c = 0; c < 3; ++c) noisy.f32()[300 + c] = 1e4f, variance.f32()[300 + c] = 1e8f;
  const PictureError error = errorOf({picture, kNone}, {noisy, kNone}, &variance);
  CHECK(error.uncertain == 1);
  CHECK(error.rms == Approx(0.05).epsilon(1e-3));
  CHECK(error.energy == Approx(0.05).epsilon(1e-3));
  CHECK(error.rmsSpread < 1e-3);
}

TEST_CASE("measure: Butteraugli is 0 for equal pictures, grows with the difference, and takes small ones") {
  std::mt19937 random(3);
  const auto noisy = [&random](int amplitude) {
    Image image = code(64, 64, 120);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.u8()[i] = std::uint8_t(120 + int(random() % unsigned(2 * amplitude + 1)) - amplitude);
    return image;
  };
  const Image plain = code(64, 64, 120);
  CHECK(butteraugli(plain, plain) == 0);
  const double little = butteraugli(noisy(2), plain), more = butteraugli(noisy(10), plain), much = butteraugli(noisy(60), plain);
  CHECK(little > 0);
  CHECK(more > 2 * little);
  CHECK(much > 2 * more);
  CHECK(butteraugli(code(3, 2, 200), code(3, 2, 20)) > 1);
  CHECK(butteraugli(code(1, 1, 50), code(1, 1, 50)) == 0);
}

TEST_CASE("measure: a repeat's median lies within the stated spread 19 times in 20 where values are normal") {
  std::mt19937 random(11);
  std::normal_distribution<double> normal(10, 1);
  for (const int n : {3, 5, 7, 11, 16, 31, 100}) {
    int within = 0;
    constexpr int kRepeats = 4000;
    for (int i = 0; i < kRepeats; ++i) {
      std::vector<double> first, second;
      for (int k = 0; k < n; ++k) first.push_back(normal(random)), second.push_back(normal(random));
      const Spread a = spreadOf(first), b = spreadOf(second);
      within += b.median >= a.low && b.median <= a.high ? 1 : 0;
      CHECK(a.count == n);
    }
    INFO(n << " values: " << within << " of " << kRepeats);
    CHECK(double(within) / kRepeats > 0.935);
    CHECK(double(within) / kRepeats < 0.965);
  }
}

TEST_CASE("measure: widths of independent figures add up in squares") {
  const Spread product = times({2, 2 * 0.97, 2 * 1.03, 7}, {5, 5 * 0.96, 5 * 1.04, 9});
  CHECK(product.median == 10);
  CHECK(product.low == Approx(9.5));
  CHECK(product.high == Approx(10.5));
  CHECK(product.count == 7);
  CHECK(times({}, product).count == 0);
}
