#include "probe/payload.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "image/cube_file.h"
#include "image/ktx2_picture.h"
#include "probe/manifest.h"

namespace burnish::probe {
namespace {

constexpr int kTile = AmbientGrid::kDistanceSize;
constexpr int kMostSide = 1 << 23;  // a lattice of the most points in one row
constexpr const char* kRemedy = "restore the file, or bake again";

DecodeLimits limits(std::uint64_t bytes) { return {.maxSide = kMostSide, .maxBytes = bytes}; }

/// A picture of the expected size, with finite values.
Result<Image> decodePicture(std::span<const std::byte> bytes, const std::string& name, int width, int height, int channels) {
  auto picture = image::decodeKtx2Picture(bytes, name, limits(std::uint64_t(width) * std::uint64_t(height) * std::uint64_t(channels) * 4));
  if (!picture) return fail(picture.error().place, picture.error().what, kRemedy);
  if (picture->width != width || picture->height != height || picture->channels != channels)
    return fail(name, fmt::format("is {} x {} texels of {} channels, not {} x {} of {}", picture->width, picture->height, picture->channels, width, height, channels), kRemedy);
  for (std::size_t i = 0; i < picture->pixelCount() * std::size_t(channels); ++i)
    if (!std::isfinite(picture->f32()[i]))
      return fail(name, fmt::format("holds {} at column {}, row {}", picture->f32()[i], i / std::size_t(channels) % std::size_t(width), i / std::size_t(channels) / std::size_t(width)), kRemedy);
  return picture;
}

int rowsOf(const AmbientGrid& g) { return g.counts.y * g.counts.z; }
/// f(point, first texel of its columns, row) in order.
template <class F>
void eachPoint(const AmbientGrid& g, F&& f) {
  for (int row = 0; row < rowsOf(g); ++row)
    for (int x = 0; x < g.counts.x; ++x) f(std::size_t(row) * std::size_t(g.counts.x) + std::size_t(x), x, row);
}

}  // namespace

EncodedRadiance encodeRadiance(const Cubemap& radiance) {
  const double scale = image::halfScale(radiance);
  return {image::encodeKtx2(radiance, PixelType::F16, scale), scale};
}

Result<Cubemap> decodeRadiance(std::span<const std::byte> bytes, const std::string& name, const Manifest::Reflection& expected, std::optional<ReflectionLobe> lobe) {
  if (!image::isKtx2(bytes)) return fail(name, "is no KTX2 file", kRemedy);
  auto file = image::decodeKtx2(bytes, name, {.maxSide = kMostSize});
  if (!file) return fail(file.error().place, file.error().what, kRemedy);
  Cubemap& cube = file->cube;
  if (cube.levels[0].size != expected.size || int(cube.levels.size()) != expected.levels)
    return fail(name, fmt::format("has {} levels of faces of {}, the manifest says {} of {}", cube.levels.size(), cube.levels[0].size, expected.levels, expected.size), kRemedy);
  if (file->scale != expected.scale) return fail(name, fmt::format("is to be multiplied by {}, the manifest says {}", file->scale, expected.scale), kRemedy);
  if (cube.lobe != lobe) return fail(name, "is filtered for another lobe than the manifest says", kRemedy);
  if (auto ok = image::checkCubemap(cube, name); !ok) return fail(ok.error().place, ok.error().what, kRemedy);
  return std::move(cube);
}

std::vector<std::byte> encodeIrradiance(const AmbientGrid& grid) {
  Image picture = makeImage(9 * grid.counts.x, rowsOf(grid), 3, PixelType::F32);
  eachPoint(grid, [&](std::size_t i, int, int) { std::memcpy(picture.f32() + i * 27, grid.points[i].irradiance.data(), 27 * sizeof(float)); });
  return image::encodeKtx2Picture(picture);
}

std::vector<std::byte> encodeDistances(const AmbientGrid& grid) {
  Image picture = makeImage(kTile * grid.counts.x, kTile * rowsOf(grid), 2, PixelType::F32);
  eachPoint(grid, [&](std::size_t i, int x, int row) {
    const std::vector<glm::vec2>& distances = grid.points[i].distances;
    for (int y = 0; y < kTile && !distances.empty(); ++y)
      std::memcpy(picture.f32() + 2 * ((std::size_t(row) * kTile + std::size_t(y)) * std::size_t(picture.width) + std::size_t(x) * kTile), distances.data() + y * kTile, kTile * sizeof(glm::vec2));
  });
  return image::encodeKtx2Picture(picture);
}

Result<void> decodeIrradiance(std::span<const std::byte> bytes, const std::string& name, AmbientGrid& grid) {
  const auto picture = decodePicture(bytes, name, 9 * grid.counts.x, rowsOf(grid), 3);
  if (!picture) return fail(picture.error());
  eachPoint(grid, [&](std::size_t i, int, int) { std::memcpy(grid.points[i].irradiance.data(), picture->f32() + i * 27, 27 * sizeof(float)); });
  return {};
}

Result<void> decodeDistances(std::span<const std::byte> bytes, const std::string& name, AmbientGrid& grid) {
  const auto picture = decodePicture(bytes, name, kTile * grid.counts.x, kTile * rowsOf(grid), 2);
  if (!picture) return fail(picture.error());
  bool good = true;
  eachPoint(grid, [&](std::size_t i, int x, int row) {
    std::vector<glm::vec2>& distances = grid.points[i].distances;
    distances.resize(std::size_t(kTile) * kTile);
    for (int y = 0; y < kTile; ++y)
      std::memcpy(distances.data() + y * kTile, picture->f32() + 2 * ((std::size_t(row) * kTile + std::size_t(y)) * std::size_t(picture->width) + std::size_t(x) * kTile), kTile * sizeof(glm::vec2));
    const auto any = [&](auto f) { return std::any_of(distances.begin(), distances.end(), f); };
    good = good && !any([](const glm::vec2& d) { return d.x < 0 || d.y < 0; });
    if (!grid.points[i].valid && !any([](const glm::vec2& d) { return d != glm::vec2(0); })) distances.clear();
  });
  if (!good) return fail(name, "holds a negative distance", kRemedy);
  return {};
}

}  // namespace burnish::probe
