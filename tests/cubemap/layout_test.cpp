// Surroundings in every layout: each texel of what is read must have the colour of its direction.
#include "cube_fixture.h"

using namespace cube_test;

namespace {

/// How each cell of a cross continues its neighbour: the direction at (s, t) of a cell, each from -1 to 1 from left to right and from top to bottom, with +Z in the middle, unfolded by hand.
Vec crossDirection(int column, int row, double s, double t) {
  if (row == 0) return {s, 1, t};
  if (row == 2) return {s, -1, -t};
  if (row == 3) return {s, t, -1};
  return column == 0 ? Vec{-1, -t, s} : column == 1 ? Vec{s, -t, 1} : column == 2 ? Vec{1, -t, -s} : Vec{-s, -t, -1};
}

/// A picture of cells of size², black where `used` is false.
template <class Used>
Image crossPicture(int size, int columns, int rows, Used used) {
  Image image = makeImage(size * columns, size * rows, 3, PixelType::F32);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const int column = x / size, row = y / size;
      if (!used(column, row)) continue;
      const Vec d = crossDirection(column, row, centre(x % size, size), centre(y % size, size));
      const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      for (std::size_t c = 0; c < 3; ++c) image.f32()[(std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 3 + c] = code(d[c] / length);
    }
  return image;
}

Image horizontalCross(int size) {
  return crossPicture(size, 4, 3, [](int column, int row) { return row == 1 || column == 1; });
}
Image verticalCross(int size) {
  return crossPicture(size, 3, 4, [](int column, int row) { return row == 1 || column == 1; });
}

Image strip(int size, bool horizontal) {
  const CubeLevel cube = directionCube(size);
  Image image = makeImage(horizontal ? 6 * size : size, horizontal ? size : 6 * size, 3, PixelType::F32);
  for (std::size_t face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const int px = horizontal ? static_cast<int>(face) * size + x : x, py = horizontal ? y : static_cast<int>(face) * size + y;
        std::memcpy(image.f32() + (std::size_t(py) * std::size_t(image.width) + std::size_t(px)) * 3, cube.texels.data() + ((face * std::size_t(size) + std::size_t(y)) * std::size_t(size) + std::size_t(x)) * 3, 12);
      }
  return image;
}

EnvironmentFile readGood(const fs::path& file, std::size_t warnings = 0) {
  Report report;
  auto read = readEnvironment(file, report, options());
  INFO((read ? std::string() : read.error().message()));
  REQUIRE(read);
  for (const Warning& w : report.warnings()) UNSCOPED_INFO(w.message());
  CHECK(report.warnings().size() == warnings);
  return std::move(*read);
}

std::string errorOf(const fs::path& file) {
  Report report;
  const auto read = readEnvironment(file, report, options());
  REQUIRE_FALSE(read);
  CHECK_FALSE(read.error().what.empty());
  CHECK_FALSE(read.error().remedy.empty());
  return read.error().message();
}

}  // namespace

TEST_CASE("Crosses and strips give the cube that they show", "[cubemap]") {
  const Folder folder;
  const fs::path exr = folder.path / "p.exr", png = folder.path / "p.png";
  const std::pair<Image, std::string> pictures[] = {{horizontalCross(8), "horizontal cross"}, {verticalCross(8), "vertical cross"}, {strip(8, true), "horizontal strip"}, {strip(8, false), "vertical strip"}};
  for (const auto& [picture, name] : pictures) {
    INFO(name);
    REQUIRE(writeExr(exr, picture));
    const EnvironmentFile read = readGood(exr);
    REQUIRE(read.isCube());
    CHECK(read.layout.find(name) == 0);
    CHECK(read.cube.levels.size() == 1);
    CHECK(read.cube.levels[0].size == 8);
    CHECK(directionError(read.cube.levels[0]) < 1e-6);
    CHECK_FALSE(read.cube.lobe);
    // 8 bits: half a code is 0.006 of linear light at most.
    REQUIRE(writePng(png, inEightBits(picture)));
    const EnvironmentFile coarse = readGood(png);
    CHECK(directionError(coarse.cube.levels[0]) < 0.006);
    CHECK(coarse.layout.find("sRGB") != std::string::npos);
  }
}

