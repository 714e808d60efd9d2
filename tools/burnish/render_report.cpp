#include "render_report.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "messages.h"
#include "plan_text.h"

namespace cli {
namespace {

double processCpuMs() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) { return double(t.tv_sec) * 1e3 + double(t.tv_usec) * 1e-3; };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

Json toJson(const Spread& spread) { return {{"median", spread.median}, {"p95", spread.p95}}; }

std::string shownMs(double ms) { return std::isfinite(ms) ? fmt::format("{:.2f}", ms) : "-"; }

}  // namespace

FrameClock::FrameClock() : wall_(std::chrono::steady_clock::now()), cpuMs_(processCpuMs()) {}
double FrameClock::wallMs() const { return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - wall_).count(); }
double FrameClock::cpuMs() const { return processCpuMs() - cpuMs_; }

Spread spreadOf(std::vector<double> samples) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (samples.empty()) return {kNone, kNone};
  std::sort(samples.begin(), samples.end());
  const std::size_t n = samples.size(), rank = std::size_t(std::ceil(0.95 * double(n)));
  return {(samples[(n - 1) / 2] + samples[n / 2]) / 2, samples[std::max<std::size_t>(rank, 1) - 1]};
}

RenderReport::Pass& RenderReport::pass(const std::string& name) {
  const auto found = std::find_if(passes_.begin(), passes_.end(), [&](const Pass& p) { return p.name == name; });
  return found != passes_.end() ? *found : passes_.emplace_back(Pass{name, {}, {}});
}

void RenderReport::addFrame(const FrameClock& clock, const burnish::FrameStats* stats) {
  frameMs_.push_back(clock.wallMs());
  frameCpuMs_.push_back(clock.cpuMs());
  if (stats) addPassTimes(*stats);
}

void RenderReport::addPassTimes(const burnish::FrameStats& stats) {
  for (const burnish::PassTime& time : stats.passes) {
    Pass& p = pass(time.name);
    p.gpuMs.push_back(time.gpuMs);
    if (profile) p.cpuMs.push_back(time.cpuMs);
  }
}

void RenderReport::addCounts(const burnish::FrameStats& stats, bool nonfiniteCounted) {
  if (nonfiniteCounted) nonfinitePixels_ = stats.nonfinitePixels;
  for (const std::string& text : stats.glErrors) {
    ++glErrorCount_;
    if (std::find(glErrors_.begin(), glErrors_.end(), text) == glErrors_.end()) glErrors_.push_back(text);
  }
  textureBytes_ = stats.textureBytes;
  triangles_ = stats.triangles;
  draws_ = stats.draws;
  lights_ = stats.lights;
  lightsInView_ = stats.lightsInView;
  if (nonfiniteCounted || stats.exposureEv != 0) exposureEv = stats.exposureEv;
}

void RenderReport::warnAboutCounts() {
  if (nonfinitePixels_ > 0) warnings.push_back(fmt::format("{} pixels were not finite; --view nonfinite shows where", nonfinitePixels_));
  for (const std::string& text : glErrors_) warnings.push_back("OpenGL: " + text);
}

RenderReport::EffectTime RenderReport::timeOf(const std::vector<std::string>& passes) const {
  EffectTime time;
  for (const Pass& p : passes_) {
    if (std::find(passes.begin(), passes.end(), p.name) == passes.end()) continue;
    time.gpuMs += spreadOf(p.gpuMs).median;
    time.cpuMs += spreadOf(p.cpuMs).median;
  }
  return time;
}

Json RenderReport::toJson() const {
  Json out;
  out["schema_version"] = 1;
  out["backend"] = backend;
  out["renderer"] = renderer;
  out["size"] = {size.x, size.y};
  out["frames"] = frameMs_.size();
  out["timing_mode"] = profile ? "profile" : "async";
  out["frame_ms"] = cli::toJson(spreadOf(frameMs_));
  out["frame_cpu_ms"] = cli::toJson(spreadOf(frameCpuMs_));
  out["passes"] = Json::array();
  for (const Pass& p : passes_)
    out["passes"].push_back({{"name", p.name}, {"gpu_ms", cli::toJson(spreadOf(p.gpuMs))}, {"cpu_ms", cli::toJson(spreadOf(p.cpuMs))}});
  out["effects"] = Json::array();
  for (const burnish::EffectPlan& effect : plan.effects)
    if (effect.on) out["effects"].push_back(effect.name);
  out["programs"] = Json::array();
  for (const burnish::ProgramPlan& program : plan.programs) out["programs"].push_back(program.name);
  out["plan"] = planJson(plan);
  for (Json& effect : out["plan"]["effects"]) {
    const EffectTime time = timeOf(effect["passes"].get<std::vector<std::string>>());
    effect["gpu_ms"] = time.gpuMs;
    effect["cpu_ms"] = time.cpuMs;
  }
  out["gbuffer_bytes_per_pixel"] = plan.gbufferBytesPerPixel;
  out["texture_bytes"] = textureBytes_;
  out["nonfinite_pixels"] = nonfinitePixels_;
  out["gl_errors"] = glErrorCount_;
  out["warnings"] = warnings;
  out["rungs"] = Json::object();
  for (std::size_t t = 0; t < burnish::terms().size(); ++t) out["rungs"][std::string(burnish::terms()[t].name)] = burnish::terms()[t].rungs[burnish::rungOf(quality, t)].name;
  return out;
}

void RenderReport::print() const {
  fmt::print("{} on {}; {} draws, {} triangles, {} of {} lights in view, {:.1f} MB of textures\n", renderer, backend, draws_, triangles_, lightsInView_, lights_,
             double(textureBytes_) / 1e6);
  if (frameMs_.empty()) return;
  const Spread wall = spreadOf(frameMs_), cpu = spreadOf(frameCpuMs_);
  fmt::print("{} frame{}, {}\n", frameMs_.size(), frameMs_.size() == 1 ? "" : "s",
             profile ? "profiled: finished between passes" : "timer queries (--profile gives right per-pass times on software renderers)");
  fmt::print("  {:<20} {:>10} {:>10} {:>10} {:>10}\n", "ms", "median", "p95", "CPU", "CPU p95");
  fmt::print("  {:<20} {:>10} {:>10} {:>10} {:>10}\n", "frame", shownMs(wall.median), shownMs(wall.p95), shownMs(cpu.median), shownMs(cpu.p95));
  for (const Pass& p : passes_) {
    const Spread gpuMs = spreadOf(p.gpuMs), cpuMs = spreadOf(p.cpuMs);
    fmt::print("  {:<20} {:>10} {:>10} {:>10} {:>10}\n", p.name, shownMs(gpuMs.median), shownMs(gpuMs.p95), shownMs(cpuMs.median), shownMs(cpuMs.p95));
  }
  fmt::print("effects that are on ({} are off; 'burnish plan' says why)\n", std::count_if(plan.effects.begin(), plan.effects.end(), [](const auto& e) { return !e.on; }));
  for (const burnish::EffectPlan& e : plan.effects)
    if (e.on) fmt::print("  {:<20} {:>10} {}{}\n", e.name, e.passes.empty() ? "" : shownMs(timeOf(e.passes).gpuMs), e.reason, costOf(e));
}

}  // namespace cli
