// Reference pictures in files: what is written is read, and what is damaged is one error.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "burnish/image.h"
#include "burnish/measure.h"

using namespace burnish;
namespace fs = std::filesystem;

namespace {

struct File {
  fs::path path = fs::temp_directory_path() / ("burnish_reference_" + std::to_string(::getpid()) + ".exr");
  ~File() { fs::remove(path); }
};

ReferencePicture noise(int width, int height) {
  ReferencePicture p;
  std::mt19937 random(3);
  for (Image* image : {&p.radiance, &p.direct, &p.albedo, &p.normal, &p.variance}) {
    *image = makeImage(width, height, 3, PixelType::F32);
    for (std::size_t i = 0; i < image->pixelCount() * 3; ++i) image->f32()[i] = float(random()) * 0x1p-30f - 1;
  }
  p.samples = 48;
  p.error = 0.0123456789;
  p.seed = 0xfedcba9876543210ull;
  p.bounces = 5;
  p.pixelArea = false;
  p.scene = "hall";
  p.camera = "camera door";
  return p;
}
std::string bytesOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("reference files: all layers and what the header says come back bit for bit", "[exr]") {
  const File file;
  const ReferencePicture p = noise(37, 19);
  REQUIRE(writeReference(file.path, p));
  const auto back = readReference(file.path);
  REQUIRE(back);
  CHECK(back->radiance.data == p.radiance.data);
  CHECK(back->direct.data == p.direct.data);
  CHECK(back->albedo.data == p.albedo.data);
  CHECK(back->normal.data == p.normal.data);
  CHECK(back->variance.data == p.variance.data);
  CHECK(back->radiance.width == 37);
  CHECK(back->radiance.height == 19);
  CHECK(back->samples == 48);
  CHECK(back->error == p.error);
  CHECK(back->seed == p.seed);
  CHECK(back->bounces == 5);
  CHECK_FALSE(back->pixelArea);
  CHECK(back->scene == "hall");
  CHECK(back->camera == "camera door");
}

TEST_CASE("reference files: pictures that do not go together are not written", "[exr]") {
  const File file;
  ReferencePicture p = noise(8, 8);
  p.normal = makeImage(8, 7, 3, PixelType::F32);
  CHECK_FALSE(writeReference(file.path, p));
  CHECK_FALSE(writeReference(file.path, ReferencePicture{}));
  CHECK_FALSE(fs::exists(file.path));
}

TEST_CASE("reference files: damaged ones, and those of others, are one error that names the file", "[exr]") {
  const File file;
  const auto refused = [&] {
    const auto read = readReference(file.path);
    return !read && read.error().place == file.path.string() && !read.error().what.empty() && !read.error().remedy.empty();
  };
  CHECK(refused());  // there is none
  Image plain = makeImage(8, 8, 3, PixelType::F32);
  REQUIRE(writeExr(file.path, plain));
  const auto other = readReference(file.path);
  REQUIRE_FALSE(other);
  CHECK(other.error().what.find("direct.R") != std::string::npos);  // it says what is missing
  REQUIRE(writeReference(file.path, noise(16, 16)));
  const std::string good = bytesOf(file.path);
  const auto put = [&](const std::string& bytes) { std::ofstream(file.path, std::ios::binary | std::ios::trunc) << bytes; };
  for (std::size_t length = 0; length < good.size(); length += good.size() / 40 + 1) {
    put(good.substr(0, length));
    CHECK(refused());
  }
  // Any byte changed: an error, or a picture of the size that its header says; never anything else.
  std::mt19937 random(5);
  for (int i = 0; i < 400; ++i) {
    std::string bytes = good;
    const std::size_t at = i < 200 ? random() % 900 : random() % bytes.size();  // the header is within the first 900
    bytes[at] = char(random());
    put(bytes);
    const auto read = readReference(file.path);
    if (read) {
      CHECK(read->radiance.data.size() == read->variance.data.size());
      CHECK(read->radiance.pixelCount() <= 1u << 20);
    } else {
      CHECK(read.error().place == file.path.string());
    }
  }
}
