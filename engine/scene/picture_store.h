// The pictures of an asset as map builders want them: RGBA8, enlarged to a partner's size where a merge needs it. Each
// is made once.
#pragma once
#include <burnish/scene.h>

#include <initializer_list>
#include <map>
#include <string>
#include <tuple>

#include "asset/asset.h"

namespace burnish::scene {

/// A glTF texture reference, resolved: which picture, read how. Empty when there is none or it could not be decoded.
struct Slot {
  int picture = -1;
  Sampler sampler;
  UvMapping mapping;
  [[nodiscard]] explicit operator bool() const { return picture >= 0; }
  /// Whether one fetch can serve both.
  [[nodiscard]] bool compatible(const Slot& other) const {
    return sampler == other.sampler && mapping == other.mapping;
  }
};

/// KHR_texture_transform as a matrix on (u, v, 1).
UvMapping mappingOf(const asset::TextureRef& ref);

/// A sampler as part of a cache key.
std::string keyOf(const Sampler& sampler);

class PictureStore {
 public:
  /// The asset must outlive the store.
  explicit PictureStore(const asset::Asset& asset) : asset_(asset) {}

  [[nodiscard]] Slot slot(const asset::TextureRef& ref) const;
  /// RGBA8 in its own size.
  const Image& rgba(const Slot& slot);
  /// RGBA8 in `size`; nullptr for an empty slot.
  const Image* sized(const Slot& slot, glm::ivec2 size, bool srgb);
  /// The larger width and height of the slots that are not empty; 1x1 without any.
  [[nodiscard]] glm::ivec2 commonSize(std::initializer_list<const Slot*> slots) const;
  /// The file's own channel count (a picture without alpha has no opacity to offer).
  [[nodiscard]] int channels(const Slot& slot) const {
    return slot ? asset_.pictures[std::size_t(slot.picture)].pixels.channels : 0;
  }
  [[nodiscard]] std::string name(const Slot& slot) const;

 private:
  const asset::Asset& asset_;
  std::map<int, Image> expanded_;
  std::map<std::tuple<int, int, int, bool, int, int>, Image> enlarged_;
};

}  // namespace burnish::scene
