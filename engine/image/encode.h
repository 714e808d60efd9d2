// PNG and OpenEXR files in memory; writePng and writeExr put them on disk.
#pragma once
#include <burnish/image.h>

#include <string>
#include <utility>

namespace burnish::image {

/// `place` names the picture in errors. U8 only. The same image gives the same bytes.
Result<std::vector<std::byte>> encodePng(const Image& image, std::string_view place);
/// F16 and F32 only; ZIP compression (lossless). Channels are named Y, YA, RGB, RGBA. The same image gives the same
/// bytes. `attributes`: names and texts that go into the header.
Result<std::vector<std::byte>> encodeExr(const Image& image, std::string_view place,
                                         std::span<const std::pair<std::string, std::string>> attributes = {});

}  // namespace burnish::image
