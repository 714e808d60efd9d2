// PNG and OpenEXR writers: what is refused, and files that are complete or absent. (tests/tools/decode_*.cpp read them
// back.)
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <png.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <string>

#include "image/encode.h"

namespace fs = std::filesystem;
using namespace burnish;

namespace {

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "burnish-image-XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
    path = name;
  }
  ~Folder() { fs::remove_all(path); }
  fs::path path;
};

Image gradient(int width, int height, int channels) {
  Image image = makeImage(width, height, channels, PixelType::U8);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.u8()[i] = static_cast<std::uint8_t>(i * 7 + i / 13);
  return image;
}

}  // namespace

TEST_CASE("makeImage allocates zeros and never too little", "[image]") {
  const Image image = makeImage(3, 5, 2, PixelType::F32);
  CHECK(image.data.size() == 3 * 5 * 2 * 4);
  CHECK(image.byteSize() == image.data.size());
  for (std::byte b : image.data) CHECK(b == std::byte(0));
  CHECK(makeImage(0, 7, 4, PixelType::U8).empty());
  CHECK(makeImage(-3, 7, 4, PixelType::U8).empty());
}

TEST_CASE("A written PNG holds the same bytes and says sRGB", "[image]") {
  const Folder folder;
  for (int channels = 1; channels <= 4; ++channels) {
    const Image image = gradient(33, 17, channels);
    const fs::path file = folder.path / "p.png";
    REQUIRE(writePng(file, image));
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&png, file.c_str()));
    CHECK(png.width == 33);
    CHECK(png.height == 17);
    constexpr png_uint_32 kFormats[] = {PNG_FORMAT_GRAY, PNG_FORMAT_GA, PNG_FORMAT_RGB, PNG_FORMAT_RGBA};
    CHECK(png.format == kFormats[channels - 1]);
    std::vector<std::byte> bytes(image.data.size());
    REQUIRE(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr));
    CHECK(bytes == image.data);
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    CHECK(text.find("sRGB") != std::string::npos);
  }
  CHECK(image::encodePng(gradient(9, 9, 3), "a").value() == image::encodePng(gradient(9, 9, 3), "b").value());
}

TEST_CASE("A written EXR holds the same values under the usual names", "[image]") {
  const Folder folder;
  const fs::path file = folder.path / "p.exr";
  const char* names[4][4] = {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
  for (int channels = 1; channels <= 4; ++channels) {
    Image image = makeImage(31, 40, channels, PixelType::F32);
    for (std::size_t i = 0; i < image.pixelCount() * std::size_t(channels); ++i)
      image.f32()[i] = static_cast<float>(i) * 1.1f - 100;
    REQUIRE(writeExr(file, image));
    Imf::InputFile in(file.c_str(), 0);
    CHECK(in.header().dataWindow() == Imath::Box2i({0, 0}, {30, 39}));
    std::vector<float> values(image.pixelCount() * std::size_t(channels));
    Imf::FrameBuffer frame;
    for (int c = 0; c < channels; ++c)
      frame.insert(names[channels - 1][c],
                   Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data() + c), 4 * std::size_t(channels),
                              4 * 31 * std::size_t(channels), 1, 1, -12345.0));
    in.setFrameBuffer(frame);
    in.readPixels(0, 39);
    CHECK(std::memcmp(values.data(), image.data.data(), image.data.size()) == 0);
  }
  const Image halves = makeImage(9, 9, 3, PixelType::F16);
  CHECK(image::encodeExr(halves, "a").value() == image::encodeExr(halves, "b").value());
}

TEST_CASE("Pictures that cannot be written are one clear error, and leave no file", "[image]") {
  const Folder folder;
  const fs::path file = folder.path / "p";
  const Image floats = makeImage(4, 4, 3, PixelType::F32), bytes = gradient(4, 4, 3);
  Image inconsistent = bytes, inconsistentFloats = floats;
  inconsistent.data.pop_back();
  inconsistentFloats.data.pop_back();
  for (const Result<void>& result :
       {writePng(file, floats), writePng(file, Image{}), writePng(file, inconsistent),
        writePng(file, makeImage(0, 4, 3, PixelType::U8)), writeExr(file, bytes), writeExr(file, Image{}),
        writeExr(file, inconsistentFloats), writePng(folder.path / "no/p.png", bytes),
        writeExr(folder.path / "no/p.exr", floats), writePng(folder.path, bytes)}) {
    REQUIRE_FALSE(result);
    CHECK(result.error().place.find(folder.path.string()) != std::string::npos);
    CHECK_FALSE(result.error().what.empty());
    CHECK_FALSE(result.error().remedy.empty());
  }
  CHECK(fs::is_empty(folder.path));
}