TEST_CASE("A lat-long picture stays one, linear and in three channels", "[cubemap]") {
  const Folder folder;
  for (const int channels : {1, 2, 3, 4}) {
    Image picture = makeImage(8, 4, channels, PixelType::F32);
    for (std::size_t i = 0; i < 32 * std::size_t(channels); ++i) picture.f32()[i] = static_cast<float>(i) / 16;
    REQUIRE(writeExr(folder.path / "l.exr", picture));
    const EnvironmentFile read = readGood(folder.path / "l.exr");
    CHECK_FALSE(read.isCube());
    CHECK(read.latLong.channels == 3);
    CHECK(read.latLong.type == PixelType::F32);
    for (std::size_t i = 0; i < 32; ++i)
      for (std::size_t c = 0; c < 3; ++c) CHECK(read.latLong.f32()[i * 3 + c] == picture.f32()[i * std::size_t(channels) + (channels > 2 ? c : 0)]);
  }
  Image eight = makeImage(4, 2, 3, PixelType::U8);
  for (std::size_t i = 0; i < eight.data.size(); ++i) eight.u8()[i] = 188;
  REQUIRE(writePng(folder.path / "l.png", eight));
  CHECK(readGood(folder.path / "l.png").latLong.f32()[5] == Approx(0.502886).margin(1e-5));  // ((188/255 + 0.055)/1.055)^2.4
}

TEST_CASE("Six files are found under every name, as a pattern, a folder and a list", "[cubemap]") {
  const char* const kNames[][6] = {{"px", "nx", "py", "ny", "pz", "nz"},   {"PX", "NX", "PY", "NY", "PZ", "NZ"},
                                   {"posx", "negx", "posy", "negy", "posz", "negz"}, {"right", "left", "top", "bottom", "front", "back"},
                                   {"+x", "-x", "+y", "-y", "+z", "-z"}};
  const CubeLevel cube = directionCube(6);
  for (const auto& names : kNames) {
    const Folder folder;
    INFO(names[0]);
    std::vector<fs::path> files;
    for (std::size_t face = 0; face < 6; ++face) {
      files.push_back(folder.path / (std::string("sky_") + names[face] + ".exr"));
      REQUIRE(writeExr(files.back(), facePicture(cube, face)));
    }
    std::ofstream(folder.path / "desktop.png") << "is no top";
    std::ofstream(folder.path / "readme.txt") << "no picture";
    for (const fs::path& given : {folder.path / "sky_%s.exr", folder.path}) {
      const EnvironmentFile read = readGood(given);
      CHECK(directionError(read.cube.levels[0]) < 1e-6);
    }
    Report report;
    const auto listed = readEnvironment(files, report, options());
    REQUIRE(listed);
    CHECK(directionError(listed->cube.levels[0]) < 1e-6);
  }
}

TEST_CASE("Sets of faces that do not fit are one clear error", "[cubemap]") {
  const Folder folder;
  const CubeLevel cube = directionCube(4);
  for (std::size_t face = 0; face < 6; ++face) REQUIRE(writeExr(folder.path / (std::string("a_") + std::array{"px", "nx", "py", "ny", "pz", "nz"}[face] + ".exr"), facePicture(cube, face)));
  fs::copy_file(folder.path / "a_nz.exr", folder.path / "spare");
  fs::remove(folder.path / "a_nz.exr");
  CHECK(errorOf(folder.path / "a_%s.exr").find("a_nz.exr") != std::string::npos);
  CHECK(errorOf(folder.path / "b_%s.exr").find("b_%s.exr") != std::string::npos);
  CHECK(errorOf(folder.path).find("no six faces") != std::string::npos);
  REQUIRE(writeExr(folder.path / "a_nz.exr", facePicture(directionCube(5), 5)));
  CHECK(errorOf(folder.path).find("a_nz.exr") != std::string::npos);
  REQUIRE(writeExr(folder.path / "a_nz.exr", makeImage(4, 5, 3, PixelType::F32)));
  CHECK(errorOf(folder.path).find("square") != std::string::npos);
  fs::remove(folder.path / "a_nz.exr");
  fs::copy_file(folder.path / "spare", folder.path / "a_nz.exr");
  for (const char* face : {"px", "nx", "py", "ny", "pz", "nz"}) fs::copy_file(folder.path / "a_px.exr", folder.path / (std::string("b_") + face + ".exr"));
  CHECK(errorOf(folder.path).find("2 sets") != std::string::npos);
  Report report;
  const std::vector<fs::path> five(5, folder.path / "a_px.exr");
  CHECK_FALSE(readEnvironment(five, report, options()));
}

