// Flat pictures of floats as KTX2: tables that other programs can read as textures.
#pragma once
#include <burnish/image.h>

#include <string_view>

namespace burnish::image {

/// F32 with 2, 3 or 4 channels (R32G32_SFLOAT, R32G32B32_SFLOAT, R32G32B32A32_SFLOAT), one level, rows from the top. The same picture gives the same bytes.
std::vector<std::byte> encodeKtx2Picture(const Image& picture);
/// Reads such a file, and no other kind. Sizes are checked against the limits and the file's length before anything is allocated; values are those of the file.
Result<Image> decodeKtx2Picture(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits);

}  // namespace burnish::image
