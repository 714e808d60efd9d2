// Transparent instances of one view: what they are, which lie behind which, and which must be sorted per pixel.
#pragma once
#include "scene/visibility.h"

namespace burnish::scene {

/// Lets light from behind through: it is glass, or it is blended.
inline bool isGlass(const Material& m) { return m.transmission > 0 && !m.unlit; }
inline bool isTransparent(const Material& m) { return m.blend || isGlass(m); }
/// Glass that shows what is behind it shifted or blurred and so reads a copy of the picture; clear thin panes only tint.
bool refracts(const Material& m);
/// Refracting glass whose picture of what is behind may be blurred or made smaller: the copy needs mip levels.
bool blurs(const Material& m, MeshShape shape);

enum class Faces : std::uint8_t { Material, Front, Back };  ///< Material: as the material says

struct TransparentPart {
  std::uint32_t instance = 0;  ///< index into the view's instances
  Faces faces = Faces::Material;
  bool refracts = false, blurs = false;
};
/// Parts that are drawn together. Groups come farthest first.
struct TransparentGroup {
  std::vector<TransparentPart> parts;  ///< in the order in which they are drawn when nothing is peeled
  glm::ivec4 rect{0};                  ///< pixels of the target that they may touch: x, y, width, height, within the viewport
  bool peel = false;                   ///< their surfaces may lie in any order from pixel to pixel
  int layers = 1;                      ///< that a pixel can have at most; 0: not known
};

/// Orders the transparent ones among `instances`. Two instances are in order when their rectangles on the screen are apart, or when a plane keeps them apart; those that are not,
/// and meshes that may overlap themselves, are peeled.
std::vector<TransparentGroup> orderTransparent(const Scene& scene, const Derived& derived, const ViewFrame& frame, const std::vector<VisibleInstance>& instances);

}  // namespace burnish::scene
