// Halving and enlarging of interleaved float images.
#pragma once
#include <vector>

namespace burnish::material {

/// Interleaved floats, rows top to bottom.
struct FloatImage {
  int width = 0, height = 0, channels = 0;
  std::vector<float> data;
  [[nodiscard]] float* row(int y) { return data.data() + std::size_t(y) * width * channels; }
  [[nodiscard]] const float* row(int y) const { return data.data() + std::size_t(y) * width * channels; }
};

/// One side of a box filter from n to max(1, n/2) samples: output i is the sum of weight[k] · input[first + k].
struct HalvingTap {
  int first = 0, count = 1;
  float weight[3] = {1, 0, 0};
};
/// Area weights: exact for odd n too (polyphase box; Guthe and Heckbert, "Non-Power-of-Two Mipmapping", NVIDIA 2005).
std::vector<HalvingTap> halvingTaps(int n);

}  // namespace burnish::material
