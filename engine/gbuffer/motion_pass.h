// Pass "motion_vectors": where what moved stood in the frame before. Drawn only while antialiasing over time is on and something in view moved.
#pragma once
#include "gpu_scene/frame.h"

namespace burnish::gbuffer {

class MotionPass {
 public:
  explicit MotionPass(gl::Device& device);
  /// Clears the target "velocity" and draws those instances into it that moved, where they are what is seen.
  Result<void> draw(gpu_scene::FrameContext& context);

 private:
  gl::VertexArray array_;
};

}  // namespace burnish::gbuffer
