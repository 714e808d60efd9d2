// Pass "bloom": light that scatters in the lens. The pass "tonemap" mixes it in.
#pragma once
#include "gpu_scene/frame.h"

namespace burnish::post {

/// Fills the target "bloom": its level 0 holds the view's light as the lens would spread it, at half the resolution, from texel (0, 0) on.
Result<void> scatter(gpu_scene::FrameContext& context);
/// Share of the light that is replaced by the target's: Quality::bloomShare, less what would spread within a pixel.
float scatteredShare(const gpu_scene::FrameContext& context);
/// Texels of a level that belong to the view.
glm::ivec2 scatteredSize(const gpu_scene::FrameContext& context, int level);

}  // namespace burnish::post
