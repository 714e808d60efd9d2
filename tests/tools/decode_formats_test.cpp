// Every format and kind that the decoder accepts, value by value; what is not accepted is one clear error.
#include <burnish/decode_inprocess.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/file.h"
#include "decode_jpegs.h"
#include "decode_pictures.h"
#include "image/encode.h"
#include "paths.h"

using namespace burnish;
using namespace decode_test;

namespace {

/// Decodes with the pool, and checks that the in-process decoder gives the very same.
Image decoded(const Bytes& file, std::string_view name = "picture") {
  auto image = sharedPool().decode(file, name);
  if (!image) FAIL(image.error().message());
  static const auto kInProcess = makeInProcessDecoder();
  auto same = kInProcess->decode(file, name);
  REQUIRE(same);
  CHECK(same->width == image->width);
  CHECK(same->height == image->height);
  CHECK(same->channels == image->channels);
  CHECK(same->type == image->type);
  CHECK(same->data == image->data);
  CHECK(image->data.size() == image->byteSize());
  return *image;
}

unsigned sample(const Image& image, int x, int y, int c) {
  const std::size_t at =
      (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * std::size_t(image.channels) + std::size_t(c);
  return image.type == PixelType::U8 ? image.u8()[at] : reinterpret_cast<const std::uint16_t*>(image.data.data())[at];
}
float floatAt(const Image& image, int x, int y, int c) {
  return image.f32()[(std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * std::size_t(image.channels) +
                     std::size_t(c)];
}

unsigned pattern(int x, int y, int c) { return static_cast<unsigned>(x * 37 + y * 91 + c * 53); }

}  // namespace

TEST_CASE("PNG of every colour type and depth decodes to its stored values", "[decode]") {
  struct Kind {
    int colorType, bits, stored;
  };
  for (const auto& [colorType, bits, stored] : {Kind{0, 1, 1},
                                                {0, 2, 1},
                                                {0, 4, 1},
                                                {0, 8, 1},
                                                {0, 16, 1},
                                                {2, 8, 3},
                                                {2, 16, 3},
                                                {3, 1, 1},
                                                {3, 2, 1},
                                                {3, 4, 1},
                                                {3, 8, 1},
                                                {4, 8, 2},
                                                {4, 16, 2},
                                                {6, 8, 4},
                                                {6, 16, 4}})
    for (bool interlaced : {false, true}) {
      INFO("type " << colorType << ", " << bits << " bits, interlaced " << interlaced);
      const unsigned mask = (1u << bits) - 1;
      const Image image = decoded(
          makePng(13, 9, {colorType, bits, interlaced}, [&](int x, int y, int c) { return pattern(x, y, c) & mask; }));
      CHECK(image.width == 13);
      CHECK(image.height == 9);
      CHECK(image.type == (bits == 16 ? PixelType::U16 : PixelType::U8));
      REQUIRE(image.channels == (colorType == 3 ? 3 : stored));
      bool equal = true;
      for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 13; ++x)
          for (int c = 0; c < image.channels; ++c) {
            const unsigned value = pattern(x, y, colorType == 3 ? 0 : c) & mask;
            const unsigned entry[] = {value, (2 * value) & 255, 255 - value};
            const unsigned want = colorType == 3 ? entry[c] : bits < 8 ? value * 255 / mask : value;
            equal = equal && sample(image, x, y, c) == want;
          }
      CHECK(equal);
    }
}

TEST_CASE("PNG transparency becomes alpha; colours are not multiplied by it", "[decode]") {
  const Image palette =
      decoded(makePng(4, 1, {3, 4, false, true}, [](int x, int, int) { return static_cast<unsigned>(x + 5); }));
  REQUIRE(palette.channels == 4);
  for (int x = 0; x < 4; ++x) {
    CHECK(sample(palette, x, 0, 1) == unsigned(2 * (x + 5)));
    CHECK(sample(palette, x, 0, 3) == unsigned(255 - (x + 5)));
  }
  const Image keyed = decoded(makePng(4, 1, {2, 8, false, true}, [](int x, int, int) { return x == 0 ? 0u : 77u; }));
  REQUIRE(keyed.channels == 4);
  CHECK(sample(keyed, 0, 0, 3) == 0);
  CHECK(sample(keyed, 1, 0, 3) == 255);
  CHECK(sample(keyed, 1, 0, 0) == 77);
  const Image grey = decoded(makePng(4, 1, {0, 8, false, true}, [](int x, int, int) { return x == 0 ? 0u : 77u; }));
  REQUIRE(grey.channels == 2);
  CHECK(sample(grey, 0, 0, 1) == 0);
  const Image straight =
      decoded(makePng(2, 1, {6, 8}, [](int x, int, int c) { return c == 3 ? (x == 0 ? 0u : 10u) : 200u; }));
  CHECK(sample(straight, 0, 0, 0) == 200);
  CHECK(sample(straight, 1, 0, 2) == 200);
}

TEST_CASE("JPEG: baseline, progressive, grey, CMYK; EXIF orientation is ignored", "[decode]") {
  for (const Bytes& file : {bytesOfArray(kJpegRgb), bytesOfArray(kJpegProgressive)}) {
    const Image image = decoded(file);
    REQUIRE(image.channels == 3);
    CHECK(image.width == 16);
    CHECK(image.height == 8);
    const unsigned want[2][3] = {{220, 30, 30}, {60, 60, 200}};
    for (int side = 0; side < 2; ++side)
      for (int c = 0; c < 3; ++c) CHECK(std::abs(int(sample(image, side * 15, 4, c)) - int(want[side][c])) <= 3);
  }
  const Image grey = decoded(bytesOfArray(kJpegGrey));
  REQUIRE(grey.channels == 1);
  CHECK(grey.width == 9);
  CHECK(std::abs(int(sample(grey, 0, 0, 0)) - 200) <= 3);
  const Image cmyk = decoded(bytesOfArray(kJpegCmyk));
  REQUIRE(cmyk.channels == 3);
  CHECK(sample(cmyk, 0, 0, 1) > 250);
  CHECK(sample(cmyk, 15, 0, 1) < 5);
}

TEST_CASE("Radiance HDR: values and the four orders of rows", "[decode]") {
  // Mantissas m and exponent e stand for (m + 0.5) / 256 * 2^(e - 128) in Radiance's own code, m / 256 * 2^(e - 128) in
  // most readers.
  const auto pixel = [](int i) { return std::uint32_t(0x80000081u) + (std::uint32_t(i) << 16); };
  const int indexOfFirst[4] = {0, 6, 2, 8};  // which stored pixel shows at the top left
  const char* resolutions[4] = {"-Y 3 +X 3", "+Y 3 +X 3", "-Y 3 -X 3", "+Y 3 -X 3"};
  for (int k = 0; k < 4; ++k) {
    INFO(resolutions[k]);
    const Image image = decoded(makeHdr(resolutions[k], 9, pixel));
    REQUIRE(image.type == PixelType::F32);
    REQUIRE(image.channels == 3);
    CHECK(floatAt(image, 0, 0, 0) == Approx(1.0).margin(0.005));
    CHECK(floatAt(image, 0, 0, 1) == Approx(indexOfFirst[k] / 128.0).margin(0.005));
    CHECK(floatAt(image, 0, 0, 2) == Approx(0.0).margin(0.005));
  }
  const auto columns = sharedPool().decode(makeHdr("+X 3 -Y 3", 9, pixel), "columns.hdr");
  REQUIRE_FALSE(columns);
  CHECK(columns.error().message().find("columns") != std::string::npos);
}

TEST_CASE("OpenEXR: half, float, compressions, tiles; NaN and infinity pass through", "[decode]") {
  for (bool half : {false, true})
    for (bool tiled : {false, true})
      for (int compression : {0, 1, 2, 3, 4}) {
        INFO("half " << half << ", tiled " << tiled << ", compression " << compression);
        ExrOptions options;
        options.dataWidth = options.displayWidth = 33, options.dataHeight = options.displayHeight = 21;
        options.half = half, options.tiled = tiled, options.compression = compression;
        const auto value = [](int x, int y, int c) {
          return x == 0 && y == 0   ? std::numeric_limits<float>::infinity()
                 : x == 1 && y == 0 ? std::nanf("")
                                    : 0.25f * float(x) + 8.0f * float(y) - float(c);
        };
        const Image image = decoded(makeExr(options, value));
        REQUIRE(image.type == PixelType::F32);
        REQUIRE(image.channels == 3);
        CHECK(std::isinf(floatAt(image, 0, 0, 0)));
        CHECK(std::isnan(floatAt(image, 1, 0, 2)));
        bool equal = true;
        for (int y = 1; y < 21; ++y)
          for (int x = 0; x < 33; ++x)
            for (int c = 0; c < 3; ++c) equal = equal && floatAt(image, x, y, c) == value(x, y, c);
        CHECK(equal);
      }
}

TEST_CASE("OpenEXR: the picture is the display window", "[decode]") {
  const auto value = [](int x, int y, int) { return float(100 * y + x + 1); };
  ExrOptions options;
  options.displayX = 2, options.displayY = 3, options.displayWidth = 6, options.displayHeight = 5;
  struct Window {
    int x, y, w, h;
  };
  for (const auto& [x, y, w, h] :
       {Window{4, 4, 2, 2}, {0, 0, 20, 20}, {-3, 5, 7, 9}, {2, 3, 6, 5}, {100, 100, 4, 4}, {7, 7, 1, 1}}) {
    INFO(x << " " << y << " " << w << " " << h);
    options.dataX = x, options.dataY = y, options.dataWidth = w, options.dataHeight = h;
    const Image image = decoded(makeExr(options, value));
    REQUIRE(image.width == 6);
    REQUIRE(image.height == 5);
    bool equal = true;
    for (int row = 0; row < 5; ++row)
      for (int column = 0; column < 6; ++column) {
        const int px = column + 2, py = row + 3;
        const bool stored = px >= x && px < x + w && py >= y && py < y + h;
        equal = equal && floatAt(image, column, row, 0) == (stored ? value(px, py, 0) : 0.0f);
      }
    CHECK(equal);
  }
}

TEST_CASE("OpenEXR: one to many channels; the first four are kept, colours first", "[decode]") {
  const auto value = [](int, int, int c) { return float(c + 1); };
  struct Kind {
    std::vector<const char*> names;
    std::vector<float> want;
  };
  for (const Kind& kind : {Kind{{"Y"}, {1}}, Kind{{"Y", "A"}, {1, 2}}, Kind{{"R", "G", "B"}, {1, 2, 3}},
                           Kind{{"A", "B", "G", "R"}, {4, 3, 2, 1}},
                           Kind{{"A", "B", "G", "R", "Z", "id"}, {4, 3, 2, 1}}, Kind{{"R"}, {1}}}) {
    ExrOptions options;
    options.channels = kind.names;
    const Image image = decoded(makeExr(options, value));
    REQUIRE(image.channels == int(kind.want.size()));
    for (std::size_t c = 0; c < kind.want.size(); ++c) CHECK(floatAt(image, 1, 2, int(c)) == kind.want[c]);
  }
}

TEST_CASE("What the writers write is read back", "[decode]") {
  for (int channels = 1; channels <= 4; ++channels) {
    INFO(channels);
    Image bytes = makeImage(19, 11, channels, PixelType::U8);
    for (std::size_t i = 0; i < bytes.data.size(); ++i) bytes.u8()[i] = static_cast<std::uint8_t>(i * 31 + i / 7);
    auto png = image::encodePng(bytes, "round.png");
    REQUIRE(png);
    const Image again = decoded(*png);
    CHECK(again.channels == channels);
    CHECK(again.data == bytes.data);

    for (PixelType type : {PixelType::F16, PixelType::F32}) {
      Image floats = makeImage(19, 11, channels, type);
      const std::size_t n = floats.pixelCount() * std::size_t(channels);
      std::vector<float> want(n);
      for (std::size_t i = 0; i < n; ++i) {
        want[i] = i % 5 == 0 ? 60000.0f : float(i) * 0.125f;  // exact in half float
        const std::uint16_t half = i % 5 == 0 ? 0x7b53 : 0;
        if (type == PixelType::F32)
          floats.f32()[i] = want[i];
        else
          std::memcpy(floats.data.data() + 2 * i, &half, 2);
        if (type == PixelType::F16 && i % 5 != 0) want[i] = 0;
      }
      auto exr = image::encodeExr(floats, "round.exr");
      REQUIRE(exr);
      const Image read = decoded(*exr);
      REQUIRE(read.channels == channels);
      bool equal = true;
      for (std::size_t i = 0; i < n; ++i) equal = equal && read.f32()[i] == want[i];
      CHECK(equal);
    }
  }
}

TEST_CASE("Files that are no picture of the four formats are refused by their first bytes", "[decode]") {
  for (std::string_view text : {"", "GIF89a....", "BM......", "II*\0........", "DDS |", "#?RAD", "\x89PNG", "\xff\xd8",
                                "<svg/>", "P6 1 1 255 abc", "8BPS"}) {
    auto image = sharedPool().decode(bytesOf(text), "odd.png");
    REQUIRE_FALSE(image);
    CHECK(image.error().place == "odd.png");
    CHECK_FALSE(image.error().remedy.empty());
  }
}

TEST_CASE("The pictures of the shared data decode", "[decode][data]") {
  const std::filesystem::path data = BURNISH_SOURCE_DIR "/../shared/data";
  if (!std::filesystem::exists(data)) return;
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    const auto extension = entry.path().extension();
    if ((extension != ".png" && extension != ".jpg" && extension != ".hdr") ||
        entry.path().filename().string().starts_with("invalid"))
      continue;
    if (entry.path().string().find("gltf-validator") != std::string::npos) continue;
    INFO(entry.path());
    auto file = core::readFile(entry.path(), 1 << 30);
    REQUIRE(file);
    CHECK(sharedPool().decode(*file, entry.path().filename().string()));
    ++count;
  }
  CHECK(count > 10);
}
