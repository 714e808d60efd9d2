#include "oiio_decode.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

namespace burnish::decode {
namespace {

using image::PictureFormat;
using image::PictureHeader;

tl::unexpected<Error> damaged(std::string_view name, std::string_view what) {
  std::string text = "cannot be decoded: " + std::string(what.substr(0, 160));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  while (text.ends_with(' ') || text.ends_with(':')) text.pop_back();
  return fail(std::string(name), std::move(text), "export the picture again");
}

constexpr const char* kPlugins[] = {"png", "jpeg", "hdr", "openexr"};  ///< in the order of PictureFormat

OIIO::TypeDesc oiioType(PixelType type) {
  return type == PixelType::U8    ? OIIO::TypeDesc::UINT8
         : type == PixelType::U16 ? OIIO::TypeDesc::UINT16
                                  : OIIO::TypeDesc::FLOAT;
}

/// Whether what OpenImageIO found agrees with what the header said to the caller.
bool agrees(const OIIO::ImageSpec& spec, const PictureHeader& header) {
  return spec.width == header.dataWidth && spec.height == header.dataHeight && spec.depth == 1 && spec.nchannels > 0 &&
         !spec.deep &&
         (header.format != PictureFormat::Exr ||
          (spec.full_width == header.width && spec.full_height == header.height));
}

/// The first four at most. An EXR's further layers ("albedo.R") are no part of its picture where that has channels of its own: OpenImageIO puts those first.
int channelsOf(const OIIO::ImageSpec& spec, const PictureHeader& header) {
  const int most = std::min(spec.nchannels, 4);
  if (header.format != PictureFormat::Exr) return most;
  int own = 0;
  while (own < most && spec.channelnames[std::size_t(own)].find('.') == std::string::npos) ++own;
  return own > 0 ? own : most;
}

struct Rows {
  std::byte* data;
  std::size_t rowBytes, pixelBytes;
  int width, height;
};

void flipVertically(const Rows& rows) {
  for (int top = 0, bottom = rows.height - 1; top < bottom; ++top, --bottom)
    std::swap_ranges(rows.data + std::size_t(top) * rows.rowBytes, rows.data + std::size_t(top + 1) * rows.rowBytes,
                     rows.data + std::size_t(bottom) * rows.rowBytes);
}

void flipHorizontally(const Rows& rows) {
  for (int y = 0; y < rows.height; ++y) {
    std::byte* row = rows.data + std::size_t(y) * rows.rowBytes;
    for (int left = 0, right = rows.width - 1; left < right; ++left, --right)
      std::swap_ranges(row + std::size_t(left) * rows.pixelBytes, row + std::size_t(left + 1) * rows.pixelBytes,
                       row + std::size_t(right) * rows.pixelBytes);
  }
}

/// A Radiance file says in which order its rows and pixels come; OpenImageIO hands that on as an EXIF orientation (1 to
/// 4).
void orientHdr(const OIIO::ImageSpec& spec, const Rows& rows) {
  const int orientation = spec.get_int_attribute("Orientation", 1);
  if (orientation == 3 || orientation == 4) flipVertically(rows);
  if (orientation == 2 || orientation == 3) flipHorizontally(rows);
}

/// OpenEXR whose data window is not the display window: the part of the data that lies inside, the rest stays zero.
void placeWindow(const OIIO::ImageSpec& spec, const std::vector<std::byte>& data, const Rows& rows) {
  const int x0 = std::max(spec.x, spec.full_x), x1 = std::min(spec.x + spec.width, spec.full_x + spec.full_width);
  const int y0 = std::max(spec.y, spec.full_y), y1 = std::min(spec.y + spec.height, spec.full_y + spec.full_height);
  for (int y = y0; x0 < x1 && y < y1; ++y)
    std::memcpy(
        rows.data + std::size_t(y - spec.full_y) * rows.rowBytes + std::size_t(x0 - spec.full_x) * rows.pixelBytes,
        data.data() + (std::size_t(y - spec.y) * std::size_t(spec.width) + std::size_t(x0 - spec.x)) * rows.pixelBytes,
        std::size_t(x1 - x0) * rows.pixelBytes);
}

struct Source {
  OIIO::ImageInput& input;
  const OIIO::ImageSpec& spec;
  Decoded layout;
  [[nodiscard]] OIIO::TypeDesc type() const { return oiioType(layout.type); }
  [[nodiscard]] std::size_t pixelBytes() const {
    return std::size_t(layout.channels) * std::size_t(bytesPerChannel(layout.type));
  }
  [[nodiscard]] std::size_t rowBytes() const { return pixelBytes() * std::size_t(layout.width); }
  [[nodiscard]] bool windowed() const {
    return spec.x != spec.full_x || spec.y != spec.full_y || spec.width != layout.width || spec.height != layout.height;
  }
};

/// Hands over what is in memory already.
bool copyTo(PixelSink& sink, std::span<const std::byte> pixels) {
  while (!pixels.empty()) {
    const std::span<std::byte> room = sink.room();
    const std::size_t n = std::min(room.size(), pixels.size());
    std::copy_n(pixels.begin(), n, room.begin());
    if (!sink.commit(n)) return false;
    pixels = pixels.subspan(n);
  }
  return true;
}

/// Tiles, windows and turned pictures: decoded whole, then handed over.
bool decodeWhole(const Source& source, PixelSink& sink, bool turned) {
  const OIIO::ImageSpec& spec = source.spec;
  std::vector<std::byte> pixels(std::size_t(spec.width) * std::size_t(spec.height) * source.pixelBytes());
  if (!source.input.read_image(0, 0, 0, source.layout.channels, source.type(), pixels.data())) return false;
  if (source.windowed()) {
    std::vector<std::byte> display(source.rowBytes() * std::size_t(source.layout.height));
    placeWindow(spec, pixels,
                {display.data(), source.rowBytes(), source.pixelBytes(), source.layout.width, source.layout.height});
    pixels = std::move(display);
  }
  if (turned)
    orientHdr(spec, {pixels.data(), source.rowBytes(), source.pixelBytes(), source.layout.width, source.layout.height});
  return copyTo(sink, pixels);
}

/// Rows straight into the sink, as many as its room holds.
bool decodeByRows(const Source& source, PixelSink& sink) {
  const int y0 = source.spec.y, height = source.layout.height;
  constexpr int kBlock =
      32;  // OpenEXR's largest block of rows in common compressions: whole ones are not decoded twice
  for (int y = 0; y < height;) {
    const std::span<std::byte> room = sink.room();
    const std::size_t fitting = room.size() / source.rowBytes();
    int rows = static_cast<int>(std::min<std::size_t>(fitting, std::size_t(height - y)));
    if (rows > kBlock && y + rows < height) rows -= rows % kBlock;
    if (rows > 0) {
      if (!source.input.read_scanlines(0, 0, y0 + y, y0 + y + rows, 0, 0, source.layout.channels, source.type(),
                                       room.data()) ||
          !sink.commit(std::size_t(rows) * source.rowBytes()))
        return false;
    } else {  // one row is longer than the room
      std::vector<std::byte> row(source.rowBytes());
      rows = 1;
      if (!source.input.read_scanlines(0, 0, y0 + y, y0 + y + 1, 0, 0, source.layout.channels, source.type(),
                                       row.data()) ||
          !copyTo(sink, row))
        return false;
    }
    y += rows;
  }
  return true;
}

Result<Decoded> decodeThrowing(std::span<const std::byte> file, std::string_view name, const PictureHeader& header,
                               const DecodeLimits& limits, PixelSink& sink) {
  OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(file.data()), file.size());
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  // ImageInput::open would look for a file of the name and try other plugins when the right one fails.
  const auto input = OIIO::ImageInput::create(kPlugins[static_cast<std::size_t>(header.format)]);
  if (!input) return damaged(name, OIIO::geterror());
  OIIO::ImageSpec spec;
  if (!input->set_ioproxy(&memory) || !input->open("picture", spec, config)) return damaged(name, input->geterror());
  if (!agrees(spec, header)) return damaged(name, "its parts contradict its header");

