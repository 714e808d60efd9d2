// DDS and KTX2 cubes, and every way of writing: what was written is read back, and headers of other programs are understood.
#include "cube_fixture.h"
#include "image/cube_file.h"

using namespace cube_test;

namespace {

std::vector<std::byte> operator+(std::vector<std::byte> a, const std::vector<std::byte>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
std::vector<std::byte> words(std::initializer_list<std::uint32_t> values) {
  std::vector<std::byte> out;
  for (const std::uint32_t v : values)
    for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::byte>(v >> shift & 0xff));
  return out;
}
std::vector<std::byte> repeated(const std::vector<std::byte>& one, std::size_t times) {
  std::vector<std::byte> out;
  for (std::size_t i = 0; i < times; ++i) out = out + one;
  return out;
}
std::uint32_t cc(const char* text) { return std::uint32_t(text[0]) | std::uint32_t(text[1]) << 8 | std::uint32_t(text[2]) << 16 | std::uint32_t(text[3]) << 24; }

/// A legacy header as Microsoft's documents lay it out: 32 words.
std::vector<std::byte> ddsHeader(std::uint32_t size, std::uint32_t levels, std::uint32_t pixelFlags, std::uint32_t code, std::uint32_t bits, std::uint32_t r, std::uint32_t g, std::uint32_t b) {
  return words({cc("DDS "), 124, 0x1007, size, size, 0, 0, levels, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 32, pixelFlags, code, bits, r, g, b, 0, 0x1008, 0xfe00, 0, 0, 0});
}
std::vector<std::byte> dx10Header(std::uint32_t size, std::uint32_t format) { return ddsHeader(size, 1, 4, cc("DX10"), 0, 0, 0, 0) + words({format, 3, 4, 1, 0}); }

std::vector<std::byte> ktx2File(std::uint32_t format, std::uint32_t typeSize, std::uint32_t size, const std::vector<std::byte>& texels) {
  const std::vector<std::byte> identifier = words({0x58544bab, 0xbb303220, 0x0a1a0a0d});
  return identifier + words({format, typeSize, size, size, 0, 0, 6, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 104, 0, static_cast<std::uint32_t>(texels.size()), 0, static_cast<std::uint32_t>(texels.size()), 0}) + texels;
}

/// The six faces of 1² texels, all of one colour, that a file says.
void checkColour(const Result<image::CubeFile>& read, Vec colour, double within = 1e-6) {
  INFO((read ? std::string() : read.error().message()));
  REQUIRE(read);
  REQUIRE(read->cube.levels.size() == 1);
  REQUIRE(read->cube.levels[0].texels.size() == 18);
  for (std::size_t i = 0; i < 18; ++i) CHECK(double(read->cube.levels[0].texels[i]) == Approx(colour[i % 3]).margin(within));
}

constexpr double kSrgb188 = 0.50288646, kSrgb64 = 0.05126946, kSrgb255 = 1;
const std::vector<std::byte> kHalves = words({0x38003c00, 0x3c004000});              // 1, 0.5, 2, alpha 1
const std::vector<std::byte> kFloats = words({0x3f800000, 0x3f000000, 0x40000000, 0x3f800000});
// 11-, 11- and 10-bit floats: 5 bits of exponent (bias 15), 6, 6 and 5 of mantissa. 1 = 15<<6, 0.5 = 14<<6, 2 = 16<<5.
const std::vector<std::byte> kPacked = words({15u << 6 | (14u << 6) << 11 | (16u << 5) << 22});
// Shared exponent: m 2^(e - 24). With e = 17: 1 = 128, 0.5 = 64, 2 = 256.
const std::vector<std::byte> kShared = words({128u | 64u << 9 | 256u << 18 | 17u << 27});

fs::path nameFor(const Folder& folder, int container) { return folder.path / std::array{"c.dds", "c.ktx2", "c.exr", "c"}[std::size_t(container)]; }

}  // namespace

