// H23: positions that the lighting pass rebuilds from depth, against where each pixel's ray meets a wall, in double.
#pragma once
#include "gl/device.h"

#include <burnish/renderer.h>

namespace burnish::stability {

struct PositionError {
  double along = 0, total = 0;  ///< largest errors in mm: along the view, and of the point
};
/// A wall turned by 30 degrees, `distance` metres ahead of an eye at `origin`. The engine's own depth is read bit for bit and unprojected in float as shaders/interface/surface.glsl does.
Result<PositionError> positionError(const ProcAddress& getProcAddress, gl::Device& device, Renderer& renderer, double distance, glm::dvec3 origin, bool orthographic);

}  // namespace burnish::stability
