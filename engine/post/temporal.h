// Pass "temporal_antialiasing": this frame's samples join the mean of those before (docs/antialiasing.md).
#pragma once
#include "gpu_scene/frame.h"

namespace burnish::post {

/// Reads the light buffer and the history, writes the other history; FrameContext::picture is that one from then on.
Result<void> joinHistory(gpu_scene::FrameContext& context);

}  // namespace burnish::post
