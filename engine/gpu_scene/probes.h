// Captured places as lighting programs find them: their cubes in one array, and a record of each one in view.
#pragma once
#include <burnish/scene.h>

#include <array>
#include <cstdint>
#include <vector>

#include "gl/objects.h"

namespace burnish::gpu_scene {

struct FrameContext;

/// The cubes of a scene's usable probes (scene/probes.h), in their order.
struct GpuProbes {
  struct Light {
    float scale = 1;  ///< of the cube's texels, which are cd/m² / scale: a power of two, so that half floats hold them
    std::array<glm::vec3, 9> irradiance{};  ///< over π, cd/m²
  };
  std::vector<Light> lights;  ///< layer by layer
  gl::Texture cubes;          ///< empty: nothing looks reflections up
  float lastLevel = 0;
};
/// `usable`: not empty.
Result<GpuProbes> uploadProbes(gl::Device& device, const ProbeSet& probes, const std::vector<std::uint32_t>& usable, bool cubes, Report& report);

/// The records of the view's probes (interface/layout.h) into FrameBuffers::probes.
Result<void> uploadProbeRecords(FrameContext& context);
/// Binds the records, and the cubes where the plan reads them.
void bindProbes(FrameContext& context);

}  // namespace burnish::gpu_scene
