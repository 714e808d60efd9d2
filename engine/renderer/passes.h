// What the names of a plan's passes run: one row a pass.
#pragma once
#include <memory>

#include "gbuffer/motion_pass.h"
#include "gl/timers.h"
#include "gpu_scene/frame.h"
#include "lighting/lighting_pass.h"
#include "shadow/shadow_pass.h"
#include "transparency/transparent_pass.h"

namespace burnish {

/// What passes keep between frames. Each is made when a plan first lists a pass that needs it.
class Modules {
 public:
  explicit Modules(gl::Device& device) : device_(device) {}
  lighting::LightingPass& lighting();
  transparency::TransparentPass& transparent();
  shadow::ShadowPass& shadows();
  gbuffer::MotionPass& motion();

 private:
  gl::Device& device_;
  std::unique_ptr<lighting::LightingPass> lighting_;
  std::unique_ptr<transparency::TransparentPass> transparent_;
  std::unique_ptr<shadow::ShadowPass> shadows_;
  std::unique_ptr<gbuffer::MotionPass> motion_;
};

struct PassCall {
  gpu_scene::FrameContext& c;
  Modules& modules;
  const Target& target;
  const RenderRequest& request;
};
/// Runs one pass of the plan, timed and in a debug group of its name.
Result<void> runPass(const PassPlan& pass, PassCall& call, gl::FrameTimers& timers);

}  // namespace burnish
