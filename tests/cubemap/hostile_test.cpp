// Damaged and malicious cubemap files: an error or a sound cubemap, never anything else.
#include <ctime>
#include <random>

#include "cube_fixture.h"
#include "image/cube_file.h"
#include "image/encode.h"
#include "image/picture_header.h"

using namespace cube_test;

namespace {

Result<image::CubeFile> decode(std::span<const std::byte> file, const DecodeLimits& limits = {}) {
  if (image::isDds(file)) return image::decodeDds(file, "hostile.file", limits);
  if (image::isKtx2(file)) return image::decodeKtx2(file, "hostile.file", limits);
  return fail("hostile.file", "is no cube", "no matter");
}

std::vector<std::byte> sample(bool dds) {
  const Cubemap cube = directionChain(4, 3, ReflectionLobe::Ggx, false);
  return dds ? image::encodeDds(cube, PixelType::F32) : image::encodeKtx2(cube, PixelType::F16);
}

/// An error with its three parts, or levels that halve and have all their texels.
bool sound(const Result<image::CubeFile>& read) {
  if (!read) return read.error().place.find("hostile.file") == 0 && !read.error().what.empty() && !read.error().remedy.empty();
  const auto& levels = read->cube.levels;
  for (std::size_t k = 0; k < levels.size(); ++k)
    if (levels[k].size != std::max(levels[0].size >> k, 1) || levels[k].texels.size() != std::size_t(levels[k].size) * std::size_t(levels[k].size) * 18) return false;
  return !levels.empty();
}

void setWord(std::vector<std::byte>& file, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) file[at + i] = static_cast<std::byte>(value >> 8 * i & 0xff);
}

}  // namespace

TEST_CASE("A file cut off anywhere is an error", "[cubemap][hostile]") {
  const bool dds = GENERATE(true, false);
  const auto file = sample(dds);
  REQUIRE(decode(file));
  for (std::size_t n = 0; n < file.size(); ++n) {
    INFO("cut at " << n);
    const std::vector<std::byte> cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(n));  // exactly n bytes, so that a sanitizer sees a read past them
    const auto read = decode(cut);
    REQUIRE_FALSE(read);
    REQUIRE(sound(read));
  }
}

TEST_CASE("Every byte changed, and many at random, give an error or a sound cubemap", "[cubemap][hostile]") {
  const bool dds = GENERATE(true, false);
  const auto file = sample(dds);
  for (std::size_t at = 0; at < std::min<std::size_t>(file.size(), 512); ++at)
    for (const int value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
      std::vector<std::byte> changed = file;
      changed[at] = static_cast<std::byte>(value);
      INFO("byte " << at << " is " << value);
      REQUIRE(sound(decode(changed)));
    }
  std::mt19937 random(20261129);
  for (int round = 0; round < 20000; ++round) {
    std::vector<std::byte> changed = file;
    const std::size_t range = round % 2 ? 256 : changed.size();  // half of them in the header
    for (unsigned flips = 1 + random() % 6; flips > 0; --flips) changed[random() % range] ^= static_cast<std::byte>(1u << random() % 8);
    if (round % 5 == 0) changed.resize(random() % changed.size());
    INFO("round " << round);
    REQUIRE(sound(decode(changed)));
  }
}

TEST_CASE("Giant sizes cost nothing", "[cubemap][hostile]") {
  const bool dds = GENERATE(true, false);
  const std::clock_t begin = std::clock();
  for (const std::uint32_t size : {8192u, 16384u, 65536u, 0x3fffffffu, 0x7fffffffu, 0x80000000u, 0xffffffffu})
    for (const std::uint32_t levels : {1u, 14u, 31u, 32u, 0x7fffffffu, 0xffffffffu}) {
      std::vector<std::byte> file = sample(dds);
      setWord(file, dds ? 12 : 20, size), setWord(file, dds ? 16 : 24, size), setWord(file, dds ? 28 : 40, levels);
      const auto read = decode(file);
      REQUIRE_FALSE(read);
      REQUIRE(sound(read));
    }
  CHECK(double(std::clock() - begin) / CLOCKS_PER_SEC < 0.5);
}

TEST_CASE("Lengths and offsets near the end of 32 and 64 bits do not wrap", "[cubemap][hostile]") {
  for (const std::uint32_t value : {0u, 1u, 3u, 0x7fffffffu, 0x80000000u, 0xfffffff0u, 0xffffffffu}) {
    for (std::size_t at = 48; at < 80 + 24 * 3; at += 4) {  // the index and the level index of KTX2
      std::vector<std::byte> file = sample(false);
      setWord(file, at, value);
      REQUIRE(sound(decode(file)));
      if (at + 8 <= file.size()) setWord(file, at + 4, 0xffffffff);
      REQUIRE(sound(decode(file)));
    }
    std::vector<std::byte> dds = sample(true);
    setWord(dds, 36, value);  // length of our metadata
    REQUIRE(sound(decode(dds)));
    for (std::size_t back = 4; back < 160; back += 4) {  // lengths of keys and values
      dds = sample(true);
      setWord(dds, dds.size() - back, value);
      REQUIRE(sound(decode(dds)));
    }
  }
}

TEST_CASE("Limits hold before anything is read", "[cubemap][hostile]") {
  const bool dds = GENERATE(true, false);
  const auto file = sample(dds);
  DecodeLimits limits;
  limits.maxSide = 3;
  CHECK(decode(file, limits).error().what.find("the limit is 3") != std::string::npos);
  limits.maxSide = 4;
  limits.maxBytes = 6 * (16 + 4 + 1) * 12 - 1;
  CHECK(decode(file, limits).error().what.find("bytes decoded") != std::string::npos);
  limits.maxBytes += 1;
  CHECK(decode(file, limits));
}

TEST_CASE("Texts of a damaged OpenEXR header are those of the file, or none", "[cubemap][hostile]") {
  const std::vector<std::pair<std::string, std::string>> attributes = {{"BurnishLobe", "ggx"}, {"BurnishRoughness", "0 0.5"}};
  const auto file = image::encodeExr(makeImage(4, 2, 3, PixelType::F16), "a", attributes).value();
  CHECK(image::valueOf(image::exrTexts(file), "BurnishRoughness") == "0 0.5");
  CHECK(image::exrTexts({}).empty());
  for (std::size_t n = 0; n < file.size(); ++n) {
    const std::vector<std::byte> cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(n));
    for (const auto& [key, value] : image::exrTexts(cut)) REQUIRE(key.size() + value.size() <= n);
  }
  std::mt19937 random(7);
  for (int round = 0; round < 20000; ++round) {
    std::vector<std::byte> changed = file;
    for (unsigned flips = 1 + random() % 4; flips > 0; --flips) changed[random() % 400] ^= static_cast<std::byte>(1u << random() % 8);
    for (const auto& [key, value] : image::exrTexts(changed)) REQUIRE(key.size() + value.size() <= changed.size());
  }
}
