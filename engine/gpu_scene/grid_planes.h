// What a lattice point sees, as planes: one for each texel of its map of distances (shaders/shading/grid.h).
#pragma once
#include <burnish/scene.h>

#include <glm/glm.hpp>
#include <vector>

namespace burnish::gpu_scene {

/// xyz: normal over distance, 1/m, in the axes of the world; w: 1 over the depth behind it, in units of its distance, over which light ends. kDistanceSize² of them, in the order of `distances`.
/// A point without its map sees everything as far as `limit` (metres); one that is not valid sees nothing.
std::vector<glm::dvec4> planesOf(const AmbientGrid::Point& point, double limit);

}  // namespace burnish::gpu_scene
