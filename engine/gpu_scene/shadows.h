// Shadows as lighting programs find them: the uniform block of directional lights, the records of point and spot lights, the maps bound twice.
#pragma once
#include <vector>

#include "gl/objects.h"
#include "scene/shadows.h"

namespace burnish::gpu_scene {

struct FrameContext;

struct ShadowBindings {
  gl::Buffer data;               ///< ShadowData
  gl::Sampler compared, depths;  ///< of the same texture: filtered comparisons, and single depths
};

/// The uniform block of the view's shadows, once its maps have their layers. Makes the bindings on first use.
Result<void> uploadShadows(FrameContext& context);
/// Binds the block and the maps; nothing where the plan has no shadows.
void bindShadows(FrameContext& context);
/// Record of a point or spot light's shadow: SHADOW_TEXELS texels (interface/layout.h).
std::vector<glm::vec4> shadowRecord(const scene::ShadowSet& set, const scene::LocalShadow& shadow, glm::dvec3 eye);

}  // namespace burnish::gpu_scene
