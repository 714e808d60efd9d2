// How far one picture is from another.
#pragma once
#include <burnish/measure.h>

namespace burnish::cost {

/// A picture and the same developed for a display.
struct Developed {
  const Image& linear;   ///< F32, 3 or 4 channels (the 4th does not count), cd/m²
  const Image& display;  ///< U8 RGB; empty: psnr and perceptual are 0
};

/// `variance`: of each value of `other` (F32, 3 channels), taken off the squared difference and off the other's power; nullptr or empty: none. Pixels whose standard error is over half of the
/// pixel's value and the picture's mean together say nothing: they are left out of rms and energy and counted in PictureError::uncertain. All pictures are of one size.
PictureError errorOf(const Developed& picture, const Developed& other, const Image* variance = nullptr);

/// Butteraugli's 3-norm (libjxl) between two U8 sRGB pictures of one size; pictures under 8 pixels a side are repeated at their edges. 0 where the library fails.
double butteraugli(const Image& picture, const Image& other);
/// dB over all channels; infinite where they are equal.
double psnr(const Image& picture, const Image& other);
/// |picture - other| over `white`, luminance (Rec. 709), F32, one channel; pixels that are not finite: 0.
Image differenceOf(const Image& picture, const Image& other, double white);

}  // namespace burnish::cost
