#include "view_times.h"

#include <algorithm>
#include <cmath>

namespace cli::viewer {
namespace {

/// Linear between the two samples around it; `sorted` holds at least one.
double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * double(sorted.size() - 1);
  const auto low = std::size_t(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (sorted[high] - sorted[low]) * (at - double(low));
}

double timeOf(const burnish::PassTime& pass, bool cpu) { return cpu ? pass.cpuMs : pass.gpuMs; }

constexpr std::size_t kMostSamples = 400;  // of a duel that goes on and on

}  // namespace

Middle middleOf(std::vector<double> samples) {
  if (samples.empty()) return {};
  std::sort(samples.begin(), samples.end());
  return {quantile(samples, 0.5), quantile(samples, 0.25), quantile(samples, 0.75), int(samples.size())};
}

void History::add(const burnish::FrameStats& stats, bool cpu, double wallMs, glm::ivec2 size) {
  if (stats.passes.empty()) return;
  Frame frame;
  frame.wallMs = wallMs;
  frame.size = size;
  for (const burnish::PassTime& pass : stats.passes) {
    const auto found = std::find(names_.begin(), names_.end(), pass.name);
    const auto index = std::size_t(found - names_.begin());
    if (found == names_.end()) names_.push_back(pass.name);
    frame.ms.resize(std::max(frame.ms.size(), index + 1));
    frame.ms[index] += timeOf(pass, cpu);
    frame.total += timeOf(pass, cpu);
    if (std::find(frame.order.begin(), frame.order.end(), index) == frame.order.end()) frame.order.push_back(index);
  }
  frames_.push_back(std::move(frame));
  if (frames_.size() > kFrames) frames_.pop_front();
  begin_ = std::min(begin_ + 1, kFrames);
}

template <class F>
double History::median(F value) const {
  std::vector<double> samples;
  for (std::size_t i = frames_.size() - std::min(begin_, frames_.size()); i < frames_.size(); ++i)
    if (frames_[i].size == frames_.back().size) samples.push_back(value(frames_[i]));
  // The first two frames after a change compile and upload.
  if (samples.size() > 4) samples.erase(samples.begin(), samples.begin() + 2);
  return middleOf(std::move(samples)).median;
}
double History::medianOf(std::size_t pass) const {
  return median([pass](const Frame& frame) { return pass < frame.ms.size() ? frame.ms[pass] : 0; });
}
double History::medianTotal() const {
  return median([](const Frame& frame) { return frame.total; });
}
double History::medianWall() const {
  return median([](const Frame& frame) { return frame.wallMs; });
}

void Duel::restart() { *this = Duel(); }

void Duel::add(const burnish::FrameStats& a, const burnish::FrameStats& b, const std::vector<std::string>& changed, bool cpu) {
  if (++seen_ <= kUnmeasured || frame_[0].size() >= kMostSamples) return;
  for (int i = 0; i < 2; ++i) {
    double whole = 0, part = 0;
    for (const burnish::PassTime& pass : (i == 0 ? a : b).passes) {
      whole += timeOf(pass, cpu);
      if (std::find(changed.begin(), changed.end(), pass.name) != changed.end()) part += timeOf(pass, cpu);
    }
    frame_[std::size_t(i)].push_back(whole);
    changed_[std::size_t(i)].push_back(part);
  }
}

Middle Duel::gap() const {
  std::vector<double> gaps;
  for (std::size_t i = 0; i < frame_[0].size(); ++i) gaps.push_back(frame_[1][i] - frame_[0][i]);
  return middleOf(std::move(gaps));
}

namespace {

const burnish::ProgramPlan* programOf(const burnish::FramePlan& plan, const std::string& name) {
  for (const burnish::ProgramPlan& program : plan.programs)
    if (program.name == name) return &program;
  return nullptr;
}

/// Targets alike but for the effects that call for them.
bool sameTarget(const burnish::TargetPlan* a, const burnish::TargetPlan* b) {
  if (!a || !b) return a == b;
  return a->format == b->format && a->width == b->width && a->height == b->height && a->levels == b->levels && a->layers == b->layers;
}

bool samePass(const burnish::FramePlan& a, const burnish::PassPlan& pass, const burnish::FramePlan& b, const burnish::PassPlan& other) {
  if (pass.programs != other.programs || pass.reads != other.reads || pass.writes != other.writes) return false;
  for (const std::string& name : pass.programs) {
    const burnish::ProgramPlan *p = programOf(a, name), *q = programOf(b, name);
    if (!p || !q || !(*p == *q)) return false;
  }
  for (const auto* names : {&pass.reads, &pass.writes})
    for (const std::string& name : *names)
      if (!sameTarget(a.target(name), b.target(name))) return false;
  return true;
}

}  // namespace

std::vector<std::string> changedPasses(const burnish::FramePlan& a, const burnish::FramePlan& b) {
  std::vector<std::string> names;
  for (const burnish::PassPlan& pass : a.passes) {
    const burnish::PassPlan* other = b.pass(pass.name);
    if (!other || !samePass(a, pass, b, *other)) names.push_back(pass.name);
  }
  for (const burnish::PassPlan& pass : b.passes)
    if (!a.pass(pass.name)) names.push_back(pass.name);
  return names;
}

}  // namespace cli::viewer
