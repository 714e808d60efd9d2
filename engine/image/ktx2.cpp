// KTX2 cubes, written from Khronos' "KTX File Format Specification", version 2.0 (registry.khronos.org/KTX), and the basic descriptor block of the Khronos Data Format Specification 1.3. The faces
// of a level stand together, in the order +X -X +Y -Y +Z -Z; the smallest level comes first. Numbers are little-endian.
#include <fmt/format.h>

#include "image/cube_file.h"
#include "image/cube_texels.h"
#include "image/ktx2_parts.h"

namespace burnish::image {
namespace {

Result<void> checkShape(const Ktx2Header& h, std::string_view name) {
  const char* remedy = "export a cube map with six faces";
  if (h.faces != 6) return unsupportedKtx2(name, 36, fmt::format("{} faces, no cube", h.faces), remedy);
  if (h.layers > 1) return unsupportedKtx2(name, 32, fmt::format("an array of {} cubes", h.layers), "export one cube");
  if (h.depth != 0) return unsupportedKtx2(name, 28, "a volume", remedy);
  if (h.width == 0 || h.width != h.height || h.width > 0x7fffffff / 2) return damagedKtx2(name, 20, fmt::format("its faces are {} x {}, not square", h.width, h.height));
  if (h.supercompression != 0) {
    constexpr std::string_view kNames[] = {"", "BasisLZ", "Zstandard", "ZLIB"};
    const std::string scheme = h.supercompression < 4 ? std::string(kNames[h.supercompression]) : fmt::format("scheme {}", h.supercompression);
    return unsupportedKtx2(name, 44, "supercompressed with " + scheme, "export it without supercompression");
  }
  return {};
}

Result<TexelLayout> layoutOf(const Ktx2Header& h, std::string_view name) {
  switch (h.vkFormat) {
    case 23: return TexelLayout{TexelFormat::Rgb8, false, "R8G8B8_UNORM"};
    case 29: return TexelLayout{TexelFormat::Rgb8, true, "R8G8B8_SRGB"};
    case 30: return TexelLayout{TexelFormat::Bgr8, false, "B8G8R8_UNORM"};
    case 36: return TexelLayout{TexelFormat::Bgr8, true, "B8G8R8_SRGB"};
    case 37: return TexelLayout{TexelFormat::Rgba8, false, "R8G8B8A8_UNORM"};
    case 43: return TexelLayout{TexelFormat::Rgba8, true, "R8G8B8A8_SRGB"};
    case 44: return TexelLayout{TexelFormat::Bgra8, false, "B8G8R8A8_UNORM"};
    case 50: return TexelLayout{TexelFormat::Bgra8, true, "B8G8R8A8_SRGB"};
    case 90: return TexelLayout{TexelFormat::Rgb16F, false, "R16G16B16_SFLOAT"};
    case 97: return TexelLayout{TexelFormat::Rgba16F, false, "R16G16B16A16_SFLOAT"};
    case 106: return TexelLayout{TexelFormat::Rgb32F, false, "R32G32B32_SFLOAT"};
    case 109: return TexelLayout{TexelFormat::Rgba32F, false, "R32G32B32A32_SFLOAT"};
    case 122: return TexelLayout{TexelFormat::Rg11B10F, false, "B10G11R11_UFLOAT_PACK32"};
    case 123: return TexelLayout{TexelFormat::Rgb9E5, false, "E5B9G9R9_UFLOAT_PACK32"};
    case 0: return unsupportedKtx2(name, 12, "Basis Universal or another format without a Vulkan name", "export R16G16B16A16_SFLOAT");
    default: return unsupportedKtx2(name, 12, fmt::format("Vulkan format {}", h.vkFormat), "export R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT");
  }
}

/// Texels of level k, from where the level index says that they are.
Result<void> readLevel(CubeLevel& level, int k, std::span<const std::byte> file, const TexelLayout& layout, std::string_view name) {
  const std::size_t entry = kKtx2HeaderBytes + kKtx2LevelBytes * static_cast<std::size_t>(k);
  Bytes in(file.subspan(entry));
  const std::uint64_t offset = in.leU64(), bytes = in.leU64();
  const std::uint64_t expected = level.texels.size() / 3 * bytesPerTexel(layout.format);
  if (bytes != expected) return damagedKtx2(name, entry + 8, fmt::format("level {} is {} bytes long, not {}", k, bytes, expected));
  if (offset > file.size() || bytes > file.size() - offset) return damagedKtx2(name, entry, fmt::format("level {} lies at {}, past the end at {}", k, offset, file.size()));
  decodeTexels(layout, file.subspan(offset, bytes), level.texels);
  return {};
}

Result<void> readMetadata(CubeFile& out, const Ktx2Header& h, std::span<const std::byte> file, std::string_view name) {
  if (h.kvdBytes == 0) return {};
  if (h.kvdOffset > file.size() || h.kvdBytes > file.size() - h.kvdOffset) return damagedKtx2(name, 56, fmt::format("its metadata at {} reaches past the end at {}", h.kvdOffset, file.size()));
  const auto metadata = decodeKeyValues(file.subspan(h.kvdOffset, h.kvdBytes), h.kvdOffset, name);
  if (!metadata) return fail(metadata.error());
  if (const std::string_view turned = valueOf(*metadata, "KTXorientation"); !turned.empty() && turned != "rd")
    return unsupportedKtx2(name, h.kvdOffset, fmt::format("KTXorientation '{}'", turned.substr(0, 8)), "export it as 'rd', which cubes must have");
  out.writer = valueOf(*metadata, "KTXwriter");
  out.scale = scaleOf(*metadata);
  return applyMetadata(out.cube, *metadata, name);
}

}  // namespace

bool isKtx2(std::span<const std::byte> file) { return file.size() >= kKtx2Identifier.size() && std::memcmp(file.data(), kKtx2Identifier.data(), kKtx2Identifier.size()) == 0; }

Result<CubeFile> decodeKtx2(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits) {
  Bytes in(file);
  const auto header = readKtx2Header(in, name);
  if (!header) return fail(header.error());
  if (auto ok = checkShape(*header, name); !ok) return fail(ok.error());
  const auto layout = layoutOf(*header, name);
  if (!layout) return fail(layout.error());
  const int size = static_cast<int>(header->width);
  if (header->levels > static_cast<std::uint32_t>(fullChain(size))) return damagedKtx2(name, 40, fmt::format("{} levels of faces of {}", header->levels, size));
  const int levels = std::max(static_cast<int>(header->levels), 1);
  if (in.left() < kKtx2LevelBytes * static_cast<std::size_t>(levels)) return damagedKtx2(name, file.size(), "its level index is cut off");
  if (auto ok = checkCubeLimits(size, levels, limits, name); !ok) return fail(ok.error());
  std::uint64_t texels = 0;
  for (int k = 0; k < levels; ++k) texels += cubeTexels(levelSize(size, k));
  if (texels * bytesPerTexel(layout->format) > file.size())
    return damagedKtx2(name, file.size(), fmt::format("it ends there, and {} levels of faces of {} take {} bytes", levels, size, texels * bytesPerTexel(layout->format)));

  CubeFile out;
  out.format = fmt::format("KTX2 cube, {}", layout->name);
  out.linear8 = !layout->srgb && layout->format <= TexelFormat::Bgr8;
  for (int k = 0; k < levels; ++k) {
    out.cube.levels.push_back(makeLevel(size, k));
    if (auto ok = readLevel(out.cube.levels.back(), k, file, *layout, name); !ok) return fail(ok.error());
  }
  if (auto ok = readMetadata(out, *header, file, name); !ok) return fail(ok.error());
  return out;
}

std::vector<std::byte> encodeKtx2(const Cubemap& cubemap, PixelType type, double scale) {
  const auto size = static_cast<std::uint32_t>(cubemap.levels[0].size);
  const std::size_t levels = cubemap.levels.size(), texel = type == PixelType::F16 ? 8 : 16;  // both are multiples of 4: the alignment of levels
  const std::vector<std::byte> dfd = ktx2Descriptor(4, type == PixelType::F16 ? 16 : 32), kvd = encodeKeyValues(metadataOf(cubemap, "KTXwriter", scale));
  const std::size_t dfdAt = kKtx2HeaderBytes + kKtx2LevelBytes * levels, kvdAt = dfdAt + dfd.size();

  Ktx2Header header;
  header.vkFormat = type == PixelType::F16 ? 97 : 109, header.typeSize = type == PixelType::F16 ? 2 : 4;
  header.width = header.height = size, header.faces = 6, header.levels = static_cast<std::uint32_t>(levels);
  header.dfdOffset = static_cast<std::uint32_t>(dfdAt), header.dfdBytes = static_cast<std::uint32_t>(dfd.size());
  header.kvdOffset = static_cast<std::uint32_t>(kvdAt), header.kvdBytes = static_cast<std::uint32_t>(kvd.size());
  ByteWriter out;
  writeKtx2Header(out, header);
  const std::size_t first = (kvdAt + kvd.size() + texel - 1) / texel * texel;
  for (std::size_t k = 0; k < levels; ++k) {
    std::size_t at = first;
    for (std::size_t smaller = k + 1; smaller < levels; ++smaller) at += cubemap.levels[smaller].texels.size() / 3 * texel;
    const std::uint64_t bytes = cubemap.levels[k].texels.size() / 3 * texel;
    out.u64(at), out.u64(bytes), out.u64(bytes);
  }
  out.bytes(dfd);
  out.bytes(kvd);
  out.align(texel);
  for (std::size_t k = levels; k-- > 0;) out.bytes(encodeLevel(cubemap.levels[k], type, scale));
  return out.take();
}

}  // namespace burnish::image
