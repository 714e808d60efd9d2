// DDS cubes, written from Microsoft's "Programming Guide for DDS" and the references of DDS_HEADER, DDS_PIXELFORMAT and DDS_HEADER_DXT10 (learn.microsoft.com). A cube is six faces in the order
// +X -X +Y -Y +Z -Z, each with all its levels. Numbers are little-endian.
#include <fmt/format.h>

#include "image/bytes.h"
#include "image/cube_file.h"
#include "image/cube_texels.h"

namespace burnish::image {
namespace {

constexpr std::uint32_t fourCc(const char (&text)[5]) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) value |= std::uint32_t(static_cast<unsigned char>(text[i])) << 8 * i;
  return value;
}

// DDS_HEADER.dwFlags, dwCaps, dwCaps2; DDS_PIXELFORMAT.dwFlags; DDS_HEADER_DXT10.miscFlag, resourceDimension.
constexpr std::uint32_t kFlagCaps = 0x1, kFlagHeight = 0x2, kFlagWidth = 0x4, kFlagPitch = 0x8, kFlagPixelFormat = 0x1000, kFlagMipMapCount = 0x20000;
constexpr std::uint32_t kCapsComplex = 0x8, kCapsMipMap = 0x400000, kCapsTexture = 0x1000;
constexpr std::uint32_t kCaps2Cubemap = 0x200, kCaps2AllFaces = 0xfc00, kCaps2Volume = 0x200000;
constexpr std::uint32_t kPixelFourCc = 0x4, kPixelRgb = 0x40;
constexpr std::uint32_t kMiscTextureCube = 0x4, kDimensionTexture2D = 3;
constexpr std::size_t kHeaderBytes = 4 + 124, kExtendedBytes = 20;
// Ours, in dwReserved1, which the format leaves unused: key and value pairs of so many bytes follow the texels.
constexpr std::uint32_t kMetadataMark = fourCc("BRNM");

struct Header {
  std::uint32_t width = 0, height = 0, levels = 0, caps2 = 0, metadataBytes = 0;
  bool hasMetadata = false;
  std::uint32_t pixelFlags = 0, code = 0, bits = 0, red = 0, green = 0, blue = 0;
  bool extended = false;
  std::uint32_t dxgiFormat = 0, dimension = 0, misc = 0, arraySize = 0;
};

tl::unexpected<Error> damaged(std::string_view name, std::size_t at, std::string what) {
  return fail(fmt::format("{}: byte {}", name, at), "is a damaged DDS file: " + std::move(what), "export the file again");
}
tl::unexpected<Error> unsupported(std::string_view name, std::size_t at, std::string what, const char* remedy) {
  return fail(fmt::format("{}: byte {}", name, at), "is a DDS file of a kind that is not read here: " + std::move(what), remedy);
}

Result<Header> readHeader(Bytes& in, std::string_view name) {
  Header h;
  in.skip(4);
  const std::uint32_t size = in.leU32();
  in.skip(4);
  h.height = in.leU32();
  h.width = in.leU32();
  in.skip(8);
  h.levels = in.leU32();
  h.hasMetadata = in.leU32() == kMetadataMark;
  h.metadataBytes = in.leU32();
  in.skip(4 * 9);
  const std::uint32_t pixelSize = in.leU32();
  h.pixelFlags = in.leU32();
  h.code = in.leU32();
  h.bits = in.leU32();
  h.red = in.leU32(), h.green = in.leU32(), h.blue = in.leU32();
  in.skip(8);
  h.caps2 = in.leU32();
  in.skip(12);
  h.extended = (h.pixelFlags & kPixelFourCc) && h.code == fourCc("DX10");
  if (h.extended) h.dxgiFormat = in.leU32(), h.dimension = in.leU32(), h.misc = in.leU32(), h.arraySize = in.leU32(), in.skip(4);
  if (in.bad()) return damaged(name, in.position(), "its header is cut off");
  if (size != 124) return damaged(name, 4, fmt::format("its header says that it is {} bytes long, not 124", size));
  if (pixelSize != 32) return damaged(name, 76, fmt::format("its pixel format says that it is {} bytes long, not 32", pixelSize));
  return h;
}

