// The passes after lighting: "exposure", "tonemap", "edge_antialiasing", "debug_view", "nonfinite_count", and the host's depth in and out.
#pragma once
#include "gpu_scene/frame.h"

namespace burnish::post {

Result<void> measureExposure(gpu_scene::FrameContext& context);
/// EV100 that measureExposure found. Waits for the GPU.
float readExposure(gpu_scene::FrameContext& context);
/// Develops the light buffer into `framebuffer` (the target's), or into the target "display" where the plan has one.
Result<void> drawTonemap(gpu_scene::FrameContext& context, GLuint framebuffer);
/// From "display" into `framebuffer`.
Result<void> smoothEdges(gpu_scene::FrameContext& context, GLuint framebuffer);
/// Views of the G-buffer and of non-finite values.
Result<void> drawDebugView(gpu_scene::FrameContext& context, GLuint framebuffer);
/// Pixels of the view's rectangle whose radiance is not finite. Waits for the GPU.
std::uint64_t countNonfinite(gpu_scene::FrameContext& context);
Result<void> takeHostDepth(gpu_scene::FrameContext& context, const HostDepth& host);
Result<void> giveHostDepth(gpu_scene::FrameContext& context, const HostDepth& host);

}  // namespace burnish::post
