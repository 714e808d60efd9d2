// Lat-long pictures as sources. Their rows are rings already: each is transformed along its circle alone, and Legendre functions are taken at the rows themselves.
#include <algorithm>
#include <cmath>
#include <complex>

#include "prefilter/parallel.h"
#include "prefilter/source.h"
#include "prefilter/source_parts.h"

namespace burnish::prefilter {
namespace {

constexpr double kPi = 3.14159265358979323846;
using Complex = std::complex<double>;

class LatLongSource final : public Source {
 public:
  LatLongSource(const Image& image, int threads) : image_(image), width_(std::size_t(image.width)), height_(std::size_t(image.height)) {
    for (std::size_t y = 0; y < height_; ++y) {
      const double polar = (double(y) + 0.5) / double(height_) * kPi, half = kPi / 2 / double(height_);
      cosine_.push_back(std::cos(polar));
      sine_.push_back(std::sin(polar));
      solidAngle_.push_back(2 * std::sin(polar) * std::sin(half) * 2 * kPi / double(width_));
    }
    std::vector<RowSum> rows(height_);
    forEachPiece(image.height, threads, [&](int y) { rows[std::size_t(y)] = rowSum(std::size_t(y)); });
    RowSum all;
    for (const RowSum& r : rows) all.light += r.light, all.solidAngle += r.solidAngle;
    const glm::dvec3 average = all.light / all.solidAngle;
    brightTexels_ = brightOf(texels(), std::max({average.x, average.y, average.z}), [&](std::size_t i) { return largest(texel(i)); });
    if (!brightTexels_.empty()) {
      forEachPiece(image.height, threads, [&](int y) { rows[std::size_t(y)] = rowSum(std::size_t(y)); });
      all = {};
      for (const RowSum& r : rows) all.light += r.light, all.solidAngle += r.solidAngle;
    }
    mean = all.solidAngle > 0 ? all.light / all.solidAngle : glm::dvec3(0);
    for (const std::uint32_t i : brightTexels_) {
      const glm::dvec3 at = direction(i), light = (radiance(i) - mean) * solidAngle_[i / width_];
      bright.insert(bright.end(), {at.x, at.y, at.z, light.x, light.y, light.z});
    }
  }
  [[nodiscard]] std::size_t texels() const override { return width_ * height_; }
  [[nodiscard]] double texelAngle() const override { return std::max(2 * kPi / double(width_), kPi / double(height_)) * std::sqrt(2.0); }

  [[nodiscard]] Harmonics analyse(int bands, const GridChoice& choice, int threads, double*) const override {
    Harmonics out(bands);
    const std::size_t half = (height_ + 1) / 2;
    RingSpectra spectra(std::vector<double>(cosine_.begin(), cosine_.begin() + std::ptrdiff_t(half)), bands);
    // Pieces of rows whose rings are of one size, so that the taps' weights are made once.
    struct Piece {
      std::size_t first, last;
      int size;
    };
    std::vector<Piece> pieces;
    for (std::size_t y = 0; y < half; ++y) {
      const int size = ringSize(y, bands, choice);
      if (pieces.empty() || pieces.back().size != size || pieces.back().last - pieces.back().first == 32) pieces.push_back({y, y, size});
      pieces.back().last = y + 1;
    }
    forEachPiece(int(pieces.size()), threads, [&](int i) { analyseRows(pieces[std::size_t(i)].first, pieces[std::size_t(i)].last, pieces[std::size_t(i)].size, choice, spectra); });
    analyseSpectra(spectra, threads, out);
    return out;
  }

  [[nodiscard]] const TexelsView& texelArrays(int threads) const override {
    if (!arrays_.v.empty()) return arrays_.view;
    arrays_.make(texels());
    forEachPiece(image_.height, threads, [&](int y) {
      for (std::size_t i = std::size_t(y) * width_; i < std::size_t(y + 1) * width_; ++i) arrays_.set(i, direction(i), (radiance(i) - mean) * solidAngle_[std::size_t(y)], solidAngle_[std::size_t(y)]);
    });
    for (const std::uint32_t i : brightTexels_) arrays_.set(i, direction(i), glm::dvec3(0), solidAngle_[i / width_]);
    return arrays_.view;
  }

