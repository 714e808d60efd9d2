// Cubes whose every texel tells its direction, a folder of its own for each test, and a decoder for all of them.
#pragma once
#include <burnish/image.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "gpu/temporary_folder.h"

namespace cube_test {

namespace fs = std::filesystem;
using namespace burnish;

using Folder = burnish::test::TemporaryFolder;

inline std::vector<std::byte> bytesOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}
inline void put(const fs::path& file, std::span<const std::byte> bytes) {
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}
inline std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// One pool of helpers for all tests of the program.
inline ImageDecoder& decoder() {
  static const std::unique_ptr<ImageDecoder> kPool = makeDecoderPool();
  return *kPool;
}
inline EnvironmentFileOptions options() {
  EnvironmentFileOptions o;
  o.decoder = &decoder();
  return o;
}

using Vec = std::array<double, 3>;

/// OpenGL 4.5 specification, table 8.19, solved for the direction; u, v in [-1, 1] along columns and rows.
inline Vec faceDirection(std::size_t face, double u, double v) {
  const Vec d = std::array<Vec, 6>{Vec{1, -v, -u}, Vec{-1, -v, u}, Vec{u, 1, v}, Vec{u, -1, -v}, Vec{u, -v, 1}, Vec{-u, -v, -1}}[face];
  const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  return {d[0] / length, d[1] / length, d[2] / length};
}
inline double centre(int i, int size) { return (2.0 * i + 1) / size - 1; }

/// The colour that tells a direction: each part 0.25 to 0.75, so that 8 bits in sRGB tell it too.
inline float code(double part) { return static_cast<float>(0.5 + 0.25 * part); }

/// Every texel's colour is its direction's.
inline CubeLevel directionCube(int size) {
  CubeLevel level;
  level.size = size;
  for (std::size_t face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        for (const double part : faceDirection(face, centre(x, size), centre(y, size))) level.texels.push_back(code(part));
  return level;
}

/// A chain of such cubes with rising roughness. `half`: values that half floats hold exactly.
inline Cubemap directionChain(int size, int levels, std::optional<ReflectionLobe> lobe, bool half) {
  Cubemap cube;
  cube.lobe = lobe;
  for (int k = 0; k < levels; ++k) {
    CubeLevel level = directionCube(std::max(size >> k, 1));
    level.roughness = lobe ? k / 7.0 : 0;  // sevenths have no short decimal form
    for (float& v : level.texels) v = half ? std::ldexp(std::round(v * 1024) / 1024, k) : v * static_cast<float>(k + 1);
    cube.levels.push_back(std::move(level));
  }
  return cube;
}

inline void checkSame(const Cubemap& read, const Cubemap& written) {
  CHECK(read.lobe == written.lobe);
  REQUIRE(read.levels.size() == written.levels.size());
  for (std::size_t k = 0; k < read.levels.size(); ++k) {
    CHECK(read.levels[k].size == written.levels[k].size);
    CHECK(read.levels[k].roughness == written.levels[k].roughness);
    CHECK((read.levels[k].texels == written.levels[k].texels));  // not printed
  }
}

/// Largest difference between a cube's colours and those of its directions.
inline double directionError(const CubeLevel& level) {
  const CubeLevel expected = directionCube(level.size);
  REQUIRE(level.texels.size() == expected.texels.size());
  double worst = 0;
  for (std::size_t i = 0; i < level.texels.size(); ++i) worst = std::max(worst, std::abs(double(level.texels[i]) - double(expected.texels[i])));
  return worst;
}

inline Image facePicture(const CubeLevel& level, std::size_t face) {
  Image image = makeImage(level.size, level.size, 3, PixelType::F32);
  std::memcpy(image.data.data(), level.texels.data() + face * image.pixelCount() * 3, image.data.size());
  return image;
}

/// The picture with the sRGB curve, 8 bits.
inline Image inEightBits(const Image& image) {
  Image out = makeImage(image.width, image.height, image.channels, PixelType::U8);
  for (std::size_t i = 0; i < out.data.size(); ++i) {
    const double x = double(image.f32()[i]);
    out.u8()[i] = static_cast<std::uint8_t>(std::lround(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055)));
  }
  return out;
}

}  // namespace cube_test
