#include <burnish/image.h>

#include <algorithm>

namespace burnish {

Image makeImage(int width, int height, int channels, PixelType type) {
  Image image{std::max(width, 0), std::max(height, 0), std::clamp(channels, 1, 4), type, {}};
  image.data.resize(image.byteSize());
  return image;
}

}  // namespace burnish
