// The ambient lattice as views see it. No GL.
#pragma once
#include <burnish/scene.h>

#include "scene/visibility.h"

namespace burnish::scene {

/// The scene's lattice if it can light: baked, some point of it valid, with finite numbers and as many points as it counts; else nullptr. `report`: where one with points is told why it is left out.
const AmbientGrid* usableGrid(const Scene& scene, Report* report);
/// Whether what the lattice lights (half a cell around its points, and its margin) meets the view.
bool meetsGrid(const AmbientGrid& grid, const ViewFrame& frame);

}  // namespace burnish::scene
