#include "image/resample.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "image/convert.h"

namespace burnish::image {
namespace {

/// The source pixels that one new pixel covers, on one axis: weights sum to 1.
struct Span {
  int first = 0;
  std::vector<float> weights;
};

std::vector<Span> spansOf(int from, int to) {
  std::vector<Span> spans(static_cast<std::size_t>(to));
  const double scale = static_cast<double>(from) / to;
  for (int i = 0; i < to; ++i) {
    const double begin = i * scale, end = std::min<double>((i + 1) * scale, from);
    Span& span = spans[static_cast<std::size_t>(i)];
    span.first = std::min(static_cast<int>(begin), from - 1);
    for (int p = span.first; p < from && p < end; ++p) {
      const double covered = std::min<double>(end, p + 1) - std::max<double>(begin, p);
      if (covered > 1e-9 * scale || span.weights.empty()) span.weights.push_back(static_cast<float>(covered / scale));
    }
  }
  return spans;
}

class RowFormat {
 public:
  RowFormat(const Image& image, AverageIn average)
      : channels_(image.channels),
        type_(image.type),
        srgb_(average == AverageIn::LinearLight && image.type == PixelType::U8) {}

  void load(const Image& image, int y, std::vector<float>& row) const {
    const std::size_t n = row.size(), at = std::size_t(y) * n;
    const auto* words = reinterpret_cast<const std::uint16_t*>(image.data.data()) + at;
    switch (type_) {
      case PixelType::F32:
        std::copy_n(image.f32() + at, n, row.begin());
        break;
      case PixelType::F16:
        halfToFloat({words, n}, row);
        break;
      case PixelType::U16:
        std::copy_n(words, n, row.begin());
        break;
      case PixelType::U8:
        for (std::size_t i = 0; i < n; ++i)
          row[i] = curved(i) ? srgbToLinearTable()[image.u8()[at + i]] : static_cast<float>(image.u8()[at + i]);
    }
  }
  void store(const std::vector<float>& row, Image& image, int y) const {
    const std::size_t n = row.size(), at = std::size_t(y) * n;
    auto* words = reinterpret_cast<std::uint16_t*>(image.data.data()) + at;
    switch (type_) {
      case PixelType::F32:
        std::copy_n(row.begin(), n, image.f32() + at);
        break;
      case PixelType::F16:
        floatToHalf(row, {words, n});
        break;
      case PixelType::U16:
        for (std::size_t i = 0; i < n; ++i)
          words[i] = static_cast<std::uint16_t>(std::clamp(row[i] + 0.5f, 0.0f, 65535.0f));
        break;
      case PixelType::U8:
        for (std::size_t i = 0; i < n; ++i)
          image.u8()[at + i] =
              curved(i) ? linearToSrgb8(row[i]) : static_cast<std::uint8_t>(std::clamp(row[i] + 0.5f, 0.0f, 255.0f));
    }
  }

 private:
  [[nodiscard]] bool curved(std::size_t i) const {
    const auto n = static_cast<std::size_t>(channels_);
    return srgb_ && ((n & 1) == 1 || i % n != n - 1);
  }
  int channels_;
  PixelType type_;
  bool srgb_;
};

}  // namespace

Image resampleArea(const Image& image, int width, int height, AverageIn average) {
  if (image.empty()) return image;
  Image out = makeImage(std::max(width, 1), std::max(height, 1), image.channels, image.type);
  const auto columns = spansOf(image.width, out.width), lines = spansOf(image.height, out.height);
  const RowFormat format(image, average);
  const auto channels = static_cast<std::size_t>(image.channels);
  std::vector<float> source(std::size_t(image.width) * channels), sum(source.size()),
      result(std::size_t(out.width) * channels);
  for (int y = 0; y < out.height; ++y) {
    const Span& line = lines[static_cast<std::size_t>(y)];
    std::fill(sum.begin(), sum.end(), 0.0f);
    for (std::size_t k = 0; k < line.weights.size(); ++k) {
      format.load(image, line.first + static_cast<int>(k), source);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += line.weights[k] * source[i];
    }
    std::fill(result.begin(), result.end(), 0.0f);
    for (std::size_t x = 0; x < columns.size(); ++x)
      for (std::size_t k = 0; k < columns[x].weights.size(); ++k)
        for (std::size_t c = 0; c < channels; ++c)
          result[x * channels + c] +=
              columns[x].weights[k] * sum[(static_cast<std::size_t>(columns[x].first) + k) * channels + c];
    format.store(result, out, y);
  }
  return out;
}

}  // namespace burnish::image
