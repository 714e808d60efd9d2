// Picture files made on the fly for the decoder tests.
#pragma once
#include <burnish/image.h>

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "paths.h"

namespace decode_test {

using Bytes = std::vector<std::byte>;

struct PngOptions {
  int colorType = 2;  ///< as in IHDR: 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA
  int bits = 8;
  bool interlaced = false;
  bool transparency = false;  ///< a tRNS chunk (types 0, 2: value 0 is transparent; 3: entry i has alpha 255 - i)
  int level = 6;              ///< of compression
};
/// The sample of channel c at x, y is `value(x, y, c)`. Palettes: entry i is (i, 2i, 255 - i), all 2^bits of them.
Bytes makePng(int width, int height, const PngOptions& options, const std::function<unsigned(int, int, int)>& value);

/// Flat RGBE pixels; `resolution` is the whole line, for example "-Y 4 +X 8".
Bytes makeHdr(std::string_view resolution, int pixels, const std::function<std::uint32_t(int)>& rgbe);

struct ExrOptions {
  int dataX = 0, dataY = 0, dataWidth = 4, dataHeight = 4;
  int displayX = 0, displayY = 0, displayWidth = 4, displayHeight = 4;
  std::vector<const char*> channels = {"R", "G", "B"};
  bool half = false;
  bool tiled = false;
  int compression = 3;  ///< Imf::Compression; 3 is ZIP
};
/// The value of channel number c at x, y (coordinates of the data window) is `value(x, y, c)`.
Bytes makeExr(const ExrOptions& options, const std::function<float(int, int, int)>& value);

/// The bytes of a string or array.
Bytes bytesOf(std::string_view text);
template <class Array>
Bytes bytesOfArray(const Array& array) {
  Bytes bytes;
  for (auto value : array) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

/// The program under test, beside the tests.
inline constexpr const char* kHelper = BURNISH_BINARY_DIR "/bin/burnish-decode";
/// One pool for all tests of a file: starting one costs 160 ms.
burnish::ImageDecoder& sharedPool();

}  // namespace decode_test
