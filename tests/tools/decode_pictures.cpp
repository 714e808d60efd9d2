#include "decode_pictures.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <half.h>
#include <png.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace decode_test {
namespace {

void appendTo(png_structp png, png_bytep data, png_size_t size) {
  auto* bytes = static_cast<Bytes*>(png_get_io_ptr(png));
  const auto* begin = reinterpret_cast<const std::byte*>(data);
  bytes->insert(bytes->end(), begin, begin + size);
}

void storeSample(std::vector<png_byte>& row, std::size_t index, int bits, unsigned value) {
  if (bits == 16) {
    row[index * 2] = static_cast<png_byte>(value >> 8);
    row[index * 2 + 1] = static_cast<png_byte>(value);
  } else if (bits == 8) {
    row[index] = static_cast<png_byte>(value);
  } else {
    const std::size_t bit = index * static_cast<std::size_t>(bits);
    row[bit / 8] = static_cast<png_byte>(row[bit / 8] | value << (8 - bits - static_cast<int>(bit % 8)));
  }
}

void setPaletteAndTransparency(png_structp png, png_infop info, const PngOptions& options) {
  std::vector<png_color> palette;
  std::vector<png_byte> alpha;
  for (int i = 0; i < 1 << std::min(options.bits, 8); ++i) {
    palette.push_back({static_cast<png_byte>(i), static_cast<png_byte>(2 * i), static_cast<png_byte>(255 - i)});
    alpha.push_back(static_cast<png_byte>(255 - i));
  }
  if (options.colorType == 3) png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  png_color_16 key{};
  if (options.transparency) {
    if (options.colorType == 3)
      png_set_tRNS(png, info, alpha.data(), static_cast<int>(alpha.size()), nullptr);
    else
      png_set_tRNS(png, info, nullptr, 0, &key);
  }
}

}  // namespace

Bytes makePng(int width, int height, const PngOptions& options, const std::function<unsigned(int, int, int)>& value) {
  Bytes bytes;
  const auto failed = [](png_structp, png_const_charp text) { throw std::runtime_error(text); };
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, failed, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, appendTo, nullptr);
  png_set_compression_level(png, options.level);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), options.bits,
               options.colorType, options.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  setPaletteAndTransparency(png, info, options);
  const int channels = options.colorType == 2 ? 3 : options.colorType == 4 ? 2 : options.colorType == 6 ? 4 : 1;
  std::vector<std::vector<png_byte>> rows(static_cast<std::size_t>(height));
  std::vector<png_bytep> pointers;
  for (int y = 0; y < height; ++y) {
    auto& row = rows[static_cast<std::size_t>(y)];
    row.assign(static_cast<std::size_t>((width * channels * options.bits + 7) / 8), 0);
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c)
        storeSample(row, static_cast<std::size_t>(x * channels + c), options.bits, value(x, y, c));
    pointers.push_back(row.data());
  }
  png_write_info(png, info);
  png_write_image(png, pointers.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

Bytes makeHdr(std::string_view resolution, int pixels, const std::function<std::uint32_t(int)>& rgbe) {
  Bytes bytes = bytesOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + std::string(resolution) + "\n");
  for (int i = 0; i < pixels; ++i)
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::byte>(rgbe(i) >> shift));
  return bytes;
}

Bytes makeExr(const ExrOptions& o, const std::function<float(int, int, int)>& value) {
  const auto box = [](int x, int y, int w, int h) {
    return Imath::Box2i(Imath::V2i(x, y), Imath::V2i(x + w - 1, y + h - 1));
  };
  Imf::Header header(box(o.displayX, o.displayY, o.displayWidth, o.displayHeight),
                     box(o.dataX, o.dataY, o.dataWidth, o.dataHeight));
  header.compression() = static_cast<Imf::Compression>(o.compression);
  if (o.tiled) header.setTileDescription(Imf::TileDescription(16, 16, Imf::ONE_LEVEL));
  const auto pixels = static_cast<std::size_t>(o.dataWidth) * static_cast<std::size_t>(o.dataHeight);
  std::vector<std::vector<char>> planes;
  Imf::FrameBuffer frame;
  const std::size_t size = o.half ? 2 : 4;
  for (int c = 0; c < static_cast<int>(o.channels.size()); ++c) {
    auto& plane = planes.emplace_back(pixels * size);
    for (int y = 0; y < o.dataHeight; ++y)
      for (int x = 0; x < o.dataWidth; ++x) {
        const float v = value(o.dataX + x, o.dataY + y, c);
        const half h(v);
        char* to =
            plane.data() +
            (static_cast<std::size_t>(y) * static_cast<std::size_t>(o.dataWidth) + static_cast<std::size_t>(x)) * size;
        std::memcpy(to, o.half ? static_cast<const void*>(&h) : &v, size);
      }
    const Imf::PixelType type = o.half ? Imf::HALF : Imf::FLOAT;
    header.channels().insert(o.channels[static_cast<std::size_t>(c)], Imf::Channel(type));
    frame.insert(o.channels[static_cast<std::size_t>(c)],
                 Imf::Slice::Make(type, plane.data(), Imath::V2i(o.dataX, o.dataY), o.dataWidth, o.dataHeight, size,
                                  size * static_cast<std::size_t>(o.dataWidth)));
  }
  const auto file =
      std::filesystem::temp_directory_path() / ("burnish-decode-test-" + std::to_string(::getpid()) + ".exr");
  if (o.tiled) {
    Imf::TiledOutputFile out(file.c_str(), header, 0);
    out.setFrameBuffer(frame);
    out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
  } else {
    Imf::OutputFile out(file.c_str(), header, 0);
    out.setFrameBuffer(frame);
    out.writePixels(o.dataHeight);
  }
  std::ifstream in(file, std::ios::binary);
  const Bytes bytes = bytesOf(std::string{std::istreambuf_iterator<char>(in), {}});
  std::filesystem::remove(file);
  return bytes;
}

Bytes bytesOf(std::string_view text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

burnish::ImageDecoder& sharedPool() {
  static const auto kPool = burnish::makeDecoderPool({kHelper, 2, true});
  return *kPool;
}

}  // namespace decode_test