TEST_CASE("Other shapes and other files are one clear error", "[cubemap]") {
  const Folder folder;
  const fs::path file = folder.path / "p.exr";
  for (const auto& [width, height] : {std::pair(5, 4), std::pair(7, 7), std::pair(1, 9)}) {
    REQUIRE(writeExr(file, makeImage(width, height, 3, PixelType::F32)));
    CHECK(errorOf(file).find("neither a lat-long picture") != std::string::npos);
  }
  std::ofstream(folder.path / "t.hdr") << "hello";
  CHECK(errorOf(folder.path / "t.hdr").find("is no DDS, KTX2") != std::string::npos);
  std::ofstream(folder.path / "e.hdr");
  CHECK(errorOf(folder.path / "e.hdr").find("is empty") != std::string::npos);
  CHECK(errorOf(folder.path / "none.hdr").find("none.hdr") != std::string::npos);
  REQUIRE(writeExr(file, makeImage(8, 4, 3, PixelType::F32)));
  Report report;
  const auto cube = readCubemap(file, report, options());
  REQUIRE_FALSE(cube);
  CHECK(cube.error().what.find("lat-long") != std::string::npos);
  EnvironmentFileOptions small = options();
  small.limits.maxSide = 7;
  CHECK_FALSE(readEnvironment(file, report, small));
}

TEST_CASE("An ordinary picture of a cross's shape is warned of", "[cubemap]") {
  const Folder folder;
  Image picture = horizontalCross(4);
  picture.f32()[3] = 0.25f;
  REQUIRE(writeExr(folder.path / "p.exr", picture));
  readGood(folder.path / "p.exr", 1);
}

TEST_CASE("Values that are no radiance are mended, with a warning that names the first", "[cubemap]") {
  const Folder folder;
  Image picture = horizontalCross(4);
  const auto at = [&](int x, int y) { return picture.f32() + (std::size_t(y) * 16 + std::size_t(x)) * 3; };
  at(9, 5)[1] = std::nanf("");                                  // +X, column 1, row 1
  at(5, 6)[0] = -1;                                             // +Z
  at(5, 7)[2] = std::numeric_limits<float>::infinity();         // +Z
  at(6, 7)[2] = 1e30f;                                          // finite: stays
  REQUIRE(writeExr(folder.path / "p.exr", picture));
  Report report;
  const auto read = readEnvironment(folder.path / "p.exr", report, options());
  REQUIRE(read);
  REQUIRE(report.warnings().size() == 1);
  const std::string text = report.warnings()[0].message();
  for (const char* part : {"p.exr", "3 values", "1 not a number", "1 negative", "1 infinite", "face +X, column 1, row 1"}) {
    INFO(text);
    CHECK(text.find(part) != std::string::npos);
  }
  const auto texel = [&](std::size_t face, std::size_t x, std::size_t y) { return read->cube.levels[0].texels.data() + ((face * 4 + y) * 4 + x) * 3; };
  CHECK(texel(0, 1, 1)[1] == 0);
  CHECK(texel(4, 1, 2)[0] == 0);
  CHECK(texel(4, 1, 3)[2] == 65504);
  CHECK(texel(4, 2, 3)[2] == 1e30f);
  EnvironmentFileOptions raw = options();
  raw.asStored = true;
  const auto stored = readEnvironment(folder.path / "p.exr", report, raw);
  REQUIRE(stored);
  CHECK(std::isnan(stored->cube.levels[0].texels[(0 * 16 + 5) * 3 + 1]));
  CHECK(report.warnings().size() == 1);
}

TEST_CASE("Mended values of a lat-long picture are named by column and row", "[cubemap]") {
  const Folder folder;
  Image picture = makeImage(8, 4, 4, PixelType::F32);
  picture.f32()[(2 * 8 + 3) * 4 + 1] = -std::numeric_limits<float>::infinity();
  picture.f32()[(3 * 8 + 3) * 4 + 3] = std::nanf("");  // alpha: nobody looks
  REQUIRE(writeExr(folder.path / "l.exr", picture));
  Report report;
  const auto read = readEnvironment(folder.path / "l.exr", report, options());
  REQUIRE(read);
  CHECK(read->latLong.f32()[(2 * 8 + 3) * 3 + 1] == 0);
  REQUIRE(report.warnings().size() == 1);
  CHECK(report.warnings()[0].what.find("1 values were mended: 0 not a number and 1 negative became 0, 0 infinite became 65504; the first is in column 3, row 2") == 0);
}