Result<void> checkShape(const Header& h, std::string_view name) {
  const char* remedy = "export a cube map with all six faces";
  if (h.extended && h.dimension != kDimensionTexture2D) return unsupported(name, 132, fmt::format("resource dimension {}", h.dimension), remedy);
  if (h.extended && !(h.misc & kMiscTextureCube)) return unsupported(name, 136, "no cube", remedy);
  if (h.extended && h.arraySize != 1) return unsupported(name, 140, fmt::format("an array of {} cubes", h.arraySize), "export one cube");
  if (h.caps2 & kCaps2Volume) return unsupported(name, 112, "a volume", remedy);
  if (!h.extended && !(h.caps2 & kCaps2Cubemap)) return unsupported(name, 112, "no cube", remedy);
  if ((h.caps2 & kCaps2Cubemap) && (h.caps2 & kCaps2AllFaces) != kCaps2AllFaces) return unsupported(name, 112, "a cube without all six faces", remedy);
  if (h.width != h.height || h.width == 0) return damaged(name, 12, fmt::format("its faces are {} x {}, not square", h.width, h.height));
  return {};
}

Result<TexelLayout> legacyLayout(const Header& h, std::string_view name) {
  if (h.pixelFlags & kPixelFourCc) {  // D3DFORMAT numbers
    if (h.code == 113) return TexelLayout{TexelFormat::Rgba16F, false, "A16B16G16R16F"};
    if (h.code == 116) return TexelLayout{TexelFormat::Rgba32F, false, "A32B32G32R32F"};
  } else if (h.pixelFlags & kPixelRgb) {  // such files cannot say sRGB; as of any 8-bit picture, it is taken for granted
    const bool rgb = h.red == 0xff && h.green == 0xff00 && h.blue == 0xff0000, bgr = h.red == 0xff0000 && h.green == 0xff00 && h.blue == 0xff;
    if (rgb && h.bits == 32) return TexelLayout{TexelFormat::Rgba8, true, "A8B8G8R8"};
    if (bgr && h.bits == 32) return TexelLayout{TexelFormat::Bgra8, true, "A8R8G8B8"};
    if (rgb && h.bits == 24) return TexelLayout{TexelFormat::Rgb8, true, "B8G8R8"};
    if (bgr && h.bits == 24) return TexelLayout{TexelFormat::Bgr8, true, "R8G8B8"};
  }
  return unsupported(name, 80, fmt::format("pixel format flags {:#x}, code {:#x}, {} bits", h.pixelFlags, h.code, h.bits), "export half or float RGBA, uncompressed");
}

Result<TexelLayout> dxgiLayout(const Header& h, std::string_view name) {
  switch (h.dxgiFormat) {
    case 2: return TexelLayout{TexelFormat::Rgba32F, false, "R32G32B32A32_FLOAT"};
    case 6: return TexelLayout{TexelFormat::Rgb32F, false, "R32G32B32_FLOAT"};
    case 10: return TexelLayout{TexelFormat::Rgba16F, false, "R16G16B16A16_FLOAT"};
    case 26: return TexelLayout{TexelFormat::Rg11B10F, false, "R11G11B10_FLOAT"};
    case 67: return TexelLayout{TexelFormat::Rgb9E5, false, "R9G9B9E5_SHAREDEXP"};
    case 28: return TexelLayout{TexelFormat::Rgba8, false, "R8G8B8A8_UNORM"};
    case 29: return TexelLayout{TexelFormat::Rgba8, true, "R8G8B8A8_UNORM_SRGB"};
    case 87: return TexelLayout{TexelFormat::Bgra8, false, "B8G8R8A8_UNORM"};
    case 88: return TexelLayout{TexelFormat::Bgra8, false, "B8G8R8X8_UNORM"};
    case 91: return TexelLayout{TexelFormat::Bgra8, true, "B8G8R8A8_UNORM_SRGB"};
    case 93: return TexelLayout{TexelFormat::Bgra8, true, "B8G8R8X8_UNORM_SRGB"};
    default: return unsupported(name, 128, fmt::format("DXGI format {}", h.dxgiFormat), "export R16G16B16A16_FLOAT or R32G32B32A32_FLOAT");
  }
}

}  // namespace

bool isDds(std::span<const std::byte> file) { return file.size() >= 4 && std::memcmp(file.data(), "DDS ", 4) == 0; }

