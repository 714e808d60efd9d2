#include "image/cube_layout.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "image/convert.h"
#include "image/cube_texels.h"

namespace burnish::image {
namespace {

/// Where a face's square stands in a picture, in faces.
struct Cell {
  int x = 0, y = 0;
  bool turned = false;  ///< by 180 degrees
};
using Cells = std::array<Cell, 6>;

constexpr Cells kHorizontalCross = {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}};
constexpr Cells kVerticalCross = {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3, true}}};
constexpr Cells kHorizontalStrip = {{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}};
constexpr Cells kVerticalStrip = {{{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}}};

const Cells& cellsOf(PictureLayout layout) {
  switch (layout) {
    case PictureLayout::HorizontalCross: return kHorizontalCross;
    case PictureLayout::VerticalCross: return kVerticalCross;
    case PictureLayout::HorizontalStrip: return kHorizontalStrip;
    default: return kVerticalStrip;
  }
}

int faceSize(const Image& rgb, PictureLayout layout) {
  switch (layout) {
    case PictureLayout::HorizontalCross: return rgb.width / 4;
    case PictureLayout::VerticalCross: return rgb.width / 3;
    case PictureLayout::HorizontalStrip: return rgb.height;
    default: return rgb.width;
  }
}

const float* pixel(const Image& rgb, int x, int y) { return rgb.f32() + (std::size_t(y) * std::size_t(rgb.width) + std::size_t(x)) * 3; }

}  // namespace

std::optional<PictureLayout> pictureLayout(int width, int height) {
  const std::int64_t w = width, h = height;
  if (w < 1 || h < 1) return std::nullopt;
  if (w == 2 * h) return PictureLayout::LatLong;
  if (3 * w == 4 * h) return PictureLayout::HorizontalCross;
  if (4 * w == 3 * h) return PictureLayout::VerticalCross;
  if (w == 6 * h) return PictureLayout::HorizontalStrip;
  if (6 * w == h) return PictureLayout::VerticalStrip;
  return std::nullopt;
}

std::string_view layoutName(PictureLayout layout) {
  constexpr std::string_view kNames[] = {"lat-long picture", "horizontal cross", "vertical cross", "horizontal strip", "vertical strip"};
  return kNames[static_cast<std::size_t>(layout)];
}

Image linearRgb(Image picture) {
  if (picture.type != PixelType::F32) picture = toLinear(picture);
  if (picture.channels == 3) return picture;  // large pictures are mostly this: nothing is copied
  return picture.channels < 3 ? extractChannels(picture, {0, 0, 0}) : extractChannels(picture, {0, 1, 2});
}

void copyFace(const Image& rgb, int x, int y, bool turned, CubeLevel& level, std::size_t face) {
  const auto size = static_cast<std::size_t>(level.size);
  float* to = level.texels.data() + face * size * size * 3;
  for (int row = 0; row < level.size; ++row) {
    const float* from = pixel(rgb, x, y + (turned ? level.size - 1 - row : row));
    if (!turned) {
      to = std::copy_n(from, size * 3, to);
      continue;
    }
    for (std::size_t i = size; i-- > 0;) to = std::copy_n(from + i * 3, 3, to);
  }
}

CubeLevel cubeFromPicture(const Image& rgb, PictureLayout layout) {
  const int size = faceSize(rgb, layout);
  CubeLevel level = makeLevel(size, 0);
  for (std::size_t face = 0; face < 6; ++face) {
    const Cell& cell = cellsOf(layout)[face];
    copyFace(rgb, cell.x * size, cell.y * size, cell.turned, level, face);
  }
  return level;
}

bool crossHasContent(const Image& rgb, PictureLayout layout) {
  if (layout != PictureLayout::HorizontalCross && layout != PictureLayout::VerticalCross) return false;
  const int size = faceSize(rgb, layout);
  const float* first = pixel(rgb, 0, 0);  // of a corner without a face, in both crosses
  for (int y = 0; y < rgb.height; ++y)
    for (int x = 0; x < rgb.width; ++x) {
      const bool used = std::any_of(cellsOf(layout).begin(), cellsOf(layout).end(), [&](const Cell& c) { return c.x == x / size && c.y == y / size; });
      if (used) x += size - 1;
      else if (std::memcmp(pixel(rgb, x, y), first, 3 * sizeof(float)) != 0) return true;
    }
  return false;
}

Image stackedStrips(const Cubemap& cubemap) {
  int height = 0;
  for (const CubeLevel& level : cubemap.levels) height += level.size;
  Image out = makeImage(6 * cubemap.levels[0].size, height, 3, PixelType::F32);
  int y = 0;
  for (const CubeLevel& level : cubemap.levels) {
    const auto row = static_cast<std::size_t>(level.size) * 3;
    for (int face = 0; face < 6; ++face)
      for (int r = 0; r < level.size; ++r)
        std::copy_n(level.texels.data() + std::size_t(face * level.size + r) * row, row, out.f32() + (std::size_t(y + r) * std::size_t(out.width) + std::size_t(face * level.size)) * 3);
    y += level.size;
  }
  return out;
}

std::optional<Cubemap> cubeFromStackedStrips(const Image& rgb) {
  const int size = rgb.width / 6;
  if (size < 1 || rgb.width != 6 * size) return std::nullopt;
  int levels = 0, height = 0;
  while (levels < fullChain(size) && height < rgb.height) height += levelSize(size, levels++);
  if (height != rgb.height) return std::nullopt;
  Cubemap cube;
  int y = 0;
  for (int k = 0; k < levels; ++k) {
    CubeLevel& level = cube.levels.emplace_back(makeLevel(size, k));
    for (std::size_t face = 0; face < 6; ++face) copyFace(rgb, static_cast<int>(face) * level.size, y, false, level, face);
    y += level.size;
  }
  return cube;
}

}  // namespace burnish::image
