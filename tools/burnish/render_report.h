// What `burnish render` measured and found out, for people and as JSON.
#pragma once
#include <burnish/renderer.h>

#include <chrono>
#include <map>

#include "output.h"

namespace cli {

/// Wall time and CPU time (user + system) of the process, from its construction on.
class FrameClock {
 public:
  FrameClock();
  [[nodiscard]] double wallMs() const;
  [[nodiscard]] double cpuMs() const;

 private:
  std::chrono::steady_clock::time_point wall_;
  double cpuMs_;
};

struct Spread {
  double median, p95;  ///< NaN without samples
};
/// Median (mean of the middle two) and 95th percentile (nearest rank).
Spread spreadOf(std::vector<double> samples);

struct RenderReport {
  std::string backend, renderer;
  glm::ivec2 size{0};
  bool profile = false;
  burnish::Quality quality;
  burnish::FramePlan plan;
  std::vector<std::string> warnings;
  float exposureEv = 0;

  /// A measured frame ends now; its pass times are added when there are stats.
  void addFrame(const FrameClock& clock, const burnish::FrameStats* stats);
  void addPassTimes(const burnish::FrameStats& stats);
  void addCounts(const burnish::FrameStats& stats, bool nonfiniteCounted);
  /// GL errors and non-finite pixels are warnings too.
  void warnAboutCounts();
  [[nodiscard]] Json toJson() const;
  void print() const;

 private:
  struct Pass {
    std::string name;
    std::vector<double> gpuMs, cpuMs;
  };
  Pass& pass(const std::string& name);
  struct EffectTime {
    double gpuMs = 0, cpuMs = 0;
  };
  /// Sum of these passes' medians.
  [[nodiscard]] EffectTime timeOf(const std::vector<std::string>& passes) const;

  std::vector<double> frameMs_, frameCpuMs_;
  std::vector<Pass> passes_;  ///< in order of execution
  std::vector<std::string> glErrors_;  ///< each text once
  std::uint64_t glErrorCount_ = 0;
  std::uint64_t textureBytes_ = 0, nonfinitePixels_ = 0, triangles_ = 0;
  int draws_ = 0, lights_ = 0, lightsInView_ = 0;
};

}  // namespace cli
