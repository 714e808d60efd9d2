// Headers of PNG (ISO/IEC 15948, 11.2.2), JPEG (ITU-T T.81, B.2.2), Radiance HDR (Ward, "Real Pixels", Graphics Gems
// II; the Radiance reference, filefmts.pdf) and OpenEXR ("OpenEXR File Layout"). Every read goes through Bytes, which
// checks bounds.
#include "image/picture_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string>

#include "image/bytes.h"

namespace burnish::image {
namespace {

tl::unexpected<Error> damaged(std::string_view name, PictureFormat format, std::string_view what) {
  return fail(std::string(name), fmt::format("is a damaged {} file: {}", formatName(format), what),
              "export the picture again");
}
tl::unexpected<Error> unsupported(std::string_view name, PictureFormat format, std::string_view what) {
  return fail(std::string(name),
              fmt::format("is a {} file of a kind that is not supported: {}", formatName(format), what),
              "convert the picture");
}

bool plausibleSide(std::uint64_t side) { return side > 0 && side <= 0x7fffffff; }

Result<PictureHeader> readPng(std::span<const std::byte> file, std::string_view name) {
  Bytes in(file);
  in.skip(8);
  const std::uint32_t length = in.be32(), type = in.be32(), width = in.be32(), height = in.be32(), bits = in.u8(),
                      color = in.u8();
  const std::uint32_t compression = in.u8(), filter = in.u8(), interlace = in.u8();
  if (in.bad() || length != 13 || type != 0x49484452)
    return damaged(name, PictureFormat::Png, "it does not start with IHDR");
  if (!plausibleSide(width) || !plausibleSide(height))
    return damaged(name, PictureFormat::Png, fmt::format("its size is {} x {}", width, height));
  const bool bitsFit = color == 0   ? bits == 1 || bits == 2 || bits == 4 || bits == 8 || bits == 16
                       : color == 3 ? bits == 1 || bits == 2 || bits == 4 || bits == 8
                                    : (color == 2 || color == 4 || color == 6) && (bits == 8 || bits == 16);
  if (!bitsFit || compression != 0 || filter != 0 || interlace > 1)
    return damaged(
        name, PictureFormat::Png,
        fmt::format("colour type {} with {} bits, methods {} {} {}", color, bits, compression, filter, interlace));
  const int stored = color == 2 ? 3 : color == 4 ? 2 : color == 6 ? 4 : 1;
  // Deflate never does better than 1032 to 1 (RFC 1951: 258 bytes from 2 bits), so a short file cannot be a large
  // picture.
  const double rowBytes = static_cast<double>(width) * stored * bits / 8;
  if (rowBytes * height / 1032 > static_cast<double>(file.size()) + 1024)
    return damaged(name, PictureFormat::Png,
                   fmt::format("{} bytes cannot hold {} x {} pixels", file.size(), width, height));
  const int channels = color == 3 ? 4 : color == 0 || color == 2 ? stored + 1 : stored;  // + 1: a tRNS chunk may follow
  const int w = static_cast<int>(width), h = static_cast<int>(height);
  return PictureHeader{PictureFormat::Png, w, h, w, h, channels, bits == 16 ? PixelType::U16 : PixelType::U8};
}

Result<PictureHeader> readJpeg(std::span<const std::byte> file, std::string_view name) {
  Bytes in(file);
  in.skip(2);
  while (!in.bad()) {
    while (!in.bad() && in.u8() != 0xff) {
    }  // garbage between segments is tolerated, as libjpeg does
    std::uint32_t marker = 0xff;
    while (!in.bad() && marker == 0xff) marker = in.u8();  // fill bytes
    if (marker == 0 || marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8)) continue;
    if (marker == 0xd9 || marker == 0xda) break;  // end or scan before a frame
    const std::uint32_t length = in.be16();
    if (length < 2) return damaged(name, PictureFormat::Jpeg, "a segment of no length");
    const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (!frame) {
      in.skip(length - 2);
      continue;
    }
    const std::uint32_t bits = in.u8(), height = in.be16(), width = in.be16(), components = in.u8();
    if (in.bad()) break;
    if ((marker > 0xc2 && marker != 0xc9 && marker != 0xca) || bits != 8)
      return unsupported(name, PictureFormat::Jpeg, fmt::format("frame type {:#04x} with {} bits", marker, bits));
    if (width == 0 || height == 0 || (components != 1 && components != 3 && components != 4))
      return damaged(name, PictureFormat::Jpeg,
                     fmt::format("its size is {} x {} with {} components", width, height, components));
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    return PictureHeader{PictureFormat::Jpeg, w, h, w, h, components == 1 ? 1 : 3, PixelType::U8};  // CMYK becomes RGB
  }
  return damaged(name, PictureFormat::Jpeg, "it ends before its size");
}

/// One of "-Y", "+Y", "-X", "+X" and the number after it.
bool axis(std::string_view& line, char& letter, std::uint64_t& size) {
  if (line.size() < 4 || (line[0] != '-' && line[0] != '+') || line[2] != ' ') return false;
  letter = line[1];
  line.remove_prefix(3);
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), size);
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  return error == std::errc{} && plausibleSide(size);
}

