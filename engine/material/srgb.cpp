#include "material/srgb.h"

#include <cmath>

namespace burnish::material {
namespace {
double decode(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }
}  // namespace

SrgbEncoder::SrgbEncoder() {
  // Nearest in the encoded value: the border between i and i + 1 is the code i + 0.5.
  for (int i = 0; i < 256; ++i) threshold_[i] = i < 255 ? float(decode((i + 0.5) / 255)) : 2.0f;
  unsigned code = 0;
  for (unsigned b = 0; b < kBuckets; ++b) {
    const float low = float(b) / kBuckets;
    while (code < 255 && low >= threshold_[code]) ++code;
    guess_[b] = std::uint8_t(code);
  }
}

const SrgbEncoder& linearToSrgb() {
  static const SrgbEncoder encoder;
  return encoder;
}

}  // namespace burnish::material