TEST_CASE("What is written is read back, in every container", "[cubemap]") {
  const Folder folder;
  const int container = GENERATE(0, 1, 2, 3);
  const bool half = GENERATE(true, false);
  const std::optional<ReflectionLobe> lobe = GENERATE(std::optional<ReflectionLobe>(), std::optional(ReflectionLobe::BlinnPhong), std::optional(ReflectionLobe::Ggx));
  const auto [size, levels] = GENERATE(std::pair(16, 1), std::pair(16, 3), std::pair(8, 4), std::pair(1, 1), std::pair(12, 2));
  INFO("container " << container << " half " << half << " size " << size << " levels " << levels);
  const fs::path file = nameFor(folder, container);
  const Cubemap cube = directionChain(size, levels, lobe, half);
  Report report;
  const auto written = writeCubemap(file, cube, half ? PixelType::F16 : PixelType::F32, report);
  INFO((written ? std::string() : written.error().message()));
  REQUIRE(written);
  const auto read = readCubemap(file, report, options());
  INFO((read ? std::string() : read.error().message()));
  REQUIRE(read);
  checkSame(*read, cube);
  CHECK(report.empty());
  CHECK(readEnvironment(file, report, options())->writer.find("Burnish ") == 0);
  CHECK(namesIn(folder.path).size() == 1);
}

TEST_CASE("The same cubemap gives the same bytes", "[cubemap]") {
  const Folder folder;
  Report report;
  const Cubemap cube = directionChain(8, 2, ReflectionLobe::Ggx, false);
  for (int container = 0; container < 4; ++container) {
    const fs::path file = nameFor(folder, container), one = container == 3 ? file / "level1_ny.exr" : file;
    REQUIRE(writeCubemap(file, cube, PixelType::F32, report));
    const auto first = bytesOf(one);
    REQUIRE(writeCubemap(file, cube, PixelType::F32, report));
    CHECK(bytesOf(one) == first);
    CHECK_FALSE(first.empty());
  }
}

TEST_CASE("DDS cubes of other programs are read in their formats", "[cubemap]") {
  const DecodeLimits limits;
  const auto read = [&](const std::vector<std::byte>& header, const std::vector<std::byte>& texel) { return image::decodeDds(header + repeated(texel, 6), "a.dds", limits); };
  const std::vector<std::byte> rgba = words({0xff40bcff}), bgr = {std::byte(64), std::byte(188), std::byte(255)};  // 255, 188, 64
  checkColour(read(ddsHeader(1, 1, 4, 113, 0, 0, 0, 0), kHalves), {1, 0.5, 2});
  checkColour(read(ddsHeader(1, 0, 4, 116, 0, 0, 0, 0), kFloats), {1, 0.5, 2});
  checkColour(read(ddsHeader(1, 1, 0x41, 0, 32, 0xff, 0xff00, 0xff0000), rgba), {kSrgb255, kSrgb188, kSrgb64});
  checkColour(read(ddsHeader(1, 1, 0x41, 0, 32, 0xff0000, 0xff00, 0xff), rgba), {kSrgb64, kSrgb188, kSrgb255});
  checkColour(read(ddsHeader(1, 1, 0x40, 0, 24, 0xff0000, 0xff00, 0xff), bgr), {kSrgb255, kSrgb188, kSrgb64});
  checkColour(read(dx10Header(1, 10), kHalves), {1, 0.5, 2});
  checkColour(read(dx10Header(1, 2), kFloats), {1, 0.5, 2});
  checkColour(read(dx10Header(1, 6), words({0x3f800000, 0x3f000000, 0x40000000})), {1, 0.5, 2});
  checkColour(read(dx10Header(1, 26), kPacked), {1, 0.5, 2});
  checkColour(read(dx10Header(1, 67), kShared), {1, 0.5, 2});
  checkColour(read(dx10Header(1, 29), rgba), {kSrgb255, kSrgb188, kSrgb64});
  checkColour(read(dx10Header(1, 91), rgba), {kSrgb64, kSrgb188, kSrgb255});
  checkColour(read(dx10Header(1, 28), rgba), {1, 188.0 / 255, 64.0 / 255});
  CHECK(read(dx10Header(1, 28), rgba)->linear8);
  CHECK_FALSE(read(dx10Header(1, 29), rgba)->linear8);
  for (const std::uint32_t format : {0u, 95u, 99u, 999u}) CHECK(read(dx10Header(1, format), rgba).error().what.find("DXGI format") != std::string::npos);
}

TEST_CASE("A DDS cube stores each face with all its levels", "[cubemap]") {
  std::vector<std::byte> file = ddsHeader(2, 2, 4, 116, 0, 0, 0, 0);
  const auto texel = [](float v) { return words({std::bit_cast<std::uint32_t>(v), 0, 0, 0}); };
  for (int face = 0; face < 6; ++face) file = file + repeated(texel(static_cast<float>(face)), 4) + texel(static_cast<float>(10 + face));
  const auto read = image::decodeDds(file, "a.dds", {});
  REQUIRE(read);
  REQUIRE(read->cube.levels.size() == 2);
  for (std::size_t face = 0; face < 6; ++face) {
    CHECK(read->cube.levels[0].texels[face * 12 + 9] == static_cast<float>(face));
    CHECK(read->cube.levels[1].texels[face * 3] == static_cast<float>(10 + face));
  }
}

