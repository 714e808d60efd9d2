// What a shadow map shows, as a number: the same number, the same picture.
#pragma once
#include "scene/shadows.h"

namespace burnish::scene {

/// Of the map's place and of all its casters. `resolution`: texels along a side.
std::uint64_t contentOf(const Scene& scene, const ShadowMap& map, std::vector<ShadowCaster>& casters, int resolution);

}  // namespace burnish::scene
