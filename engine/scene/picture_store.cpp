#include "scene/picture_store.h"

#include <fmt/format.h>

#include <cmath>

#include "material/pixels.h"
#include "scene/enlarge.h"

namespace burnish::scene {
namespace {

Wrap wrapOf(asset::Wrap wrap) {
  switch (wrap) {
    case asset::Wrap::Repeat:
      return Wrap::Repeat;
    case asset::Wrap::ClampToEdge:
      return Wrap::ClampToEdge;
    case asset::Wrap::MirroredRepeat:
      return Wrap::MirroredRepeat;
  }
  return Wrap::Repeat;
}

}  // namespace

// u' = offset + R (scale · u), R turning counter-clockwise as seen with v pointing down, so that the extension's
// example (offset (0, 1), rotation π/2, scale 0.5) uses the lower left quadrant turned clockwise: (u, v) becomes (v/2,
// 1 - u/2).
UvMapping mappingOf(const asset::TextureRef& ref) {
  const float c = std::cos(ref.rotation), s = std::sin(ref.rotation);
  UvMapping m;
  m.set = ref.uvSet == 1 ? 1 : 0;
  if (ref.rotation != 0)
    m.transform = {c * ref.scale.x, -s * ref.scale.x, s * ref.scale.y, c * ref.scale.y, ref.offset.x, ref.offset.y};
  else
    m.transform = {ref.scale.x, 0, 0, ref.scale.y, ref.offset.x, ref.offset.y};
  return m;
}

std::string keyOf(const Sampler& s) {
  return fmt::format("{}{}{:d}{:d}{:d}{:d}", int(s.wrapU), int(s.wrapV), s.magnifyLinear, s.minifyLinear, s.mipLinear,
                     s.mips);
}

Slot PictureStore::slot(const asset::TextureRef& ref) const {
  if (!ref || std::size_t(ref.texture) >= asset_.textures.size()) return {};
  const asset::Texture& texture = asset_.textures[std::size_t(ref.texture)];
  if (texture.picture < 0 || asset_.pictures[std::size_t(texture.picture)].pixels.empty()) return {};
  const asset::Sampler in = texture.sampler >= 0 ? asset_.samplers[std::size_t(texture.sampler)] : asset::Sampler{};
  return {texture.picture,
          {wrapOf(in.wrapS), wrapOf(in.wrapT), in.magnifyLinear, in.minifyLinear, in.mipLinear, in.mips},
          mappingOf(ref)};
}

const Image& PictureStore::rgba(const Slot& slot) {
  const Image& own = asset_.pictures[std::size_t(slot.picture)].pixels;
  if (own.type == PixelType::U8 && own.channels == 4) return own;
  const auto [at, isNew] = expanded_.try_emplace(slot.picture);
  if (isNew) at->second = material::toRgba8(own);
  return at->second;
}

const Image* PictureStore::sized(const Slot& slot, glm::ivec2 size, bool srgb) {
  if (!slot) return nullptr;
  const Image& own = rgba(slot);
  if (own.width == size.x && own.height == size.y) return &own;
  const auto [at, isNew] =
      enlarged_.try_emplace({slot.picture, size.x, size.y, srgb, int(slot.sampler.wrapU), int(slot.sampler.wrapV)});
  if (isNew) at->second = enlarged(own, size.x, size.y, srgb, slot.sampler.wrapU, slot.sampler.wrapV);
  return &at->second;
}

glm::ivec2 PictureStore::commonSize(std::initializer_list<const Slot*> slots) const {
  glm::ivec2 size(1);
  for (const Slot* slot : slots)
    if (*slot) {
      const Image& image = asset_.pictures[std::size_t(slot->picture)].pixels;
      size = glm::max(size, glm::ivec2(image.width, image.height));
    }
  return size;
}

std::string PictureStore::name(const Slot& slot) const {
  return slot ? asset_.pictures[std::size_t(slot.picture)].name : std::string("-");
}

}  // namespace burnish::scene
