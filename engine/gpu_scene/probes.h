// Captured places as lighting programs find them: their cubes in one array, and a record of each one in view.
#pragma once
#include <burnish/scene.h>

#include "gl/objects.h"

namespace burnish::gpu_scene {

struct FrameContext;

/// The cubes of a scene's usable probes (scene/probes.h), in their order.
struct GpuProbes {
  gl::Texture cubes;    ///< texels: cd/m² / scale
  float lastLevel = 0;
  float scale = 1;      ///< a power of two, so that half floats hold every texel
};
/// `usable`: not empty.
Result<GpuProbes> uploadProbeCubes(gl::Device& device, const ProbeSet& probes, const std::vector<std::uint32_t>& usable, Report& report);

/// The records of the view's probes (interface/layout.h) into FrameBuffers::probes.
Result<void> uploadProbeRecords(FrameContext& context);
/// Binds the records, and the cubes where the plan reads them.
void bindProbes(FrameContext& context);

}  // namespace burnish::gpu_scene