Result<PictureHeader> readHdr(std::span<const std::byte> file, std::string_view name) {
  Bytes in(file);
  std::string_view line = in.textUntil('\n', 256);
  while (!in.bad() && !line.empty() && in.position() < 65536) line = in.textUntil('\n', 4096);
  std::string_view size = in.textUntil('\n', 256);
  char first = 0, second = 0;
  std::uint64_t rows = 0, columns = 0;
  if (in.bad() || !axis(size, first, rows) || size.empty() || size[0] != ' ')
    return damaged(name, PictureFormat::Hdr, "it has no line with its size");
  size.remove_prefix(1);
  if (!axis(size, second, columns)) return damaged(name, PictureFormat::Hdr, "it has no line with its size");
  if (first == 'X' && second == 'Y') return unsupported(name, PictureFormat::Hdr, "stored by columns");
  if (first != 'Y' || second != 'X') return damaged(name, PictureFormat::Hdr, "its line with the size names no axes");
  const int w = static_cast<int>(columns), h = static_cast<int>(rows);
  return PictureHeader{PictureFormat::Hdr, w, h, w, h, 3, PixelType::F32};
}

struct Window {
  std::int32_t minX = 0, minY = 0, maxX = -1, maxY = -1;
  [[nodiscard]] std::int64_t width() const { return std::int64_t(maxX) - minX + 1; }
  [[nodiscard]] std::int64_t height() const { return std::int64_t(maxY) - minY + 1; }
  [[nodiscard]] bool plausible() const {
    // OpenEXR itself holds coordinates to half of the 32-bit range (ImfHeader, sanityCheck).
    constexpr std::int32_t kMost = 0x7fffffff / 2;
    return width() > 0 && height() > 0 && minX > -kMost && minY > -kMost && maxX < kMost && maxY < kMost;
  }
};
Window window(Bytes& in) {
  Window w;
  w.minX = in.le32(), w.minY = in.le32(), w.maxX = in.le32(), w.maxY = in.le32();
  return w;
}

/// Channel names of a chlist attribute, counted.
int countChannels(Bytes& in, std::size_t end) {
  int channels = 0;
  while (!in.bad() && in.position() < end && !in.textUntil('\0', 255).empty()) {
    in.skip(16);
    ++channels;
  }
  return channels;
}

Result<PictureHeader> readExr(std::span<const std::byte> file, std::string_view name) {
  Bytes in(file);
  in.skip(4);
  const auto version = static_cast<std::uint32_t>(in.le32());
  if ((version & 0xff) != 2) return unsupported(name, PictureFormat::Exr, fmt::format("version {}", version & 0xff));
  if (version & 0x800) return unsupported(name, PictureFormat::Exr, "deep data");
  Window data, display;
  int channels = 0;
  for (;;) {  // the first part's attributes; those of further parts are not used
    const std::string_view attribute = in.textUntil('\0', 255);
    if (in.bad() || attribute.empty()) break;
    in.textUntil('\0', 255);
    const std::int32_t size = in.le32();
    if (size < 0) return damaged(name, PictureFormat::Exr, "an attribute of negative length");
    const std::size_t end = in.position() + static_cast<std::size_t>(size);
    if (attribute == "dataWindow" && size == 16)
      data = window(in);
    else if (attribute == "displayWindow" && size == 16)
      display = window(in);
    else if (attribute == "channels")
      channels = countChannels(in, end);
    if (end < in.position()) return damaged(name, PictureFormat::Exr, "an attribute longer than it says");
    in.skip(end - in.position());
  }
  if (in.bad()) return damaged(name, PictureFormat::Exr, "its header is cut off");
  if (!data.plausible() || !display.plausible())
    return damaged(name, PictureFormat::Exr, "its data or display window is missing or empty");
  if (channels < 1) return damaged(name, PictureFormat::Exr, "it has no channels");
  return PictureHeader{PictureFormat::Exr,
                       static_cast<int>(display.width()),
                       static_cast<int>(display.height()),
                       static_cast<int>(data.width()),
                       static_cast<int>(data.height()),
                       std::min(channels, 4),
                       PixelType::F32};
}

}  // namespace

