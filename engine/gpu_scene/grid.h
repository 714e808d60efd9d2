// The ambient lattice as lighting programs find it: harmonics and planes of its points, and where it lies.
#pragma once
#include <burnish/scene.h>

#include <cstdint>
#include <vector>

#include "gl/objects.h"

namespace burnish::gpu_scene {

struct FrameContext;

struct GpuGrid {
  gl::TextureBuffer light, planes;  ///< interface/grid.glsl
  float luminance = 0;              ///< of the brightest point, on the mean over directions
  float scale = 1;                  ///< what the half floats of `light` are multiplied by, a power of two; cd/m²
};

/// A point's harmonics, divided by `scale`, as pairs of half floats. Numbers that are not finite are 0.
std::vector<std::uint32_t> packedLight(const AmbientGrid::Point& point, float scale);
/// The least power of two that keeps every coefficient of the lattice in half floats.
float lightScale(const AmbientGrid& grid);

/// `grid`: usable (scene/grid.h).
Result<GpuGrid> uploadGrid(gl::Device& device, const AmbientGrid& grid, Report& report);
/// Where the lattice lies for this view, into FrameBuffers::grid.
Result<void> uploadGridData(FrameContext& context);
/// Binds it where the plan reads it.
void bindGrid(FrameContext& context);

}  // namespace burnish::gpu_scene
