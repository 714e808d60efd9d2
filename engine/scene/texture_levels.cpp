#include "scene/texture_levels.h"

#include <fmt/format.h>

#include <utility>

#include "image/resample.h"
#include "material/mips.h"

namespace burnish::scene {
namespace {

int channelsOf(const Texture& t) { return t.kind != MapKind::Occlusion ? 4 : t.image.channels >= 2 ? 2 : 1; }

// RGB to RGBA and the like; missing channels are opaque.
Image withChannels(const Image& in, int channels) {
  if (in.channels == channels) return in;
  Image out = makeImage(in.width, in.height, channels, PixelType::U8);
  const std::uint8_t* from = in.u8();
  std::uint8_t* to = out.u8();
  for (std::size_t i = 0; i < in.pixelCount(); ++i)
    for (int c = 0; c < channels; ++c) to[i * std::size_t(channels) + std::size_t(c)] = c < in.channels ? from[i * std::size_t(in.channels) + std::size_t(c)] : 255;
  return out;
}

Result<void> checkImage(const Texture& t) {
  if (t.image.empty() || t.image.type != PixelType::U8 || t.image.data.size() != t.image.byteSize() || t.image.channels < 1 || t.image.channels > 4)
    return fail(fmt::format("texture '{}'", t.name), "is empty, not 8 bit, or shorter than its size says", "give it an Image as makeImage makes it");
  return {};
}

std::vector<Image> chainOf(MapKind kind, Image level0, bool mips) {
  if (mips) return material::buildMips(kind, std::move(level0));
  std::vector<Image> one;
  one.push_back(std::move(level0));
  return one;
}

// Writes the occlusion's chain into the third channel of the normals'.
void packOcclusion(std::vector<Image>& levels, const Texture& occlusion) {
  Image c = withChannels(occlusion.image, 1);
  if (c.width != levels[0].width || c.height != levels[0].height) c = image::resampleArea(c, levels[0].width, levels[0].height);
  const std::vector<Image> from = chainOf(occlusion.kind, std::move(c), levels.size() > 1);
  for (std::size_t k = 0; k < levels.size() && k < from.size(); ++k)
    for (std::size_t i = 0; i < levels[k].pixelCount(); ++i) levels[k].u8()[i * 4 + 2] = from[k].u8()[i];
}

}  // namespace

Result<std::vector<Image>> levelsOf(const Texture& t, const Texture* occlusion) {
  if (auto good = checkImage(t); !good) return fail(good.error());
  if (occlusion)
    if (auto good = checkImage(*occlusion); !good) return fail(good.error());
  std::vector<Image> levels = chainOf(t.kind, withChannels(t.image, channelsOf(t)), t.sampler.mips);
  if (occlusion) packOcclusion(levels, *occlusion);
  return levels;
}

}  // namespace burnish::scene
