// World matrices of whole node tables in one pass.
#pragma once
#include <burnish/scene.h>

#include <vector>

namespace burnish::scene {

/// world(node) for every row, by index (identity for free rows), in time linear in the number of nodes however deep the
/// hierarchy is. Non-finite locals count as identity; a cycle is cut at the node of it that is met first in order of
/// index.
std::vector<glm::dmat4> worldMatrices(const Scene& scene);

/// Whether every element is finite.
bool finite(const glm::dmat4& m);

}  // namespace burnish::scene
