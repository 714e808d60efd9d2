// Tangent frames for normal maps.
#pragma once
#include <burnish/scene.h>

namespace burnish::scene {

/// makeTangents for a normal map that is read through `mapping` (its uv set and transform decide where the tangent
/// points). Nothing happens when the uv set or the normals are missing or an index is out of range. Returns how many
/// vertices were added by splitting.
std::size_t makeTangents(Mesh& mesh, const UvMapping& mapping);

/// The mesh as it is drawn: validated, with tangents where they are asked for and can be made (which may split vertices).
Result<Mesh> preparedMesh(const Mesh& mesh, bool tangents, Report& report);

}  // namespace burnish::scene