  void runsNear(const glm::dvec3& d, double end, std::vector<Run>& runs) const override {
    runs.clear();
    const double angle = 2 * std::asin(std::sqrt(std::min(end / 2, 1.0))), polar = std::acos(std::clamp(d.y, -1.0, 1.0)), rowAngle = kPi / double(height_);
    const std::size_t first = std::size_t(std::clamp(std::floor((polar - angle) / rowAngle - 0.5), 0.0, double(height_ - 1)));
    const std::size_t last = std::size_t(std::clamp(std::ceil((polar + angle) / rowAngle - 0.5), 0.0, double(height_ - 1)));
    const double sine = std::hypot(d.x, d.z), centre = (std::atan2(d.x, -d.z) / (2 * kPi) + 0.5) * double(width_) - 0.5;
    for (std::size_t y = first; y <= last; ++y) {
      const std::uint32_t row = std::uint32_t(y * width_);
      // cos of the azimuth at which the cone leaves the row.
      const double c = (1 - end - d.y * cosine_[y]) / std::max(sine * sine_[y], 1e-30);
      if (c > 1 + 1e-9) {
        if (end > 1e-4) continue;
      }
      const double reach = c <= -1 ? double(width_) : (c >= 1 ? 0 : std::acos(c) / (2 * kPi) * double(width_)) + 1;
      if (2 * reach + 1 >= double(width_)) {
        runs.push_back({row, std::uint32_t(width_)});
        continue;
      }
      const std::ptrdiff_t w = std::ptrdiff_t(width_), from = std::ptrdiff_t(std::floor(centre - reach)), count = std::ptrdiff_t(std::ceil(centre + reach)) - from + 1;
      const std::ptrdiff_t start = ((from % w) + w) % w, before = std::min(count, w - start);
      runs.push_back({row + std::uint32_t(start), std::uint32_t(before)});
      if (count > before) runs.push_back({row, std::uint32_t(std::min(count - before, start))});
    }
  }

 private:
  [[nodiscard]] const float* texel(std::size_t i) const { return image_.f32() + i * std::size_t(image_.channels); }
  [[nodiscard]] glm::dvec3 radiance(std::size_t i) const { return {texel(i)[0], texel(i)[1], texel(i)[2]}; }
  [[nodiscard]] glm::dvec3 direction(std::size_t i) const {
    const std::size_t y = i / width_;
    const double longitude = ((double(i % width_) + 0.5) / double(width_) - 0.5) * 2 * kPi;
    return {sine_[y] * std::sin(longitude), -sine_[y] * std::cos(longitude), cosine_[y]};
  }
  /// The bright texels of a row.
  [[nodiscard]] std::pair<std::vector<std::uint32_t>::const_iterator, std::vector<std::uint32_t>::const_iterator> brightIn(std::size_t y) const {
    return {std::lower_bound(brightTexels_.begin(), brightTexels_.end(), std::uint32_t(y * width_)), std::lower_bound(brightTexels_.begin(), brightTexels_.end(), std::uint32_t((y + 1) * width_))};
  }
  [[nodiscard]] RowSum rowSum(std::size_t y) const {
    RowSum sum;
    auto [skip, end] = brightIn(y);
    for (std::size_t i = y * width_; i < (y + 1) * width_; ++i) {
      if (skip != end && *skip == i) {
        ++skip;
        continue;
      }
      sum.light += radiance(i);
      sum.solidAngle += 1;
    }
    sum.light *= solidAngle_[y];
    sum.solidAngle *= solidAngle_[y];
    return sum;
  }

  /// The highest order that P_lm on a row has anything of.
  [[nodiscard]] int lastOrder(std::size_t y, int bands) const { return std::min(bands, int(bands * sine_[y] + 13 + 0.02 * bands)); }
  /// Values of the ring that a row is spread to; the row's own where that is not longer and transforms well.
  [[nodiscard]] int ringSize(std::size_t y, int bands, const GridChoice& choice) const {
    const int size = smoothSize(std::max(int(std::ceil(2 * choice.oversampling * (lastOrder(y, bands) + 1))), 2 * int(choice.width) + 2));
    return size >= image_.width && smoothSize(image_.width) == image_.width ? image_.width : size;
  }