TEST_CASE("KTX2 cubes of other programs are read in their formats", "[cubemap]") {
  const auto read = [&](std::uint32_t format, std::uint32_t typeSize, const std::vector<std::byte>& texel) { return image::decodeKtx2(ktx2File(format, typeSize, 1, repeated(texel, 6)), "a.ktx2", {}); };
  const std::vector<std::byte> rgba = words({0xff40bcff});
  checkColour(read(97, 2, kHalves), {1, 0.5, 2});
  checkColour(read(90, 2, {kHalves.begin(), kHalves.begin() + 6}), {1, 0.5, 2});
  checkColour(read(109, 4, kFloats), {1, 0.5, 2});
  checkColour(read(106, 4, {kFloats.begin(), kFloats.begin() + 12}), {1, 0.5, 2});
  checkColour(read(122, 4, kPacked), {1, 0.5, 2});
  checkColour(read(123, 4, kShared), {1, 0.5, 2});
  checkColour(read(43, 1, rgba), {kSrgb255, kSrgb188, kSrgb64});
  checkColour(read(50, 1, rgba), {kSrgb64, kSrgb188, kSrgb255});
  checkColour(read(37, 1, rgba), {1, 188.0 / 255, 64.0 / 255});
  for (const std::uint32_t format : {0u, 1u, 145u, 1000066000u}) {
    const auto refused = read(format, 1, rgba);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().place == "a.ktx2: byte 12");
  }
}

TEST_CASE("Packed floats keep their small and their odd values", "[cubemap]") {
  // Denormals of 11 and 10 bits, the largest finite values, NaN and infinity.
  const auto read = [](std::uint32_t packed) { return image::decodeKtx2(ktx2File(122, 4, 1, repeated(words({packed}), 6)), "a", {})->cube.levels[0].texels; };
  CHECK(read(1)[0] == std::ldexp(1.0f, -20));
  CHECK(read(1u << 22)[2] == std::ldexp(1.0f, -19));
  CHECK(read(30u << 6 | 63)[0] == 65024);
  CHECK(read((30u << 5 | 31) << 22)[2] == 64512);
  CHECK(std::isinf(read(31u << 6)[0]));
  CHECK(std::isnan(read(31u << 6 | 1)[0]));
  const auto shared = image::decodeKtx2(ktx2File(123, 4, 1, repeated(words({511u | 31u << 27}), 6)), "a", {});
  CHECK(shared->cube.levels[0].texels[0] == 65408);
}

TEST_CASE("Files that are no plain cube are refused, and the place is named", "[cubemap]") {
  const std::vector<std::byte> good = dx10Header(1, 10) + repeated(kHalves, 6);
  const auto changed = [&](std::size_t at, std::uint32_t value) {
    std::vector<std::byte> file = good;
    std::memcpy(file.data() + at, words({value}).data(), 4);
    const auto read = image::decodeDds(file, "a.dds", {});
    REQUIRE_FALSE(read);
    CHECK(read.error().place.find("a.dds: byte ") == 0);
    return read.error().message();
  };
  REQUIRE(image::decodeDds(good, "a.dds", {}));
  CHECK(changed(4, 123).find("124") != std::string::npos);
  CHECK(changed(76, 31).find("32") != std::string::npos);
  CHECK(changed(12, 2).find("not square") != std::string::npos);
  CHECK(changed(28, 2).find("2 levels") != std::string::npos);
  CHECK(changed(132, 4).find("dimension") != std::string::npos);
  CHECK(changed(136, 0).find("no cube") != std::string::npos);
  CHECK(changed(140, 2).find("array of 2") != std::string::npos);
  CHECK(changed(112, 0x600).find("all six faces") != std::string::npos);

  const std::vector<std::byte> ktx = ktx2File(97, 2, 1, repeated(kHalves, 6));
  const auto changedKtx = [&](std::size_t at, std::uint32_t value) {
    std::vector<std::byte> file = ktx;
    std::memcpy(file.data() + at, words({value}).data(), 4);
    const auto read = image::decodeKtx2(file, "a.ktx2", {});
    REQUIRE_FALSE(read);
    CHECK(read.error().place.find("a.ktx2: byte ") == 0);
    return read.error().message();
  };
  CHECK(changedKtx(36, 1).find("no cube") != std::string::npos);
  CHECK(changedKtx(32, 3).find("array of 3") != std::string::npos);
  CHECK(changedKtx(28, 1).find("volume") != std::string::npos);
  CHECK(changedKtx(24, 2).find("not square") != std::string::npos);
  CHECK(changedKtx(40, 9).find("9 levels") != std::string::npos);
  CHECK(changedKtx(44, 1).find("BasisLZ") != std::string::npos);
  CHECK(changedKtx(44, 7).find("scheme 7") != std::string::npos);
  CHECK(changedKtx(80, 1000).find("past the end") != std::string::npos);
  CHECK(changedKtx(84, 0xffffffff).find("past the end") != std::string::npos);
  CHECK(changedKtx(88, 47).find("47 bytes") != std::string::npos);
  CHECK(changedKtx(60, 8).find("past the end") == std::string::npos);  // no offset: bytes of the header, no key
}

