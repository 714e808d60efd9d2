// Decoding with OpenImageIO: the one place that calls it, shared by the helper program and the in-process decoder.
#pragma once
#include <functional>

#include "image/picture_header.h"

namespace burnish::decode {

struct Decoded {
  int width = 0, height = 0, channels = 0;
  PixelType type = PixelType::U8;
};

/// Where the pixels go: called once, with their layout, before decoding; returns room for them (null: refuses, with no room).
using Placement = std::function<std::byte*(const Decoded&, std::size_t bytes)>;

/// Settings that hold for the process: no threads, no OpenImageIO thread pool. Loads its list of formats.
void prepareOpenImageIo();

/// Decodes `file` to where `place` says. No colour conversion, no premultiplication, no orientation but a Radiance file's own
/// order of rows. More than four channels: the first four. OpenEXR: the display window, zero where there is no data.
/// Catches everything that OpenImageIO throws; it may still crash or hang on a damaged file.
Result<Decoded> decodePicture(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits, const Placement& place);

}  // namespace burnish::decode
