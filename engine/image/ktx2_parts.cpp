#include "image/ktx2_parts.h"

#include <fmt/format.h>

namespace burnish::image {

tl::unexpected<Error> damagedKtx2(std::string_view name, std::size_t at, std::string what) {
  return fail(fmt::format("{}: byte {}", name, at), "is a damaged KTX2 file: " + std::move(what), "export the file again");
}
tl::unexpected<Error> unsupportedKtx2(std::string_view name, std::size_t at, std::string what, const char* remedy) {
  return fail(fmt::format("{}: byte {}", name, at), "is a KTX2 file of a kind that is not read here: " + std::move(what), remedy);
}

Result<Ktx2Header> readKtx2Header(Bytes& in, std::string_view name) {
  Ktx2Header h;
  in.skip(kKtx2Identifier.size());
  h.vkFormat = in.leU32(), h.typeSize = in.leU32(), h.width = in.leU32(), h.height = in.leU32(), h.depth = in.leU32();
  h.layers = in.leU32(), h.faces = in.leU32(), h.levels = in.leU32(), h.supercompression = in.leU32();
  h.dfdOffset = in.leU32(), h.dfdBytes = in.leU32(), h.kvdOffset = in.leU32(), h.kvdBytes = in.leU32();
  in.skip(16);  // supercompression's global data
  if (in.bad()) return damagedKtx2(name, in.position(), "its header is cut off");
  return h;
}

void writeKtx2Header(ByteWriter& out, const Ktx2Header& h) {
  out.text(kKtx2Identifier);
  for (const std::uint32_t v : {h.vkFormat, h.typeSize, h.width, h.height, h.depth, h.layers, h.faces, h.levels, h.supercompression, h.dfdOffset, h.dfdBytes, h.kvdOffset, h.kvdBytes}) out.u32(v);
  out.u64(0), out.u64(0);
}

/// Version 2 (Data Format 1.3), RGBSDA, BT.709, linear, straight alpha.
std::vector<std::byte> ktx2Descriptor(std::uint32_t channels, std::uint32_t channelBits) {
  const std::uint32_t block = 24 + 16 * channels;
  ByteWriter out;
  out.u32(4 + block);
  out.u32(0);
  out.u32(2 | block << 16);
  out.u32(1 | 1 << 8 | 1 << 16);
  out.u32(0);
  out.u32(channels * channelBits / 8), out.u32(0);  // bytes of a texel
  for (std::uint32_t c = 0; c < channels; ++c) {
    const std::uint32_t channel = c == 3 ? 15 : c, floatSigned = 0xc0;
    out.u32(c * channelBits | (channelBits - 1) << 16 | (channel | floatSigned) << 24);
    out.u32(0);
    out.u32(0xbf800000), out.u32(0x3f800000);  // -1 and 1
  }
  return out.take();
}

}  // namespace burnish::image
