// How a lobe is summed over grids of points: in parts, each over the coarsest grid that carries it.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "prefilter/lobe.h"

namespace burnish::gpu_scene {

/// Points of a cube's faces: `size` texels along an edge, `beyond` points past each edge (so that a face needs nothing of its neighbours), `side` = size + 2 beyond points along a side.
/// The six faces lie side by side from (x, y) of the atlas on.
struct CubeGrid {
  int size = 0, beyond = 0, side = 0;
  int x = 0, y = 0;
};

/// A part of a lobe as the shader reads it (shaders/prefilter/lobe.frag).
struct CubeLobePart {
  glm::ivec4 grid{0};                ///< size, beyond, side, x
  glm::vec4 support{0};              ///< x = 1 - l·R from which there is nothing; cosine² and sine of that angle; y of the grid
  glm::vec4 shape{0};                ///< GGX: slope; x under which the inner polynomial is the value; x under which the outer one is subtracted
  std::array<float, 8> inner{};      ///< degree 6, by x (Blinn-Phong, the exponent of 2) or by x - shape.y
  std::array<float, 8> outer{};      ///< by x - shape.z
};

static_assert(sizeof(CubeLobePart) == 7 * 16);  // std140's

/// What the error is traded against time with.
struct CubeFilterEffort {
  double fineness = 1.5;  ///< points of a grid within the lobe's width (the deviation of a Gaussian as sharp as its peak); the source itself where no grid is fine enough
  double far = 4e-4;      ///< GGX: error over the peak that the next grid may add beyond a part's radius, which is chosen for it
  double tail = 1e-4;     ///< Blinn-Phong: share of the lobe's integral that is cut off
  int horizon = 64;       ///< texels along the edge of the grid for lobes that the horizon cuts off while they are high; half of them where it does so under a quarter of the peak
};

/// At most kMostCubeParts parts; their sum is the lobe but for what effort.tail leaves out. `grids`: the finest first.
inline constexpr int kMostCubeParts = 8;
std::vector<CubeLobePart> cubeLobeParts(const prefilter::Lobe& lobe, const std::vector<CubeGrid>& grids, const CubeFilterEffort& effort);

/// Points that the parts are summed over for one texel, about.
double pointsSummed(const std::vector<CubeLobePart>& parts);

}  // namespace burnish::gpu_scene
