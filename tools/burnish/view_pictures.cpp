#include "view_pictures.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "view_camera.h"

namespace cli::viewer {
using burnish::fail;
using burnish::Result;

namespace {

constexpr int kTimedFrames = 10;     // after a change, then the picture rests
constexpr int kTemporalFrames = 24;  // antialiasing over time has its picture by then

bool temporal(const Wanted& wanted) {
  return wanted.a.antialiasing == burnish::Antialiasing::Temporal || (wanted.layout != Layout::One && wanted.b.antialiasing == burnish::Antialiasing::Temporal);
}
/// All but where it is seen from and when: what times depend on.
bool sameWork(const Wanted& a, const Wanted& b) { return a.a == b.a && a.b == b.b && a.debugView == b.debugView && a.size == b.size && a.layout == b.layout; }
bool samePicture(const Wanted& a, const Wanted& b) {
  return sameWork(a, b) && sameView(a.view, b.view) && a.moment == b.moment && a.heatScale == b.heatScale && a.threshold == b.threshold;
}

}  // namespace

bool Pictures::shows(const Wanted& wanted) const { return since_ > 0 && shrink_ == 1 && samePicture(wanted, drawn_); }

bool Pictures::settled(const Wanted& wanted) const {
  if (!shows(wanted)) return false;
  if (temporal(wanted) && since_ < kTemporalFrames) return false;
  return wanted.layout == Layout::One ? since_ >= kTimedFrames : duel_.settled() && differenceIsNew_;
}

burnish::Target Pictures::picture(int which) const {
  const Slot& slot = slots_[std::size_t(which)];
  return slot.target ? slot.target->target() : burnish::Target{};
}

Result<burnish::Image> Pictures::read(int which) const {
  const Slot& slot = slots_[std::size_t(which)];
  if (!slot.target) return fail("picture", "nothing was drawn yet", "wait for the first picture");
  return slot.target->read();
}

void Pictures::noteChange(const Wanted& wanted, int shrink) {
  const bool work = !sameWork(wanted, drawn_) || shrink != shrink_;
  if (work) {
    duel_.restart();
    history_.begin();
  }
  if (work || !samePicture(wanted, drawn_)) since_ = 0, differenceIsNew_ = false;
  if (wanted.layout == Layout::One) difference_.reset();
  drawn_ = wanted;
  shrink_ = shrink;
}

Result<burnish::FrameStats> Pictures::drawSlot(std::size_t index, const burnish::Scene& scene, const burnish::View& view, const burnish::Quality& quality, burnish::RenderRequest request) {
  Slot& slot = slots_[index];
  const glm::ivec2 size = glm::max(drawn_.size / shrink_, glm::ivec2(1));
  if (slot.size != size) {
    slot.target.reset();
    auto target = burnish::OffscreenTarget::create(address_, size, request.output);
    if (!target) return fail(target.error());
    slot.target = std::move(*target);
    slot.size = size;
  }
  request.sequence = int(index);
  return renderer_.render(scene, {&view, 1}, slot.target->target(), quality, request);
}

Result<void> Pictures::draw(const burnish::Scene& scene, const Wanted& wanted, int shrink) {
  using Clock = std::chrono::steady_clock;
  const auto began = Clock::now();
  noteChange(wanted, shrink);
  const bool compared = wanted.layout != Layout::One;
  burnish::RenderRequest request;
  request.debugView = wanted.debugView;
  // A's and B's frames follow each other at once, so that times which arrive late would be taken for the other's.
  request.timing = onCpu() || compared ? burnish::TimingMode::Profile : burnish::TimingMode::Async;
  // Asking for the automatic exposure waits for the GPU: once a picture.
  const bool automatic = !wanted.a.exposureEv && wanted.debugView == burnish::DebugView::Final;
  request.countNonfinite = automatic && since_ == 0;
  burnish::Quality a = wanted.a;
  // Both pictures are developed alike, with A's exposure.
  if (compared && automatic && since_ > 0) a.exposureEv = exposureEv_;
  auto stats = drawSlot(kA, scene, wanted.view, a, request);
  if (!stats) return fail(stats.error());
  plans_[0] = renderer_.lastPlan();
  if (request.countNonfinite || wanted.a.exposureEv) exposureEv_ = wanted.a.exposureEv.value_or(stats->exposureEv);
  auto finish = reinterpret_cast<void (*)()>(address_("glFinish"));
  if (onCpu() && finish) finish();
  const double wallMs = std::chrono::duration<double, std::milli>(Clock::now() - began).count();
  // The first frame after a change counts pixels besides: it is no frame to time.
  if (!request.countNonfinite) history_.add(*stats, onCpu(), wallMs, slots_[kA].size);
  stats_ = std::move(*stats);
  if (compared)
    if (auto drawn = drawB(scene, stats_); !drawn) return drawn;
  ++since_;
  ++framesDrawn_;
  lastMs_ = std::chrono::duration<double, std::milli>(Clock::now() - began).count();
  return {};
}

Result<void> Pictures::drawB(const burnish::Scene& scene, const burnish::FrameStats& ofA) {
  burnish::RenderRequest request;
  request.debugView = drawn_.debugView;
  request.timing = burnish::TimingMode::Profile;
  burnish::Quality b = drawn_.b;
  b.exposureEv = exposureEv_;
  auto stats = drawSlot(kB, scene, drawn_.view, b, request);
  if (!stats) return fail(stats.error());
  plans_[1] = renderer_.lastPlan();
  changed_ = changedPasses(plans_[0], plans_[1]);
  if (since_ > 0) duel_.add(ofA, *stats, changed_, onCpu());
  // While things move the map follows; where it is not shown, figures can wait for the picture to rest.
  const bool wanted = drawn_.layout == Layout::Heat ? since_ <= 1 : since_ == 1;
  if (!wanted && !temporal(drawn_)) return {};
  return findDifference(scene);
}

Result<void> Pictures::findDifference(const burnish::Scene& scene) {
  std::array<burnish::Image, 2> pictures;
  for (std::size_t i = 0; i < 2; ++i) {
    burnish::RenderRequest request;
    request.output = burnish::Output::Linear;
    request.displayLight = true;  // with what the light buffer's format takes away
    burnish::Quality quality = i == 0 ? drawn_.a : drawn_.b;
    quality.exposureEv = exposureEv_;
    auto stats = drawSlot(kLinearA + i, scene, drawn_.view, quality, request);
    if (!stats) return fail(stats.error());
    auto picture = slots_[kLinearA + i].target->read();
    if (!picture) return fail(picture.error());
    pictures[i] = std::move(*picture);
  }
  const double white = 1.2 * std::exp2(double(exposureEv_));  // what this EV100 makes 1 of (shaders/post/exposure.frag)
  difference_ = differenceOf(pictures[0], pictures[1], white, drawn_.heatScale, drawn_.threshold);
  differenceIsNew_ = true;
  return {};
}

}  // namespace cli::viewer
