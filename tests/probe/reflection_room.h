// Rooms whose light is known in closed form: engine/stability/rooms.h.
#pragma once
#include "render/scenes.h"
#include "stability/rooms.h"

namespace burnish::test {

using stability::boxed;
using stability::constantProbe;
using stability::Paint;
using stability::paintedCube;
using stability::setProbes;
using stability::turned;
using stability::WallHit;
using stability::wallHit;

inline ReflectionProbe bakedFrom(const CubeLevel& level, int size) {
  auto p = stability::bakedFrom(level, size);
  if (!p) FAIL(p.error().message());
  return std::move(*p);
}

}  // namespace burnish::test
