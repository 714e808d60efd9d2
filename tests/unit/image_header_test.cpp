// Sizes from the first bytes of a picture file, before any decoder is asked.
#include <catch2/catch.hpp>
#include <cstring>
#include <string>

#include "image/encode.h"
#include "image/picture_header.h"

using namespace burnish;
using namespace burnish::image;

namespace {

std::span<const std::byte> view(std::string_view text) { return std::as_bytes(std::span(text.data(), text.size())); }
std::string be32(std::uint32_t v) { return {char(v >> 24), char(v >> 16), char(v >> 8), char(v)}; }
std::string png(std::uint32_t w, std::uint32_t h, char bits, char color, std::size_t rest = 100) {
  return std::string("\x89PNG\r\n\x1a\n") + be32(13) + "IHDR" + be32(w) + be32(h) + bits + color +
         std::string(3, '\0') + std::string(rest, 'x');
}
std::string jpeg(std::string_view segments) { return "\xff\xd8" + std::string(segments); }
std::string frame(char type, char bits, char components) {
  return std::string("\xff", 1) + type + std::string("\0\x11", 2) + bits + std::string("\x01\x02\x03\x04", 4) +
         components + std::string(12, '\0');
}

}  // namespace

TEST_CASE("PNG headers", "[image]") {
  auto header = readPictureHeader(view(png(640, 480, 8, 6, 2000)), "p");
  REQUIRE(header);
  CHECK(header->width == 640);
  CHECK(header->height == 480);
  CHECK(header->channels == 4);
  CHECK(header->type == PixelType::U8);
  CHECK(header->decodedBytes() == 640 * 480 * 4);
  CHECK(readPictureHeader(view(png(4, 4, 16, 0)), "p")->type == PixelType::U16);
  CHECK(readPictureHeader(view(png(4, 4, 4, 3)), "p")->channels == 4);
  for (const std::string& bad :
       {png(0, 4, 8, 2), png(4, 0, 8, 2), png(0x80000000u, 4, 8, 2), png(4, 4, 3, 0), png(4, 4, 16, 3), png(4, 4, 4, 2),
        png(4, 4, 8, 5), png(4, 4, 8, 7), png(4, 4, 8, 2).substr(0, 20), png(60000, 60000, 8, 2)})
    CHECK_FALSE(readPictureHeader(view(bad), "p"));
}

TEST_CASE("JPEG headers: segments are walked, not searched", "[image]") {
  const std::string app = std::string("\xff\xe1\x00\x08", 4) +
                          std::string("\xff\xc0\x00\x01\x02\x03", 6);  // a thumbnail's frame inside EXIF
  auto header = readPictureHeader(view(jpeg(app + "\xff\xff" + frame('\xc2', 8, 3).substr(1))), "p");
  REQUIRE(header);
  CHECK(header->height == 0x0102);
  CHECK(header->width == 0x0304);
  CHECK(header->channels == 3);
  CHECK(readPictureHeader(view(jpeg(frame('\xc0', 8, 4))), "p")->channels == 3);
  CHECK(readPictureHeader(view(jpeg(frame('\xc1', 8, 1))), "p")->channels == 1);
  for (const std::string& bad : {jpeg(frame('\xc3', 8, 3)), jpeg(frame('\xc0', 12, 3)), jpeg(frame('\xc0', 8, 2)),
                                 jpeg(frame('\xc0', 8, 3)).substr(0, 9), jpeg("\xff\xd9"), jpeg("\xff\xda"),
                                 jpeg(std::string("\xff\xe1\x00\x01", 4)), jpeg(std::string(500, '\xff')), jpeg(app)})
    CHECK_FALSE(readPictureHeader(view(bad), "p"));
}

TEST_CASE("Radiance headers", "[image]") {
  auto header =
      readPictureHeader(view("#?RADIANCE\n# comment\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 12 +X 34\n"), "p");
  REQUIRE(header);
  CHECK(header->width == 34);
  CHECK(header->height == 12);
  CHECK(header->type == PixelType::F32);
  for (const char* bad : {"#?RADIANCE\n", "#?RADIANCE\n\n", "#?RADIANCE\n\n-Y 12 +X\n", "#?RADIANCE\n\n-Y 0 +X 3\n",
                          "#?RADIANCE\n\n-Y -4 +X 3\n", "#?RADIANCE\n\n+X 3 -Y 4\n", "#?RADIANCE\n\n-Y 3 +Y 4\n",
                          "#?RADIANCE\n\n-Y 3 +X 99999999999\n", "#?RADIANCE\n\n-Y 3\n", "#?RADIANCE\nA\nB\n"})
    CHECK_FALSE(readPictureHeader(view(bad), "p"));
}

TEST_CASE("OpenEXR headers", "[image]") {
  auto file = encodeExr(makeImage(5, 6, 3, PixelType::F16), "p");
  REQUIRE(file);
  auto header = readPictureHeader(*file, "p");
  REQUIRE(header);
  CHECK(header->width == 5);
  CHECK(header->dataHeight == 6);
  CHECK(header->channels == 3);
  CHECK(header->type == PixelType::F32);
  std::string text(reinterpret_cast<const char*>(file->data()), file->size());
  const std::size_t window = text.find("dataWindow") + std::strlen("dataWindow") + 1 + std::strlen("box2i") + 1 + 4;
  for (std::uint32_t corner : {0xffffffffu, 0x7fffffffu, 0x80000000u}) {  // maxX of the data window
    std::string bad = text;
    std::memcpy(bad.data() + window + 8, &corner, 4);
    CHECK_FALSE(readPictureHeader(view(bad), "p"));
  }
  for (std::size_t length = 0; length < window; ++length)
    CHECK_FALSE(readPictureHeader(view(text.substr(0, length)), "p"));
  std::string deep = text, version = text;
  deep[5] = char(deep[5] | 8);
  version[4] = 1;
  CHECK_FALSE(readPictureHeader(view(deep), "p"));
  CHECK_FALSE(readPictureHeader(view(version), "p"));
}

TEST_CASE("Limits count sides, bytes and the data window", "[image]") {
  PictureHeader header{PictureFormat::Exr, 100, 100, 100, 100, 4, PixelType::F32};
  CHECK(checkPictureLimits(header, {100, 160000, 1}, "p"));
  CHECK_FALSE(checkPictureLimits(header, {99, 160000, 1}, "p"));
  CHECK_FALSE(checkPictureLimits(header, {100, 159999, 1}, "p"));
  header.dataHeight = 101;
  CHECK_FALSE(checkPictureLimits(header, {100, 1u << 30, 1}, "p"));
  CHECK_FALSE(checkPictureLimits(header, {200, 160000, 1}, "p"));
}
