// Times of passes: asynchronously through timestamp queries, or exactly by finishing between passes.
#pragma once
#include "gl/objects.h"

namespace burnish::gl {

enum class Timing : std::uint8_t {
  Off,
  Async,    ///< GPU timestamps, collected some frames later without waiting. On llvmpipe right only where the next pass
            ///< binds another framebuffer.
  Profile,  ///< glFinish around every pass; gpuMs is wall time, cpuMs the process's user + system time
};
struct PassSample {
  std::string name;
  double gpuMs = 0, cpuMs = 0;  ///< cpuMs: Profile only
};

/// Passes may not nest. begin/end outside a frame, and everything with Timing::Off, do nothing and make no GL call.
class FrameTimers {
 public:
  static constexpr int kFramesInFlight = 6;
  explicit FrameTimers(Device& device) : device_(device) {}
  /// Also collects what has arrived. A frame for which no slot is free (the GPU is kFramesInFlight behind) goes
  /// unmeasured.
  void beginFrame(Timing timing);
  void begin(std::string_view pass);
  void end();
  void endFrame();
  /// Passes of the newest frame whose times are all there, in order; empty before the first.
  [[nodiscard]] const std::vector<PassSample>& latest() const { return latest_; }

 private:
  struct Pass {
    std::string name;
    Query start, stop;
  };
  struct Frame {
    std::vector<Pass> passes;  // queries are kept and used again
    std::size_t used = 0;
    bool pending = false;
  };
  void collect();

  Device& device_;
  Timing timing_ = Timing::Off;
  std::array<Frame, kFramesInFlight> frames_;
  int next_ = 0;              // slot of the next frame
  Frame* current_ = nullptr;  // Async, measured frame
  bool open_ = false;         // between begin and end
  std::vector<PassSample> profile_, latest_;
  double wallStart_ = 0, cpuStart_ = 0;
};

/// Measures for the scope of a pass.
class PassTimer {
 public:
  PassTimer(FrameTimers& timers, std::string_view pass) : timers_(timers) { timers_.begin(pass); }
  ~PassTimer() { timers_.end(); }
  PassTimer(const PassTimer&) = delete;
  PassTimer& operator=(const PassTimer&) = delete;

 private:
  FrameTimers& timers_;
};

}  // namespace burnish::gl
