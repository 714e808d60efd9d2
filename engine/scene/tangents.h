// Tangent frames for normal maps.
#pragma once
#include <burnish/scene.h>

namespace burnish::scene {

/// makeTangents for a normal map that is read through `mapping` (its uv set and transform decide where the tangent
/// points). Nothing happens when the uv set or the normals are missing or an index is out of range. Returns how many
/// vertices were added by splitting.
std::size_t makeTangents(Mesh& mesh, const UvMapping& mapping);

}  // namespace burnish::scene
