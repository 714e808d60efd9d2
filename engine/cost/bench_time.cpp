// Times of qualities, each frame between two of the base's.
#include <algorithm>

#include "cost/bench_impl.h"

namespace burnish::cost {
namespace {

/// Frames behind one value, which is their median: as many on a GPU, in software until they took this many milliseconds.
constexpr std::size_t kFrames = 7;
constexpr double kLongEnough = 20;

/// What one quality gave so far.
struct Series {
  std::vector<double> ratios, passRatios;               ///< to the base's frames beside it
  std::map<std::string, std::vector<double>> byPass;  ///< likewise
  double least = 1e300;
};

double sumOf(const std::map<std::string, double>& frame, std::span<const std::string> passes) {
  double sum = 0;
  for (const std::string& name : passes)
    if (const auto pass = frame.find(name); pass != frame.end()) sum += pass->second;
  return sum;
}

double medianOf(std::vector<double> values) { return spreadOf(std::move(values)).median; }

}  // namespace

Result<Bench::Impl::Frame> Bench::Impl::drawOnce(const Quality& quality) {
  const bool software = renderer->capabilities().software;
  RenderRequest request;
  request.timing = software ? TimingMode::Profile : TimingMode::Async;
  auto stats = renderer->render(scene, {&view, 1}, display->target(), quality, request);
  if (!stats) return fail(stats.error());
  Frame frame;
  const FramePlan& plan = renderer->lastPlan();
  frame.settled = stats->shadowMapsDrawn == 0 && stats->pendingUploads == 0 && plan.targets == targets;
  targets = plan.targets;
  for (const PassTime& pass : stats->passes) {
    const double ms = software ? pass.cpuMs : pass.gpuMs;
    frame.passes[pass.name] += ms, frame.total += ms;
  }
  return frame;
}

Result<Bench::Impl::Frame> Bench::Impl::draw(const Quality& quality) {
  const bool software = renderer->capabilities().software;
  auto first = drawOnce(quality);
  if (!first || (software && (!first->settled || first->total >= kLongEnough))) return first;
  // Short frames are disturbed by more than they take: those of a GPU wait for the driver's threads now and then, those of a processor for whoever shares its cores.
  std::vector<Frame> frames;
  if (software) frames.push_back(*first);  // a GPU's own clock tells of a frame once that is done: the next frame brings the times of this one
  double sum = first->total;
  while (frames.size() < kFrames && (!software || sum < kLongEnough)) {
    finish();
    auto frame = drawOnce(quality);
    if (!frame) return frame;
    sum += frame->total;
    frames.push_back(std::move(*frame));
  }
  std::map<std::string, std::vector<double>> passes;
  std::vector<double> totals;
  for (const Frame& frame : frames) {
    for (const auto& [name, ms] : frame.passes) passes[name].push_back(ms);
    totals.push_back(frame.total);
  }
  Frame frame;
  frame.settled = first->settled;
  for (auto& [name, ms] : passes) frame.passes[name] = medianOf(std::move(ms));
  frame.total = medianOf(std::move(totals));
  return frame;
}

Result<Bench::Impl::Frame> Bench::Impl::settledFrame(const Quality& quality, double& least) {
  auto frame = draw(quality);
  for (int i = 0; i < 2 && frame && (!frame->settled || frame->total > 3 * least); ++i) frame = draw(quality);
  if (frame) least = std::min(least, frame->total);
  return frame;
}

Result<std::vector<Timing>> Bench::time(std::span<const Quality> qualities, int rounds, std::span<const std::string> passes, const std::function<bool()>& goOn) {
  Impl& b = *impl_;
  const auto stopped = [&] { return goOn && !goOn(); };
  double baseLeast = 1e300;
  std::vector<Series> all(qualities.size());
  // Compiled and uploaded before anything counts.
  if (auto frame = b.draw(b.base); !frame) return fail(frame.error());
  for (const Quality& q : qualities) {
    if (auto frame = b.draw(q); !frame) return fail(frame.error());
    if (stopped()) return fail("times", "stopped before there were any", "give it more time");
  }
  std::vector<double> baseFrames;
  int done = 0;
  for (; done < std::max(rounds, 1) && (done == 0 || !stopped()); ++done) {
    auto before = b.settledFrame(b.base, baseLeast);
    if (!before) return fail(before.error());
    baseFrames.push_back(before->total);
    double last = before->total;
    for (std::size_t i = 0; i < qualities.size(); ++i) {
      auto frame = b.settledFrame(qualities[i], all[i].least);
      if (!frame) return fail(frame.error());
      auto after = b.settledFrame(b.base, baseLeast);
      if (!after) return fail(after.error());
      const double beside = std::max(0.5 * (last + after->total), 1e-9);
      all[i].ratios.push_back(frame->total / beside);
      all[i].passRatios.push_back(sumOf(frame->passes, passes) / beside);
      for (const auto& [name, ms] : frame->passes) all[i].byPass[name].push_back(ms / beside);
      baseFrames.push_back(last = after->total);
    }
  }
  b.baseCount += int(baseFrames.size());
  b.baseMedians.push_back(medianOf(baseFrames));
  b.lastBaseFrames = std::move(baseFrames);
  const Spread base = baseFrame();
  std::vector<Timing> timings;
  for (const Series& s : all) {
    Timing t;
    t.ratio = spreadOf(s.ratios), t.passesRatio = spreadOf(s.passRatios);
    t.frame = times(t.ratio, base), t.passes = times(t.passesRatio, base);
    for (const auto& [name, ratios] : s.byPass) t.byPass[name] = times(spreadOf(ratios), base);
    timings.push_back(std::move(t));
  }
  return timings;
}

// Over the medians of the calls, so that the spread holds the machine's drift from one to the next; of few calls, over the frames of the last.
Spread Bench::baseFrame() const {
  Spread s = spreadOf(impl_->baseMedians.size() < 3 ? impl_->lastBaseFrames : impl_->baseMedians);
  s.count = impl_->baseCount;
  return s;
}

}  // namespace burnish::cost
