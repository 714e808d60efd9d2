// Decoding with OpenImageIO: the one place that calls it, shared by the helper program and the in-process decoder.
#pragma once
#include "image/picture_header.h"

namespace burnish::decode {

struct Decoded {
  int width = 0, height = 0, channels = 0;
  PixelType type = PixelType::U8;
};

/// Where the pixels go, in order, in pieces.
class PixelSink {
 public:
  virtual ~PixelSink() = default;
  /// Called once, before any pixel. False: there is no room for that many.
  virtual bool begin(const Decoded& layout, std::size_t bytes) = 0;
  /// Where the next pixels go; not empty. Valid until the next call.
  virtual std::span<std::byte> room() = 0;
  /// The first `bytes` of room() are filled. False: nobody wants more.
  virtual bool commit(std::size_t bytes) = 0;
};

/// Settings that hold for the process: no threads, no OpenImageIO thread pool. Loads its list of formats.
void prepareOpenImageIo();

/// Decodes `file` into `sink`. No colour conversion, no premultiplication, no orientation but a Radiance file's own
/// order of rows. More than four channels: the first four. OpenEXR: the display window, zero where there is no data.
/// Catches everything that OpenImageIO throws; it may still crash or hang on a damaged file.
Result<Decoded> decodePicture(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits,
                              PixelSink& sink);

}  // namespace burnish::decode
