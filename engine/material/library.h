// What the library of substances offers inside the engine; the rest is burnish/material.h.
#pragma once
#include <string_view>

namespace burnish::material {

/// The name or alias that comes nearest to one that findSubstance does not know, for messages; empty when none is near.
std::string_view nearestSubstance(std::string_view name);

}  // namespace burnish::material
