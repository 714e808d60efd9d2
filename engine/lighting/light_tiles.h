// Which lights reach which tiles: lists for tiles of 16 x 16 pixels, bounded by the depth of what is in them. No GL; everything relative to the eye.
#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "interface/limits.h"
#include "lighting/tile_surfaces.h"
#include "plan/variants.h"
#include "scene/visibility.h"

namespace burnish::lighting {

/// Depth of the nearest and farthest surface of a tile, as stored (reversed); far < 0: nothing is drawn there. A tile that shows a near and a far thing is mostly
/// empty between them, so its range is split in the middle of its distances ("Half-Z", Stewart 2015, "Compute-based tiled culling"): nearEnd is the
/// last depth of the near half, farBegin the first of the far half. nearEnd is negated where the tile shows the background beside surfaces.
struct TileDepth {
  float near = 0, nearEnd = 0, farBegin = 0, far = -1;
  [[nodiscard]] bool showsBackground() const { return far < 0 || nearEnd < 0; }
};
/// From a depth buffer: rows bottom to top, `stride` floats a row, the viewport's lower left texel first. Texels of value 0 hold nothing.
/// `depthParams` as ViewFrame's.
void reduceDepth(const float* depth, int stride, int width, int height, glm::dvec2 depthParams, bool orthographic, std::vector<TileDepth>& out);

/// One tile as the vertex shader reads it: x, y, first entry in the lists, number of entries (padding included) + 65536 · those that cast shadows (plan::kLoopShadows alone).
using TileVertex = glm::ivec4;
/// Tiles that are shaded by one program: lists of `bucket` lights (plan::kTileBuckets), plan::kLoop, kLoopSpots or kLoopShadows. A program that few tiles call for draws none: another that is drawn
/// anyway, and is right for them too, takes them.
struct TileGroup {
  int bucket = 0;
  int first = 0, count = 0;  ///< in tiles
  plan::Places places = plan::Places::None;  ///< that may light them
  plan::Details details{false, false};  ///< of what the tiles may show: either reads the target of details (plan::kDetailBuckets)
};
/// A box along the world's axes, relative to the eye (middle and half extents) around a surface with details.
struct DetailBox {
  glm::vec3 center{0}, extent{0};
  plan::Details details;
};
/// An oriented box, relative to the eye, that lights what lies in it or within `margin` of it.
struct ProbeBox {
  glm::dvec3 center{0}, halfSize{0};
  glm::dmat3 axes{1};  ///< columns
  double margin = 0;
};
/// Probes of a tile, smaller boxes before larger ones: indices; -1 where the list ends.
using TileProbes = glm::vec<MAX_TILE_PROBES, std::int16_t>;
struct TileLists {
  std::vector<TileVertex> tiles;        ///< those with something to light, grouped; then those that show the background
  std::vector<TileGroup> groups;        ///< none empty
  std::vector<std::uint16_t> entries;   ///< light index + 1; 0 is the black light that pads
  std::vector<TileProbes> probes;       ///< of each of `tiles` that has something to light; none without probes
  int crowded = 0, mostProbes = 0;      ///< tiles that more probes meet than a list holds; the most that meet one
  TileGroup background;                 ///< of `tiles`
  int lightsInView = 0;
};

class TileCuller {
 public:
  /// No false negatives: every light whose sphere (and cone) touches a surface between the tile's depths is listed. Lights past 65534 are left out by the caller.
  /// `shadowed`: so many of the first lights cast shadows. `details`: around brushed and rough surfaces; tiles that may show one go into groups of their own.
  /// `probes`: smaller boxes before larger ones; each tile lists the first MAX_TILE_PROBES that meet what it shows. nullptr: no lists.
  /// `surfaces`: asked for where lights are many enough to pay for it; those that reach no pixel of a tile from its front are not listed for it then.
  const TileLists& cull(const scene::ViewFrame& view, std::span<const TileDepth> depths, std::span<const scene::LocalLight> lights, std::size_t shadowed = 0, std::span<const DetailBox> details = {},
                        const std::function<TileSurfaces*()>& surfaces = {}, const std::vector<ProbeBox>* probes = nullptr);

 private:
  struct Pair {
    std::uint32_t tile;
    std::uint16_t light;
  };
  void boundTiles(const scene::ViewFrame& view, std::span<const TileDepth> depths);
  void cullLight(const scene::ViewFrame& view, const scene::LocalLight& light, std::uint16_t index);
  void markDetail(const scene::ViewFrame& view, const DetailBox& box);
  void findProbes(const scene::ViewFrame& view, const std::vector<ProbeBox>& probes);
  void markProbe(const scene::ViewFrame& view, const ProbeBox& box, std::int16_t index);
  void sortPairs();
  void keepReached(std::span<const scene::LocalLight> lights, TileSurfaces& surfaces);
  void choosePrograms(std::span<const scene::LocalLight> lights, std::size_t shadowed);
  void buildLists(std::size_t lights);
  void listBackground(std::span<const TileDepth> depths);

  int columns_ = 0, rows_ = 0;
  double near_ = 0;
  // Bounds of each tile's two slices in eye space (right, up, forward).
  struct Box {
    float minX, maxX, minY, maxY, minZ, maxZ;
  };
  // What eight corners in eye space span: a box, and the tiles that it may touch (none where it is behind the near plane).
  struct Spanned {
    glm::dvec3 low{1e300}, high{-1e300};
    int tx0 = 0, tx1 = -1, ty0 = 0, ty1 = -1;
  };
  [[nodiscard]] Spanned spanOf(const scene::ViewFrame& view, const std::array<glm::dvec3, 8>& corners) const;
  std::vector<std::array<Box, 2>> boxes_;
  std::vector<std::uint8_t> slices_;  // 0: nothing is drawn, 1, 2
  std::vector<std::uint8_t> detail_;  // of each tile: kBrushed, kRough
  std::vector<TileProbes> probes_;    // of each tile
  std::vector<std::uint16_t> probeCounts_;  // that meet it
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> counts_, offsets_;
  // What shades a tile, in the order in which programs are drawn.
  struct TileProgram {
    plan::Places places = plan::Places::None;
    std::uint8_t detail = 0;
    int list = 0;  // index of the kind of list
    friend auto operator<=>(const TileProgram&, const TileProgram&) = default;
  };
  std::vector<TileProgram> programs_;    // of each tile
  std::vector<std::uint16_t> shadowed_;  // lights of each tile that cast shadows
  std::vector<std::uint16_t> sorted_;
  TileLists lists_;
};

}  // namespace burnish::lighting