std::uint64_t PictureHeader::decodedBytes() const {
  return std::uint64_t(width) * std::uint64_t(height) * std::uint64_t(channels) * std::uint64_t(bytesPerChannel(type));
}

std::optional<PictureFormat> pictureFormat(std::span<const std::byte> file) {
  const auto startsWith = [&](std::string_view magic) {
    return file.size() >= magic.size() && std::memcmp(file.data(), magic.data(), magic.size()) == 0;
  };
  if (startsWith("\x89PNG\r\n\x1a\n")) return PictureFormat::Png;
  if (startsWith("\xff\xd8\xff")) return PictureFormat::Jpeg;
  if (startsWith("#?RADIANCE") || startsWith("#?RGBE")) return PictureFormat::Hdr;
  if (startsWith("\x76\x2f\x31\x01")) return PictureFormat::Exr;
  return std::nullopt;
}

std::string_view formatName(PictureFormat format) {
  constexpr std::string_view kNames[] = {"PNG", "JPEG", "Radiance HDR", "OpenEXR"};
  return kNames[static_cast<std::size_t>(format)];
}

Result<PictureHeader> readPictureHeader(std::span<const std::byte> file, std::string_view name) {
  const auto format = pictureFormat(file);
  if (!format)
    return fail(std::string(name), file.empty() ? "is empty" : "is not a PNG, JPEG, Radiance HDR or OpenEXR file",
                "convert the picture to one of these formats");
  switch (*format) {
    case PictureFormat::Png:
      return readPng(file, name);
    case PictureFormat::Jpeg:
      return readJpeg(file, name);
    case PictureFormat::Hdr:
      return readHdr(file, name);
    case PictureFormat::Exr:
      break;
  }
  return readExr(file, name);
}

std::vector<std::pair<std::string, std::string>> exrTexts(std::span<const std::byte> file) {
  std::vector<std::pair<std::string, std::string>> texts;
  if (pictureFormat(file) != PictureFormat::Exr) return texts;
  Bytes in(file);
  in.skip(8);
  for (;;) {
    const std::string_view attribute = in.textUntil('\0', 255);
    if (in.bad() || attribute.empty()) return texts;
    const std::string_view type = in.textUntil('\0', 255);
    const std::int32_t size = in.le32();
    const auto bytes = in.take(size < 0 ? file.size() + 1 : static_cast<std::size_t>(size));
    if (in.bad()) return texts;
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    if (type == "string") texts.emplace_back(std::string(attribute), std::string(text, bytes.size()));
    if (type == "envmap" && bytes.size() == 1) texts.emplace_back(std::string(attribute), bytes[0] == std::byte(1) ? "cube" : "latlong");
  }
}

Result<void> checkPictureLimits(const PictureHeader& header, const DecodeLimits& limits, std::string_view name) {
  const int side = std::max({header.width, header.height, header.dataWidth, header.dataHeight});
  if (side > limits.maxSide)
    return fail(std::string(name),
                fmt::format("is {} x {} pixels, the limit is {} a side", std::max(header.width, header.dataWidth),
                            std::max(header.height, header.dataHeight), limits.maxSide),
                "make the picture smaller");
  PictureHeader stored = header;
  stored.width = header.dataWidth, stored.height = header.dataHeight;
  if (const std::uint64_t bytes = std::max(header.decodedBytes(), stored.decodedBytes()); bytes > limits.maxBytes)
    return fail(std::string(name), fmt::format("takes {} bytes decoded, the limit is {}", bytes, limits.maxBytes),
                "make the picture smaller");
  return {};
}

}  // namespace burnish::image
