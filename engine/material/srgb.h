// Linear light to 8-bit sRGB, inlined for the map builders' inner loops (image/convert.h has the other direction's
// table).
#pragma once
#include <array>
#include <cstdint>

namespace burnish::material {

/// Linear 0..1 to the nearest 8-bit sRGB code. Values outside are clamped; NaN gives 0.
class SrgbEncoder {
 public:
  SrgbEncoder();
  [[nodiscard]] std::uint8_t operator()(float x) const {
    if (!(x > 0)) return 0;
    if (x >= 1) return 255;
    const unsigned guess = guess_[unsigned(x * kBuckets)];
    return std::uint8_t(guess + (x >= threshold_[guess]));
  }

 private:
  // The code's steps are at least 1/(12.92 · 255) apart, more than one bucket: a bucket holds at most one threshold.
  static constexpr unsigned kBuckets = 4096;
  std::array<std::uint8_t, kBuckets> guess_;  ///< code at the bucket's lower end
  std::array<float, 256> threshold_;          ///< least linear value of the next code
};
const SrgbEncoder& linearToSrgb();

}  // namespace burnish::material
