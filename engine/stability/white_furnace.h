// H29: balls of several paints in a white furnace, each pixel held against the directional albedo of its rungs by quadrature in double.
#pragma once
#include <burnish/plan.h>

#include <functional>
#include <span>

namespace burnish::stability {

struct FurnacePaint {
  double substance, albedo;
};
/// A scene's linear picture of that size, rows from the top.
using DrawLinear = std::function<Result<Image>(const Scene&, const View&, glm::ivec2, const Quality&)>;

struct FurnaceRow {
  std::span<const FurnacePaint> paints;
  std::span<const double> roughness;
  int cell = 32;       ///< pixels a ball
  double white = 700;  ///< cd/m² that come from everywhere
};
struct FurnaceFound {
  double worst = 0;  ///< largest relative error against the albedo, with its sign
  double unity = 0;  ///< largest distance from 1 of white paints whose substance is no mix, with its sign
  int pixels = 0, off = 0;  ///< off: by more than 2 %
  std::string where;
};
/// `light` brings the white light into the scene: surroundings, or a place that holds them. Orthographic, a ball of each paint and roughness.
Result<FurnaceFound> whiteFurnace(const DrawLinear& draw, const FurnaceRow& row, const Quality& quality, const std::function<void(Scene&)>& light);

}  // namespace burnish::stability
