// What KTX2 cubes and flat KTX2 pictures have in common.
#pragma once
#include <burnish/image.h>

#include <string>
#include <string_view>

#include "image/bytes.h"

namespace burnish::image {

inline constexpr std::string_view kKtx2Identifier("\xabKTX 20\xbb\r\n\x1a\n", 12);
inline constexpr std::size_t kKtx2HeaderBytes = 80, kKtx2LevelBytes = 24;

struct Ktx2Header {
  std::uint32_t vkFormat = 0, typeSize = 0, width = 0, height = 0, depth = 0, layers = 0, faces = 0, levels = 0, supercompression = 0;
  std::uint32_t dfdOffset = 0, dfdBytes = 0, kvdOffset = 0, kvdBytes = 0;
};

/// Errors of a file called `name`, at byte `at`.
tl::unexpected<Error> damagedKtx2(std::string_view name, std::size_t at, std::string what);
tl::unexpected<Error> unsupportedKtx2(std::string_view name, std::size_t at, std::string what, const char* remedy);

/// The identifier must have been looked at.
Result<Ktx2Header> readKtx2Header(Bytes& in, std::string_view name);
/// Identifier and header up to the level index.
void writeKtx2Header(ByteWriter& out, const Ktx2Header& header);
/// Basic descriptor block of 1 to 4 float channels of 16 or 32 bits (R, G, B, A).
std::vector<std::byte> ktx2Descriptor(std::uint32_t channels, std::uint32_t channelBits);

}  // namespace burnish::image