  const Source source{*input, spec, {header.width, header.height, channelsOf(spec, header), header.type}};
  PictureHeader actual = header;
  actual.channels = source.layout.channels;
  if (auto ok = image::checkPictureLimits(actual, limits, name); !ok) return fail(ok.error());
  if (!sink.begin(source.layout, actual.decodedBytes()))
    return fail(std::string(name), "there is no memory for its pixels", "make the picture smaller");

  const bool turned = header.format == PictureFormat::Hdr && spec.get_int_attribute("Orientation", 1) != 1;
  const bool windowed = header.format == PictureFormat::Exr && source.windowed();
  const bool read =
      turned || windowed || spec.tile_width != 0 ? decodeWhole(source, sink, turned) : decodeByRows(source, sink);
  if (!read) return damaged(name, input->geterror());
  return source.layout;
}

}  // namespace

void prepareOpenImageIo() {
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);
  for (const char* plugin : kPlugins) (void)OIIO::ImageInput::create(plugin);
  (void)OIIO::geterror();
}

Result<Decoded> decodePicture(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits,
                              PixelSink& sink) {
  auto header = image::readPictureHeader(file, name);
  if (!header) return fail(header.error());
  if (auto ok = image::checkPictureLimits(*header, limits, name); !ok) return fail(ok.error());
  try {
    return decodeThrowing(file, name, *header, limits, sink);
  } catch (const std::bad_alloc&) {
    return fail(std::string(name), "takes more memory to decode than allowed",
                "make the picture smaller, or export it again if it is damaged");
  } catch (const std::exception& e) {
    return damaged(name, e.what());
  } catch (...) {
    return damaged(name, "unknown failure");
  }
}

}  // namespace burnish::decode
