// Changing the size of pictures.
#pragma once
#include <burnish/image.h>

namespace burnish::image {

/// How the values of a U8 picture are averaged: as they are, or as linear light (colour channels decoded from sRGB and
/// encoded again; alpha as it is). Other types are averaged as they are.
enum class AverageIn { Values, LinearLight };

/// Area resampling: each new pixel is the exact mean of the source area that it covers (a box filter; 2:1 is the usual
/// mip step, and sizes need not divide). Enlarging gives blocks with blended borders. Keeps type and channels; U8 and
/// U16 round to nearest. width, height >= 1; an empty image stays empty.
Image resampleArea(const Image& image, int width, int height, AverageIn average = AverageIn::Values);

}  // namespace burnish::image
