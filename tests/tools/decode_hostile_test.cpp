// Damaged and hostile pictures: each is a picture or one clear error, soon, and the pool goes on.
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include "decode_jpegs.h"
#include "decode_pictures.h"
#include "image/picture_header.h"

using namespace burnish;
using namespace decode_test;

namespace {

struct Seed {
  const char* name;
  Bytes bytes;
};

std::vector<Seed> seeds() {
  const auto noise = [](int x, int y, int c) {
    return unsigned((x * 73856093) ^ (y * 19349663) ^ (c * 83492791)) & 255;
  };
  const auto wave = [](int x, int y, int c) { return float(x * y % 11) - float(c); };
  std::vector<Seed> list = {
      {"rgb.png", makePng(24, 20, {2, 8}, noise)},
      {"palette.png", makePng(24, 20, {3, 4, true, true}, [&](int x, int y, int) { return noise(x, y, 0) & 15; })},
      {"wide.png", makePng(24, 20, {6, 16}, noise)},
      {"rgb.jpg", bytesOfArray(kJpegRgb)},
      {"progressive.jpg", bytesOfArray(kJpegProgressive)},
      {"cmyk.jpg", bytesOfArray(kJpegCmyk)},
      {"flat.hdr", makeHdr("-Y 20 +X 24", 480, [](int i) { return std::uint32_t(i) * 0x01234567u; })}};
  for (int compression : {0, 1, 3, 4, 5, 6, 8}) {  // none, RLE, ZIP, PIZ, PXR24, B44, DWAA
    ExrOptions options;
    options.dataWidth = options.displayWidth = 24, options.dataHeight = options.displayHeight = 20;
    options.compression = compression, options.half = compression != 5, options.tiled = compression == 1;
    list.push_back({"some.exr", makeExr(options, wave)});
  }
  // A run-length coded Radiance picture: one run of 24 a channel.
  Bytes rle = bytesOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 20 +X 24\n");
  for (int y = 0; y < 20; ++y)
    for (int b : {2, 2, 0, 24, 128 + 24, y, 128 + 24, 2 * y, 128 + 24, 0, 128 + 24, 129})
      rle.push_back(static_cast<std::byte>(b));
  list.push_back({"rle.hdr", rle});
  return list;
}

/// Decodes and checks that the answer is a sane picture or a clear error, and soon.
bool checkAnswer(ImageDecoder& pool, const Bytes& file, const char* name) {
  DecodeLimits limits;
  limits.maxSide = 4096, limits.maxBytes = 64 << 20, limits.seconds = 3;
  const auto begin = std::chrono::steady_clock::now();
  auto image = pool.decode(file, name, limits);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  bool sane = seconds < 20;
  if (image)
    sane = sane && image->width > 0 && image->width <= 4096 && image->height > 0 && image->height <= 4096 &&
           image->channels >= 1 && image->channels <= 4 && image->data.size() == image->byteSize();
  else
    sane = sane && image.error().place == name && !image.error().what.empty() && !image.error().remedy.empty() &&
           image.error().what.size() < 400;
  if (!sane) UNSCOPED_INFO(name << " after " << seconds << " s: " << (image ? "picture" : image.error().message()));
  return sane;
}

void mutate(Bytes& file, std::mt19937& random) {
  const int changes = 1 + int(random() % 8);
  for (int i = 0; i < changes; ++i) {
    const std::size_t at = random() % file.size();
    switch (random() % 5) {
      case 0:
        file[at] = static_cast<std::byte>(random());
        break;
      case 1:
        file[at] ^= static_cast<std::byte>(1u << random() % 8);
        break;
      case 2:
        file[at] = std::byte(random() % 2 ? 0xff : 0);
        break;
      case 3: {  // an extreme 32-bit value
        const std::uint32_t values[] = {0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x00010000};
        if (at + 4 <= file.size()) std::memcpy(file.data() + at, &values[random() % 6], 4);
        break;
      }
      default:
        file.resize(std::max<std::size_t>(file.size() - random() % 16, 16));
    }
  }
}

std::uint32_t crc32(std::span<const std::byte> bytes) {
  std::uint32_t crc = ~0u;
  for (std::byte b : bytes) {
    crc ^= std::to_integer<std::uint32_t>(b);
    for (int k = 0; k < 8; ++k) crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
  }
  return ~crc;
}

/// Chunks with right checksums, so that a mutation reaches the code behind them.
void mendPngChecksums(Bytes& file) {
  std::size_t at = 8;
  const auto word = [&](std::size_t i) {
    std::uint32_t v = 0;
    for (std::size_t k = 0; k < 4; ++k) v = v << 8 | std::to_integer<std::uint32_t>(file[i + k]);
    return v;
  };
  while (at + 12 <= file.size() && word(at) <= file.size() - at - 12) {
    const std::size_t length = word(at);
    const std::uint32_t crc = crc32(std::span(file).subspan(at + 4, length + 4));
    for (std::size_t k = 0; k < 4; ++k) file[at + 8 + length + k] = static_cast<std::byte>(crc >> (24 - 8 * k));
    at += length + 12;
  }
}

Bytes pngOfSize(std::uint32_t width, std::uint32_t height) {
  Bytes file = makePng(1, 1, {6, 8}, [](int, int, int) { return 0u; });
  for (std::size_t k = 0; k < 4; ++k) {
    file[16 + k] = static_cast<std::byte>(width >> (24 - 8 * k));
    file[20 + k] = static_cast<std::byte>(height >> (24 - 8 * k));
  }
  mendPngChecksums(file);
  return file;
}

}  // namespace

