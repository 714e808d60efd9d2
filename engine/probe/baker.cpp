#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "image/cube_file.h"
#include "prefilter/parallel.h"
#include "probe/bake.h"
#include "probe/payload.h"

namespace burnish::probe {
namespace {

constexpr double kUsualRatio = 0.5;  // of two bounces, until it is known: for the time left alone

}  // namespace

void TimeLeft::captured(bool reflection, double seconds) { sum_[reflection] += seconds, ++count_[reflection]; }

double TimeLeft::each(bool reflection) const {
  if (count_[reflection] > 0) return sum_[reflection] / count_[reflection];
  if (count_[!reflection] == 0) return 0;
  const double share = std::pow(double(options_.size) / options_.ambientSize, reflection ? 2 : -2);
  return sum_[!reflection] / count_[!reflection] * share;
}

double TimeLeft::bouncesAfter(int bounce, std::span<const BounceReport> bounces) const {
  if (alone_) return 0;
  if (options_.bounces > 0) return std::max(options_.bounces - bounce, 0);
  const BounceReport* last = bounces.empty() ? nullptr : &bounces.back();
  const bool known = last && std::isfinite(last->rest) && last->ratio > 0 && last->ratio < 1;
  const double ratio = known ? last->ratio : kUsualRatio, rest = known ? last->rest : std::pow(kUsualRatio, double(bounces.size()));
  const double more = rest > options_.until ? std::ceil(std::log(options_.until / rest) / std::log(ratio)) : 0;
  return std::clamp(double(bounces.size()) + more - bounce, 0.0, double(options_.maxBounces));
}

double TimeLeft::seconds(int leftReflections, int leftGridPoints, int bounce, std::span<const BounceReport> bounces) const {
  if (count_[0] + count_[1] == 0) return -1;
  const double after = bouncesAfter(bounce, bounces);
  return (leftReflections + after * reflections_) * each(true) + (leftGridPoints + after * gridPoints_) * each(false);
}

Baker::Baker(const ProcAddress& getProcAddress, const Paths& paths, const Prepared& prepared, const BakeOptions& options, const BakeJob& job, LightStore& store, Report& report)
    : getProcAddress_(getProcAddress), paths_(paths), prepared_(prepared), options_(options), job_(job), store_(store), report_(report),
      left_(options, job.bounce > 0, int(prepared.places.reflections.size()), captureCount(prepared.places) - int(prepared.places.reflections.size())) {
  const std::vector<Unit> all = unitsOf(prepared.places);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (int(i % std::size_t(job.shards)) == job.shard) units_.push_back(all[i]);
}
Baker::~Baker() = default;

Result<Capture*> Baker::capture(const BounceLight* before) {
  if (!capture_) {
    auto made = Capture::create(getProcAddress_, prepared_.scene, options_.quality);
    if (!made) return fail(made.error());
    capture_ = std::move(*made);
  }
  if (!lit_) capture_->setProbes(before ? withLight(prepared_.places, before->lights) : blackLight(prepared_.places, options_));
  lit_ = true;
  return capture_.get();
}

Result<StoredLight> Baker::point(int index, bool reflection, const BounceLight* before) {
  const auto begin = std::chrono::steady_clock::now();
  const auto capture = this->capture(before);
  if (!capture) return fail(capture.error());
  const auto light = capturePoint(**capture, prepared_.places, index, options_, time);
  if (!light) return fail(light.error());
  StoredLight out = storedLight(light->irradiance, reflection ? encodeRadiance(light->radiance).bytes : std::vector<std::byte>());
  left_.captured(reflection, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  return out;
}

Result<std::vector<StoredLight>> Baker::unit(const Unit& unit, std::span<const core::Hash128> keys, const BounceLight* before, BounceReport& report) {
  double begin = prefilter::cpuMilliseconds();
  if (auto whole = store_.unit(unit, keys, report_)) {
    report.reused += unit.count;
    storeMs += prefilter::cpuMilliseconds() - begin;
    return std::move(*whole);
  }
  std::vector<StoredLight> lights;
  for (int i = unit.first; i < unit.first + unit.count; ++i) {
    auto known = unit.reflection ? std::nullopt : store_.point(keys[std::size_t(i)]);
    ++(known ? report.reused : report.captured);
    if (!known) {
      auto light = point(i, unit.reflection, before);
      if (!light) return fail(light.error());
      known = std::move(*light);
    }
    lights.push_back(std::move(*known));
  }
  begin = prefilter::cpuMilliseconds();
  if (auto ok = store_.put(unit, keys, lights); !ok) return fail(ok.error());
  storeMs += prefilter::cpuMilliseconds() - begin;
  return lights;
}

Result<BounceReport> Baker::bounce(int bounce, std::span<const core::Hash128> keys, const BounceLight* before, std::span<const BounceReport> log, BounceLight& now) {
  BounceReport report;
  report.bounce = bounce;
  lit_ = false;
  now.lights.assign(keys.size(), {});
  now.contents.assign(keys.size(), {});
  int total = 0, done = 0, left[2] = {};
  for (const Unit& u : units_) total += u.count, left[u.reflection] += u.count;
  for (const Unit& u : units_) {
    if (job_.progress) job_.progress(bounce, done, total, left_.seconds(left[1], left[0], bounce, log));
    auto lights = unit(u, keys, before, report);
    if (!lights) return fail(lights.error());
    for (int i = 0; i < u.count; ++i) {
      auto light = decoded((*lights)[std::size_t(i)], unitName(u, keys));
      if (!light) return fail(light.error());
      now.lights[std::size_t(u.first + i)] = std::move(*light);
      now.contents[std::size_t(u.first + i)] = (*lights)[std::size_t(i)].content;
    }
    done += u.count, left[u.reflection] -= u.count;
  }
  if (job_.progress) job_.progress(bounce, done, total, left_.seconds(0, 0, bounce, log));
  return report;
}

void Baker::takeWarnings() {
  if (!capture_) return;
  for (const Warning& w : capture_->report().warnings()) report_.warn(w.place, w.what);
}

}  // namespace burnish::probe
