// Culling and winding of what is drawn.
#pragma once
#include "gl/objects.h"

namespace burnish::gbuffer {

/// Sets face culling and winding only when they change.
class RasterState {
 public:
  explicit RasterState(const GladGLContext& gl) : gl_(gl) {
    gl_.Enable(GL_CULL_FACE);
    gl_.FrontFace(GL_CCW);
  }
  // A mirrored instance may come last: the screen triangles of the passes that follow must not be culled.
  ~RasterState() {
    gl_.Disable(GL_CULL_FACE);
    gl_.FrontFace(GL_CCW);
  }
  RasterState(const RasterState&) = delete;
  RasterState& operator=(const RasterState&) = delete;
  void set(bool twoSided, bool flipped) {
    if (twoSided != twoSided_) twoSided ? gl_.Disable(GL_CULL_FACE) : gl_.Enable(GL_CULL_FACE);
    if (flipped != flipped_) gl_.FrontFace(flipped ? GL_CW : GL_CCW);
    twoSided_ = twoSided;
    flipped_ = flipped;
  }

 private:
  const GladGLContext& gl_;
  bool twoSided_ = false, flipped_ = false;
};

}  // namespace burnish::gbuffer
