// Lattices made for tests and looked up on the CPU: engine/stability/lattice.h.
#pragma once
#include "stability/lattice.h"

namespace burnish::test {

using stability::distanceTo;
using stability::fillGrid;
using stability::gridIn;
using stability::GridLight;
using stability::GridSampler;
using stability::roomOf;
using stability::Solid;

}  // namespace burnish::test
