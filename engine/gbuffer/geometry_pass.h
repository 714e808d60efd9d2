// The passes that draw geometry: G-buffer, emission, picking.
#pragma once
#include "gpu_scene/frame.h"
#include "plan/variants.h"

namespace burnish::gbuffer {

/// Pass "gbuffer": clears depth (unless the host's is in it) and fills the G-buffer with the visible instances, nearest first.
Result<void> drawGBuffer(gpu_scene::FrameContext& context);
/// Pass "forward": draws and shades in one, with what LightingPass::bindForward bound.
Result<void> drawForward(gpu_scene::FrameContext& context);
/// Pass "emissive": adds emission to the light buffer where an emissive surface is the visible one; unlit surfaces replace what is there.
Result<void> drawEmissive(gpu_scene::FrameContext& context);
/// Draws instance indices + 1 into the bound R32UI framebuffer with depth. The context's plan lists the pick programs.
Result<void> drawPick(gpu_scene::FrameContext& context);

}  // namespace burnish::gbuffer