Result<CubeFile> decodeDds(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits) {
  Bytes in(file);
  const auto header = readHeader(in, name);
  if (!header) return fail(header.error());
  if (auto ok = checkShape(*header, name); !ok) return fail(ok.error());
  const auto layout = header->extended ? dxgiLayout(*header, name) : legacyLayout(*header, name);
  if (!layout) return fail(layout.error());
  if (header->width > 0x7fffffff / 2) return damaged(name, 12, fmt::format("its faces are {} texels wide", header->width));
  const int size = static_cast<int>(header->width);
  if (header->levels > static_cast<std::uint32_t>(fullChain(size))) return damaged(name, 28, fmt::format("{} levels of faces of {}", header->levels, size));
  const int levels = std::max(static_cast<int>(header->levels), 1);
  if (auto ok = checkCubeLimits(size, levels, limits, name); !ok) return fail(ok.error());
  std::uint64_t texels = 0;
  for (int k = 0; k < levels; ++k) texels += cubeTexels(levelSize(size, k));
  if (const std::uint64_t bytes = texels * bytesPerTexel(layout->format); bytes > in.left())
    return damaged(name, file.size(), fmt::format("it ends there, and {} levels of faces of {} take {} bytes more", levels, size, bytes - in.left()));

  CubeFile out;
  for (int k = 0; k < levels; ++k) out.cube.levels.push_back(makeLevel(size, k));
  for (std::size_t face = 0; face < 6; ++face)
    for (CubeLevel& level : out.cube.levels) {
      const std::size_t n = level.texels.size() / 6;
      decodeTexels(*layout, in.take(n / 3 * bytesPerTexel(layout->format)), std::span(level.texels).subspan(face * n, n));
    }
  out.format = fmt::format("DDS cube, {}", layout->name);
  out.linear8 = header->extended && !layout->srgb && layout->format <= TexelFormat::Bgr8;
  if (header->hasMetadata) {
    const std::size_t at = in.position();
    const auto chunk = in.take(header->metadataBytes);
    if (in.bad()) return damaged(name, at, fmt::format("its {} bytes of metadata are cut off", header->metadataBytes));
    const auto metadata = decodeKeyValues(chunk, at, name);
    if (!metadata) return fail(metadata.error());
    if (auto ok = applyMetadata(out.cube, *metadata, name); !ok) return fail(ok.error());
    out.writer = valueOf(*metadata, "KTXwriter");
  }
  return out;
}

std::vector<std::byte> encodeDds(const Cubemap& cubemap, PixelType type) {
  const auto size = static_cast<std::uint32_t>(cubemap.levels[0].size);
  const auto levels = static_cast<std::uint32_t>(cubemap.levels.size());
  const std::uint32_t texel = type == PixelType::F16 ? 8 : 16;
  const std::vector<std::byte> metadata = encodeKeyValues(metadataOf(cubemap));
  ByteWriter out;
  out.text("DDS ");
  out.u32(124);
  out.u32(kFlagCaps | kFlagHeight | kFlagWidth | kFlagPitch | kFlagPixelFormat | (levels > 1 ? kFlagMipMapCount : 0));
  out.u32(size), out.u32(size), out.u32(size * texel), out.u32(0), out.u32(levels);
  out.u32(kMetadataMark), out.u32(static_cast<std::uint32_t>(metadata.size())), out.zeros(4 * 9);
  out.u32(32), out.u32(kPixelFourCc), out.text("DX10"), out.zeros(4 * 5);
  out.u32(kCapsTexture | kCapsComplex | (levels > 1 ? kCapsMipMap : 0)), out.u32(kCaps2Cubemap | kCaps2AllFaces), out.zeros(4 * 3);
  out.u32(type == PixelType::F16 ? 10 : 2), out.u32(kDimensionTexture2D), out.u32(kMiscTextureCube), out.u32(1), out.u32(0);
  static_assert(kHeaderBytes + kExtendedBytes == 148);
  std::vector<std::vector<std::byte>> encoded;
  for (const CubeLevel& level : cubemap.levels) encoded.push_back(encodeLevel(level, type));
  for (std::size_t face = 0; face < 6; ++face)
    for (const auto& level : encoded) out.bytes(std::span(level).subspan(face * level.size() / 6, level.size() / 6));
  out.bytes(metadata);
  return out.take();
}

}  // namespace burnish::image
