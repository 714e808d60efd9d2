// Written from Khronos' "KTX File Format Specification", version 2.0, as ktx2.cpp is.
#include "image/ktx2_picture.h"

#include <fmt/format.h>

#include <numeric>

#include "image/cube_file.h"
#include "image/ktx2_parts.h"

namespace burnish::image {
namespace {

constexpr std::uint32_t kFormats[] = {0, 0, 103, 106, 109};  // by channels

int channelsOf(std::uint32_t vkFormat) {
  for (int c = 2; c <= 4; ++c)
    if (kFormats[c] == vkFormat) return c;
  return 0;
}

/// The level's bytes must stand at a multiple of this.
std::size_t alignmentOf(int channels) { return std::lcm(std::size_t(4) * std::size_t(channels), std::size_t(4)); }

Result<void> checkShape(const Ktx2Header& h, std::string_view name, const DecodeLimits& limits) {
  const char* remedy = "write a flat picture of R32G32_SFLOAT, R32G32B32_SFLOAT or R32G32B32A32_SFLOAT with one level";
  if (channelsOf(h.vkFormat) == 0) return unsupportedKtx2(name, 12, fmt::format("Vulkan format {}", h.vkFormat), remedy);
  if (h.depth != 0 || h.layers > 1 || h.faces != 1 || h.levels > 1) return unsupportedKtx2(name, 28, fmt::format("depth {}, {} layers, {} faces, {} levels", h.depth, h.layers, h.faces, h.levels), remedy);
  if (h.supercompression != 0) return unsupportedKtx2(name, 44, fmt::format("supercompressed (scheme {})", h.supercompression), "write it without supercompression");
  const auto most = static_cast<std::uint32_t>(std::max(limits.maxSide, 0));
  if (h.width == 0 || h.height == 0 || h.width > most || h.height > most) return damagedKtx2(name, 20, fmt::format("it is {} x {} texels, the limit is {}", h.width, h.height, most));
  const std::uint64_t bytes = std::uint64_t(h.width) * h.height * 4 * static_cast<std::uint64_t>(channelsOf(h.vkFormat));
  if (bytes > limits.maxBytes) return damagedKtx2(name, 20, fmt::format("it takes {} bytes decoded, the limit is {}", bytes, limits.maxBytes));
  return {};
}

}  // namespace

std::vector<std::byte> encodeKtx2Picture(const Image& picture) {
  const std::vector<std::byte> dfd = ktx2Descriptor(static_cast<std::uint32_t>(picture.channels), 32), kvd = encodeKeyValues({{"KTXorientation", "rd"}, {"KTXwriter", writerName()}});
  const std::size_t dfdAt = kKtx2HeaderBytes + kKtx2LevelBytes, kvdAt = dfdAt + dfd.size(), alignment = alignmentOf(picture.channels);
  Ktx2Header header;
  header.vkFormat = kFormats[picture.channels], header.typeSize = 4;
  header.width = static_cast<std::uint32_t>(picture.width), header.height = static_cast<std::uint32_t>(picture.height);
  header.faces = header.levels = 1;
  header.dfdOffset = static_cast<std::uint32_t>(dfdAt), header.dfdBytes = static_cast<std::uint32_t>(dfd.size());
  header.kvdOffset = static_cast<std::uint32_t>(kvdAt), header.kvdBytes = static_cast<std::uint32_t>(kvd.size());
  ByteWriter out;
  writeKtx2Header(out, header);
  const std::size_t first = (kvdAt + kvd.size() + alignment - 1) / alignment * alignment;
  out.u64(first), out.u64(picture.data.size()), out.u64(picture.data.size());
  out.bytes(dfd);
  out.bytes(kvd);
  out.align(alignment);
  out.bytes(picture.data);
  return out.take();
}

Result<Image> decodeKtx2Picture(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits) {
  if (!isKtx2(file)) return fail(std::string(name), "is no KTX2 file", "write it again");
  Bytes in(file);
  const auto header = readKtx2Header(in, name);
  if (!header) return fail(header.error());
  if (auto ok = checkShape(*header, name, limits); !ok) return fail(ok.error());
  const std::uint64_t offset = in.leU64(), bytes = in.leU64(), uncompressed = in.leU64();
  if (in.bad()) return damagedKtx2(name, file.size(), "its level index is cut off");
  const int channels = channelsOf(header->vkFormat);
  const std::uint64_t expected = std::uint64_t(header->width) * header->height * 4 * static_cast<std::uint64_t>(channels);
  if (bytes != expected || uncompressed != expected) return damagedKtx2(name, kKtx2HeaderBytes + 8, fmt::format("its level is {} bytes long, not {}", bytes, expected));
  if (offset > file.size() || bytes > file.size() - offset) return damagedKtx2(name, kKtx2HeaderBytes, fmt::format("its level lies at {}, past the end at {}", offset, file.size()));
  Image picture = makeImage(static_cast<int>(header->width), static_cast<int>(header->height), channels, PixelType::F32);
  std::memcpy(picture.data.data(), file.data() + offset, picture.data.size());
  return picture;
}

}  // namespace burnish::image
