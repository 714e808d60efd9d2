// Butteraugli through libjxl's C interface.
#include <jxl/butteraugli.h>

#include <algorithm>
#include <memory>

#include "cost/metrics.h"

namespace burnish::cost {
namespace {

constexpr int kLeastSide = 8;  // the library compares no smaller pictures

/// The picture, its last row and column repeated up to the library's least side.
Image enlarged(const Image& picture) {
  if (picture.width >= kLeastSide && picture.height >= kLeastSide) return picture;
  Image large = makeImage(std::max(picture.width, kLeastSide), std::max(picture.height, kLeastSide), 3, PixelType::U8);
  for (int y = 0; y < large.height; ++y)
    for (int x = 0; x < large.width; ++x) {
      const std::size_t from = std::size_t(std::min(y, picture.height - 1)) * std::size_t(picture.width) + std::size_t(std::min(x, picture.width - 1));
      std::copy_n(picture.u8() + 3 * from, 3, large.u8() + 3 * (std::size_t(y) * std::size_t(large.width) + std::size_t(x)));
    }
  return large;
}

}  // namespace

double butteraugli(const Image& picture, const Image& other) {
  if (other.empty() || picture.data == other.data) return 0;
  const Image a = enlarged(other), b = enlarged(picture);
  const JxlPixelFormat format{3, JXL_TYPE_UINT8, JXL_NATIVE_ENDIAN, 0};  // 8-bit values are taken as sRGB
  const std::unique_ptr<JxlButteraugliApi, void (*)(JxlButteraugliApi*)> api(JxlButteraugliApiCreate(nullptr), JxlButteraugliApiDestroy);
  if (!api) return 0;
  const std::unique_ptr<JxlButteraugliResult, void (*)(JxlButteraugliResult*)> result(
      JxlButteraugliCompute(api.get(), std::uint32_t(a.width), std::uint32_t(a.height), &format, a.u8(), a.data.size(), &format, b.u8(), b.data.size()), JxlButteraugliResultDestroy);
  return result ? double(JxlButteraugliResultGetDistance(result.get(), 3)) : 0;
}

}  // namespace burnish::cost