  void analyseRows(std::size_t first, std::size_t last, int size, const GridChoice& choice, RingSpectra& spectra) const {
    const bool direct = size == image_.width;
    const CircleKernel kernel(choice.width);
    const int taps = (int(choice.width) + 7) / 8 * 8;
    std::vector<double> weights;
    std::vector<std::int32_t> start;
    if (!direct) {
      weights.assign(width_ * std::size_t(taps), 0.0);
      for (std::size_t x = 0; x < width_; ++x) {
        const double at = (double(x) + 0.5) * size / double(width_);
        const int k0 = int(std::ceil(at - choice.width / 2));
        start.push_back(k0 + kRingPad);
        for (int t = 0; t < taps; ++t) weights[x * std::size_t(taps) + std::size_t(t)] = kernel(at - (k0 + t));
      }
    }
    const std::size_t stride = std::size_t(size) + 2 * kRingPad;
    std::vector<double> values(3 * width_), rows[2];
    const kissfft<double> fft(std::size_t(size), false);
    std::vector<Complex> in(std::size_t(size) + 1), z(in.size());
    const int bands = spectra.bands;
    std::vector<double> spectrum[2];
    // F_m = Σ v e^(-i m φ): azimuth of column x is (x + 1/2)/width - 3/4 turns, since +X is at 0 and the left edge looks along +Z.
    for (std::size_t y = first; y < last; ++y) {
      const std::size_t mirrored = height_ - 1 - y;
      const int order = lastOrder(y, bands), sides = mirrored == y ? 1 : 2;
      for (int side = 0; side < 2; ++side) {
        rows[side].assign(3 * stride, 0.0);
        spectrum[side].assign(std::size_t(order + 1) * kParts, 0.0);
        if (side < sides) spreadOne(side ? mirrored : y, size, direct, taps, weights, start, values, rows[side], stride);
      }
      // Rows of two channels or of two sides as one complex row.
      const auto transform = [&](const double* a, const double* b, double* outA, double* outB) {
        for (int k = 0; k < size; ++k) in[std::size_t(k)] = {a[k], b[k]};
        fft.transform(in.data(), z.data());
        for (int m = 0; m <= order; ++m) {
          const std::size_t at = std::size_t(m % size);
          const Complex p = z[at], q = std::conj(z[at ? std::size_t(size) - at : 0]);
          // Turned by 3/4 of a turn, and by half a texel where the row itself was transformed.
          static constexpr double kRe[4] = {1, 0, -1, 0}, kIm[4] = {0, -1, 0, 1};
          Complex turn(kRe[m % 4], kIm[m % 4]);
          turn *= direct ? std::polar(1.0, -kPi * m / double(width_)) : Complex(1 / kernel.transform(m, size), 0);
          const Complex fa = (p + q) * 0.5 * turn, fb = (p - q) * Complex(0, -0.5) * turn;
          outA[std::size_t(m) * kParts] = fa.real(), outA[std::size_t(m) * kParts + 1] = fa.imag();
          outB[std::size_t(m) * kParts] = fb.real(), outB[std::size_t(m) * kParts + 1] = fb.imag();
        }
      };
      const double *north = rows[0].data() + kRingPad, *south = rows[1].data() + kRingPad;
      transform(north, north + stride, spectrum[0].data(), spectrum[0].data() + 2);
      transform(south, south + stride, spectrum[1].data(), spectrum[1].data() + 2);
      transform(north + 2 * stride, south + 2 * stride, spectrum[0].data() + 4, spectrum[1].data() + 4);
      // The fourth channel is constant along a row: it has orders 0, width, 2 width ...
      for (int m = 0; m <= order; m += image_.width) {
        const double turn = kPi * 2 * (0.75 * m - 0.5 * m / double(width_)), light = solidAngle_[y] * double(width_);
        for (int side = 0; side < sides; ++side) {
          spectrum[side][std::size_t(m) * kParts + 6] = light * std::cos(turn);
          spectrum[side][std::size_t(m) * kParts + 7] = light * std::sin(turn);
        }
      }
      for (int m = 0; m <= order; ++m)
        for (int c = 0; c < kParts; ++c) {
          const double a = spectrum[0][std::size_t(m * kParts + c)], b = spectrum[1][std::size_t(m * kParts + c)];
          spectra.at(m, y)[c] = a + b;
          spectra.at(m, y)[kParts + c] = a - b;
        }
    }
  }

  void spreadOne(std::size_t y, int size, bool direct, int taps, const std::vector<double>& weights, const std::vector<std::int32_t>& start, std::vector<double>& values, std::vector<double>& row,
                 std::size_t stride) const {
    const double w = solidAngle_[y];
    for (std::size_t x = 0; x < width_; ++x)
      for (std::size_t c = 0; c < 3; ++c) values[3 * x + c] = (double(texel(y * width_ + x)[c]) - mean[int(c)]) * w;
    const auto [begin, end] = brightIn(y);
    for (auto i = begin; i != end; ++i)
      for (std::size_t c = 0; c < 3; ++c) values[3 * (*i % width_) + c] = 0;
    if (direct) {
      for (std::size_t x = 0; x < width_; ++x)
        for (std::size_t c = 0; c < 3; ++c) row[c * stride + kRingPad + x] = values[3 * x + c];
      return;
    }
    spreadRow(values.data(), width_, weights.data(), start.data(), taps, row.data(), stride);
    for (std::size_t c = 0; c < 3; ++c) {
      double* a = row.data() + c * stride + kRingPad;
      for (int k = 1; k <= kRingPad; ++k) a[((-k % size) + size) % size] += a[-k];
      for (int k = size; k < size + kRingPad; ++k) a[k % size] += a[k];
    }
  }

  const Image& image_;
  std::size_t width_, height_;
  std::vector<double> cosine_, sine_, solidAngle_;  ///< by row
  mutable TexelArrays arrays_;
};

}  // namespace

std::unique_ptr<Source> makeSource(const Image& latLong, int threads) { return std::make_unique<LatLongSource>(latLong, threads); }

}  // namespace burnish::prefilter
