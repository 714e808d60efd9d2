#include "gl/timers.h"

#include <sys/resource.h>

#include <chrono>

namespace burnish::gl {
namespace {

double wallMs() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// User + system time of all threads of the process: a software renderer works on threads of its own.
double processCpuMs() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) { return double(t.tv_sec) * 1e3 + double(t.tv_usec) * 1e-3; };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

}  // namespace

void FrameTimers::beginFrame(Timing timing) {
  if (timing == Timing::Async) collect();
  timing_ = timing;
  current_ = nullptr;
  open_ = false;
  profile_.clear();
  Frame& frame = frames_[std::size_t(next_)];
  if (timing != Timing::Async || frame.pending) return;
  frame.used = 0;
  current_ = &frame;
}

void FrameTimers::begin(std::string_view pass) {
  end();
  if (timing_ == Timing::Profile) {
    device_.gl.Finish();
    profile_.push_back({std::string(pass), 0, 0});
    open_ = true;
    cpuStart_ = processCpuMs();
    wallStart_ = wallMs();
  } else if (current_) {
    if (current_->used == current_->passes.size())
      current_->passes.push_back(
          {{}, Query::create(device_, GL_TIMESTAMP, "pass begins"), Query::create(device_, GL_TIMESTAMP, "pass ends")});
    Pass& p = current_->passes[current_->used];
    p.name = pass;
    p.start.timestamp();
    open_ = true;
  }
}

void FrameTimers::end() {
  if (!open_) return;
  open_ = false;
  if (timing_ == Timing::Profile) {
    device_.gl.Finish();
    profile_.back().gpuMs = wallMs() - wallStart_;
    profile_.back().cpuMs = processCpuMs() - cpuStart_;
  } else if (current_) {
    current_->passes[current_->used++].stop.timestamp();
  }
}

void FrameTimers::endFrame() {
  end();
  if (timing_ == Timing::Profile) latest_ = profile_;
  if (current_) {
    current_->pending = current_->used > 0;
    if (current_->pending) next_ = (next_ + 1) % kFramesInFlight;
    current_ = nullptr;
  }
  timing_ = Timing::Off;
}

void FrameTimers::collect() {
  // Oldest first: queries finish in order, so the first that is not there ends the search.
  for (int i = 0; i < kFramesInFlight; ++i) {
    Frame& frame = frames_[std::size_t((next_ + i) % kFramesInFlight)];
    if (!frame.pending) continue;
    if (!frame.passes[frame.used - 1].stop.available()) return;
    latest_.clear();
    for (std::size_t p = 0; p < frame.used; ++p) {
      const Pass& pass = frame.passes[p];
      const std::uint64_t start = pass.start.result(), stop = pass.stop.result();
      latest_.push_back({pass.name, stop > start ? double(stop - start) * 1e-6 : 0, 0});
    }
    frame.pending = false;
  }
}

}  // namespace burnish::gl