TEST_CASE("Decompression bombs are refused by their header", "[decode][hostile]") {
  auto pool = makeDecoderPool({"/no/helper/is/started", 1});
  DecodeLimits unlimited;
  unlimited.maxSide = 0x7fffffff, unlimited.maxBytes = ~0ull;
  for (const auto& [width, height] : {std::pair<std::uint32_t, std::uint32_t>{65535, 65535},
                                      {1000000000, 1},
                                      {1, 1000000000},
                                      {0x7fffffff, 0x7fffffff},
                                      {0xffffffff, 1},
                                      {0, 5},
                                      {5, 0}}) {
    INFO(width << " x " << height);
    auto image = pool->decode(pngOfSize(width, height), "bomb.png");
    REQUIRE_FALSE(image);
    CHECK(image.error().message().find("helper") == std::string::npos);
    CHECK(image.error().message().find(std::to_string(width)) != std::string::npos);
    auto again = pool->decode(pngOfSize(width, height), "bomb.png", unlimited);  // what so short a file cannot hold
    REQUIRE_FALSE(again);
    CHECK(again.error().message().find("helper") == std::string::npos);
  }
  ExrOptions options;
  options.displayWidth = options.displayHeight = 100000;
  const auto zero = [](int, int, int) { return 0.0f; };
  auto image = pool->decode(makeExr(options, zero), "bomb.exr");
  REQUIRE_FALSE(image);
  CHECK(image.error().what.find("limit") != std::string::npos);
  CHECK_FALSE(pool->decode(makeHdr("-Y 99999 +X 99999", 1, [](int) { return 0u; }), "bomb.hdr"));
  CHECK_FALSE(pool->decode(makeHdr("-Y 99999999999999999999 +X 1", 1, [](int) { return 0u; }), "bomb.hdr"));
  Bytes jpeg = bytesOfArray(kJpegGrey);
  for (std::size_t i = 0; i + 9 < jpeg.size(); ++i)
    if (jpeg[i] == std::byte(0xff) && jpeg[i + 1] == std::byte(0xc0)) jpeg[i + 5] = jpeg[i + 7] = std::byte(0xff);
  auto wide = pool->decode(jpeg, "bomb.jpg");
  REQUIRE_FALSE(wide);
  CHECK(wide.error().what.find("limit") != std::string::npos);
}

TEST_CASE("A size limit in bytes holds", "[decode][hostile]") {
  DecodeLimits limits;
  limits.maxBytes = 64 * 64 * 3;
  const auto grey = [](int, int, int) { return 9u; };
  CHECK(sharedPool().decode(makePng(64, 64, {4, 8}, grey), "fits.png", limits));
  CHECK_FALSE(sharedPool().decode(makePng(64, 65, {6, 8}, grey), "does not.png", limits));
}

TEST_CASE("Pictures cut off anywhere are a picture or an error", "[decode][hostile]") {
  const std::size_t step = std::getenv("BURNISH_LONG") ? 1 : 23;
  for (const Seed& seed : seeds())
    for (std::size_t length = 0; length < seed.bytes.size(); length += length < 64 ? 3 : step) {
      INFO(seed.name << " cut at " << length);
      REQUIRE(checkAnswer(sharedPool(),
                          Bytes(seed.bytes.begin(), seed.bytes.begin() + static_cast<std::ptrdiff_t>(length)),
                          seed.name));
    }
}

TEST_CASE("Mutated pictures are a picture or an error", "[decode][hostile]") {
  const int rounds = std::getenv("BURNISH_LONG") ? 2000 : 40;
  const auto originals = seeds();
  std::mt19937 random(20240607);
  int pictures = 0, errors = 0;
  for (int round = 0; round < rounds; ++round)
    for (const Seed& seed : originals) {
      Bytes file = seed.bytes;
      mutate(file, random);
      if (std::string_view(seed.name).ends_with(".png") && random() % 4 != 0) mendPngChecksums(file);
      INFO(seed.name << ", round " << round);
      REQUIRE(checkAnswer(sharedPool(), file, seed.name));
      auto header = image::readPictureHeader(file, seed.name);
      header ? ++pictures : ++errors;
    }
  CHECK(pictures > rounds);  // the mutations get past the header
  CHECK(errors > 0);
  for (const Seed& seed : originals) CHECK(sharedPool().decode(seed.bytes, seed.name));
}

TEST_CASE("Bytes of no sense behind each magic are an error", "[decode][hostile]") {
  std::mt19937 random(7);
  for (std::string_view magic : {"\x89PNG\r\n\x1a\n", "\xff\xd8\xff", "#?RADIANCE\n", "\x76\x2f\x31\x01"})
    for (int i = 0; i < 40; ++i) {
      Bytes file = bytesOf(magic);
      for (int k = 0; k < 10 * i; ++k) file.push_back(static_cast<std::byte>(random()));
      REQUIRE(checkAnswer(sharedPool(), file, "noise"));
    }
}
