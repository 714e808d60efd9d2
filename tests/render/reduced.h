// A picture in larger pixels, for tests that hold one against many samples.
#pragma once
#include "render/scenes.h"

namespace burnish::test {

/// Averages n x n pixels of linear light.
inline Picture reduced(const Picture& p, int n) {
  Picture out{makeImage(p.image.width / n, p.image.height / n, 4, PixelType::F32), {}};
  for (int y = 0; y < out.image.height; ++y)
    for (int x = 0; x < out.image.width; ++x) {
      dvec3 sum(0);
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) sum += p.at(x * n + i, y * n + j);
      for (int c = 0; c < 3; ++c) out.image.f32()[(y * out.image.width + x) * 4 + c] = float(sum[c] / (n * n));
    }
  return out;
}

}  // namespace burnish::test
