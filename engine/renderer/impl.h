// What the renderer is made of: devices and caches, the scenes' uploads, and what series of pictures keep from one to the next.
#pragma once
#include <burnish/renderer.h>

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "gl/host_state.h"
#include "gl/timers.h"
#include "gpu_scene/frame.h"
#include "plan/plan.h"
#include "plan/situation.h"
#include "renderer/history.h"
#include "renderer/passes.h"

namespace burnish {

struct ProbeRefresher;

struct SceneState {
  explicit SceneState(gl::Device& device) : gpu(device) {}
  gpu_scene::GpuScene gpu;
  scene::Derived derived;
};

/// What pictures of one kind keep from one to the next. Captures have one of their own: their targets are small, and no picture continues one of theirs.
struct Series {
  static Result<std::unique_ptr<Series>> create(gl::Device& device, gl::ProgramCache& programs, bool linkOnDemand);
  gpu_scene::TargetPool targets;
  gpu_scene::ProgramSet programs;
  Modules modules;
  gl::FrameTimers timers;
  gpu_scene::FrameBuffers buffers;
  FramePlan plan;
  std::vector<plan::Seen> seen;  // of each view
  float preExposure = 1;         // of the view drawn last

 private:
  Series(gl::Device& device, gl::ProgramCache& cache, bool linkOnDemand) : targets(device), programs(device, cache, linkOnDemand), modules(device), timers(device) {}
};

/// The GL state of one call: the host's is saved (HostState::Save) and the engine starts from defaults; at the end, on every path, the host finds what it was promised.
class CallState {
 public:
  CallState(const gl::Device& device, HostState promise) : device_(device) {
    if (promise == HostState::Save)
      guard_.emplace(device);
    else
      gl::setDefaults(device);
    device.gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  }
  ~CallState() {
    if (!guard_) gl::setDefaults(device_);
  }
  CallState(const CallState&) = delete;
  CallState& operator=(const CallState&) = delete;

 private:
  const gl::Device& device_;
  std::optional<gl::HostStateGuard> guard_;
};

struct Renderer::Impl {
  Impl();
  ~Impl();
  RendererOptions options;
  std::unique_ptr<gl::Device> device;
  std::unique_ptr<gl::ProgramCache> programs;
  std::map<std::uint64_t, std::unique_ptr<SceneState>> scenes;
  std::unique_ptr<Series> pictures;
  std::unique_ptr<ProbeRefresher> refresher;  // made by the first refresh
  std::uint64_t refreshes = 0;                // that are in force
  Report report;
  std::size_t reported = 0;
  std::optional<Quality> reportedQuality;
  std::vector<bool> loggedEffects;
  std::map<int, History> histories;  // of pictures, by sequence, while antialiasing over time is on

  SceneState& stateOf(const Scene& scene);
  void logNewWarnings();
  /// Every effect that went on or off since the last picture, with its reason.
  void logEffects();
  /// Says once what the quality asks for and does not get as asked.
  void reportQuality(const Quality& quality);
  /// Light lists hold indices of 16 bits, and a buffer texture all lights and the records of their shadows. The rest is off, on every path alike.
  void boundLights(scene::LightSet& lights, const scene::ShadowSet& shadows);
  PlanOptions planOptions(const Target& target, const RenderRequest& request) const;
  Result<void> checkRequest(const Target& target, std::span<const View> views) const;
  /// What is remembered of the sequence, ready for this frame; nullptr: nothing is, antialiasing over time is off.
  History* historyOf(const Scene& scene, const scene::Derived& derived, std::span<const View> views, const Target& target, const Quality& quality, const RenderRequest& request, const PlanOptions& planned);
  /// What the views see, and the series' plan of it.
  Result<void> look(Series& series, SceneState& state, const Scene& scene, std::span<const View> views, const Target& target, const Quality& quality, const PlanOptions& planned, const History* history);
  Result<void> renderView(Series& series, SceneState& state, const Scene& scene, plan::Seen& view, const gpu_scene::PastFrame& past, const Target& target, const Quality& quality, const RenderRequest& request, FrameStats& stats);
  /// The next face of the refresh at work.
  Result<void> captureFace(const Scene& scene, const ReflectionProbe& probe, const Quality& quality);
  /// Its light takes the place of what the probe had. `layer`: of the probe's cube.
  Result<void> takeRefreshed(const Scene& scene, int layer);
  /// A whole picture, or a capture (no history): CallState is the caller's.
  Result<FrameStats> draw(Series& series, const Scene& scene, std::span<const View> views, const Target& target, const Quality& quality, const RenderRequest& request, const PlanOptions& planned);
};

}  // namespace burnish