TEST_CASE("A reader cannot mix up the mapping of roughness to levels", "[cubemap]") {
  Cubemap cube = directionChain(4, 3, std::nullopt, false);
  const auto apply = [&](const image::Metadata& metadata) { return image::applyMetadata(cube, metadata, "c"); };
  CHECK(apply({{"KTXwriter", "another"}}));
  CHECK_FALSE(cube.lobe);
  REQUIRE(apply({{"BurnishLobe", "ggx"}, {"BurnishRoughness", "0 0.25 1"}, {"BurnishVersion", "1"}}));
  CHECK(cube.lobe == ReflectionLobe::Ggx);
  CHECK(cube.levels[1].roughness == 0.25);
  for (const image::Metadata& bad : {image::Metadata{{"BurnishLobe", "ggx"}, {"BurnishRoughness", "0 0.25 1"}, {"BurnishVersion", "2"}},
                                     {{"BurnishLobe", "ggx"}, {"BurnishRoughness", "0 0.25 1"}},
                                     {{"BurnishLobe", "phong"}, {"BurnishRoughness", "0 0.25 1"}, {"BurnishVersion", "1"}},
                                     {{"BurnishLobe", "ggx"}, {"BurnishRoughness", "0 0.25"}, {"BurnishVersion", "1"}},
                                     {{"BurnishLobe", "ggx"}, {"BurnishRoughness", "0 0.25 1 1"}, {"BurnishVersion", "1"}},
                                     {{"BurnishLobe", "ggx"}, {"BurnishRoughness", "0 0.5 0.25"}, {"BurnishVersion", "1"}},
                                     {{"BurnishLobe", "ggx"}, {"BurnishRoughness", "0 0.5 1.5"}, {"BurnishVersion", "1"}},
                                     {{"BurnishLobe", "ggx"}, {"BurnishRoughness", "0 nan 1"}, {"BurnishVersion", "1"}},
                                     {{"BurnishLobe", "ggx"}, {"BurnishRoughness", "0 0.5 1 "}, {"BurnishVersion", "1"}},
                                     {{"BurnishLobe", "none"}, {"BurnishRoughness", "0 0.5 1"}, {"BurnishVersion", "1"}}}) {
    const auto refused = apply(bad);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().place == "c: metadata");
  }
}

TEST_CASE("Faces of two sets in one folder are found out", "[cubemap]") {
  const Folder folder;
  Report report;
  REQUIRE(writeCubemap(folder.path / "a", directionChain(8, 2, ReflectionLobe::Ggx, false), PixelType::F32, report));
  REQUIRE(writeCubemap(folder.path / "b", directionChain(8, 2, ReflectionLobe::BlinnPhong, false), PixelType::F32, report));
  for (const char* name : {"level0_py.exr", "level1_px.exr"}) {
    fs::rename(folder.path / "a" / name, folder.path / "kept");
    fs::copy_file(folder.path / "b" / name, folder.path / "a" / name);
    const auto read = readCubemap(folder.path / "a", report, options());
    REQUIRE_FALSE(read);
    CHECK(read.error().what.find("set") != std::string::npos);
    fs::rename(folder.path / "kept", folder.path / "a" / name);
  }
  fs::remove(folder.path / "a/level1_nx.exr");  // then it has one level, and its roughnesses are two
  CHECK(readCubemap(folder.path / "a", report, options()).error().what.find("2 values for 1 levels") != std::string::npos);
}
