// What goes into a frame besides the scene, and what comes out of it: the target, the host's depth and drawing, timing, statistics.
#pragma once
#include <burnish/plan.h>

namespace burnish {

/// Depth that the host brings or takes. Texture: 2D DEPTH_COMPONENT*, the target's size.
struct HostDepth {
  unsigned texture = 0;
  float near = 0.1f, far = 1000;  ///< of the host's projection; far 0: infinite
  bool reversed = false;          ///< 1 at the near plane
};

/// What the host's draw callback gets: bound framebuffer (light buffer + depth), matrices, pre-exposure. It may change any GL state that HostState::Save lists.
struct HostDraw {
  unsigned framebuffer = 0;
  glm::mat4 viewProjection{1};  ///< camera-relative world space (world minus eye) to clip space, depth reversed in [0,1]; with antialiasing=temporal it moves by parts of a pixel
  glm::dvec3 eye{0};
  glm::ivec4 viewport{0};
  float exposure = 1;           ///< multiply radiance in cd/m² by this before writing it
};

struct Target {
  unsigned framebuffer = 0;  ///< drawn to; colour attachment 0 (8-bit for Output::Display: the engine encodes sRGB itself)
  glm::ivec2 size{0};
  std::optional<HostDepth> depthIn;   ///< occludes the engine's scene (Target must be written by the host first)
  std::optional<HostDepth> depthOut;  ///< receives the engine's depth
};

enum class TimingMode : std::uint8_t { Off, Async, Profile };  ///< Profile finishes between passes: right on software renderers, slow on others

struct PassTime {
  std::string name;
  double gpuMs = 0, cpuMs = 0;  ///< cpuMs: user + system time of the process between the pass's ends; only with Profile
};
struct FrameStats {
  std::vector<PassTime> passes;  ///< of the latest frame whose queries have arrived (Async: some frames ago)
  int draws = 0, lightsInView = 0, lights = 0;
  std::uint64_t triangles = 0;
  int shadowMapsDrawn = 0, shadowMapsKept = 0;          ///< drawn in this frame; still right from an earlier one
  int shadowDraws = 0;                                  ///< calls that drew casters into them
  std::uint64_t uploadedBytes = 0, pendingUploads = 0;  ///< pending: resources still waiting for their turn
  std::uint64_t textureBytes = 0;                       ///< all textures and targets alive
  std::uint64_t nonfinitePixels = 0;                    ///< in the light buffer; only with RenderRequest::countNonfinite
  std::vector<std::string> glErrors;                    ///< debug messages of type error and glGetError's
  float exposureEv = 0;                                 ///< EV100 that the picture was developed with; automatic exposure: only with RenderRequest::countNonfinite, else 0
};

struct RenderRequest {
  Output output = Output::Display;
  DebugView debugView = DebugView::Final;
  TimingMode timing = TimingMode::Off;
  bool countNonfinite = false;  ///< waits for the GPU; with automatic exposure it reads FrameStats::exposureEv too
  /// Which pictures this one follows: antialiasing=temporal keeps a history for each number, and in it one for each view in order. Calls that take turns (two windows, a mirror) give
  /// each its own.
  int sequence = 0;
  std::function<void(const HostDraw&)> hostDraw;  ///< called after lighting, before tone mapping, once per view
};

}  // namespace burnish
