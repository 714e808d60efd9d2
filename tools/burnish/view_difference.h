// How far two pictures are apart: figures, and a map in colours that get lighter as it grows.
#pragma once
#include <burnish/image.h>

#include <glm/glm.hpp>

namespace cli::viewer {

/// A pixel's difference d is the largest of its channels' |B - A| over the exposure's white, linear.
struct Difference {
  burnish::Image heat;   ///< U8 RGBA; black exactly where the pictures are equal
  double scale = 0;      ///< the d of the lightest colour
  double rms = 0;        ///< root mean square of B - A over that of A, all channels
  double energy = 0;     ///< sum of B over that of A, less 1: above 0 B is brighter
  double over = 0;       ///< share of the pixels with d over the threshold
  double largest = 0;    ///< d
  long long skipped = 0; ///< pixels that are not finite in either; they are not counted, and magenta
};
/// `a`, `b`: F32 RGBA of one size, cd/m². `white`: cd/m². `scale` 0: the smallest round one that all but a thousandth of the pixels keep.
Difference differenceOf(const burnish::Image& a, const burnish::Image& b, double white, double scale, double threshold);

/// From dark violet (just above 0; equal pixels are black) over red to pale yellow (1). Lightness grows in proportion (Oklab, Ottosson 2020), so that a lighter colour is always more, for the colour-blind too. sRGB, 0..1.
glm::dvec3 heatColor(double t);

}  // namespace cli::viewer
