#include "probe/bounce.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "prefilter/parallel.h"
#include "reference/shading.h"

namespace burnish::probe {
namespace {

/// Where a capture point stands and what it is called.
struct Place {
  glm::dvec3 point{0};
  const ReflectionProbe* probe = nullptr;  ///< nullptr: a grid point
  std::string name;
};
Place placeOf(const ProbeSet& places, int index) {
  if (index < int(places.reflections.size())) {
    const ReflectionProbe& p = places.reflections[std::size_t(index)];
    return {p.capture, &p, p.name.empty() ? fmt::format("reflection probe {}", index) : fmt::format("reflection probe '{}'", p.name)};
  }
  const AmbientGrid& grid = *places.grid;
  int left = index - int(places.reflections.size());
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    if (!grid.points[i].valid || left-- > 0) continue;
    const int n = int(i);
    const glm::ivec3 at(n % grid.counts.x, n / grid.counts.x % grid.counts.y, n / grid.counts.x / grid.counts.y);
    return {grid.position(at), nullptr, fmt::format("ambient grid point ({}, {}, {})", at.x, at.y, at.z)};
  }
  return {};
}

void setPoint(AmbientGrid::Point& point, const IrradianceSh& sh) {
  for (std::size_t i = 0; i < 9; ++i) point.irradiance[i] = glm::vec3(sh[i][0], sh[i][1], sh[i][2]);
}

/// Means of the squares over all directions of the basis that IrradianceSh has: it is orthogonal, so that a sum over them is the mean of a square of irradiance.
constexpr double kSquares[9] = {1, 1 / 3.0, 1 / 3.0, 1 / 3.0, 1 / 15.0, 1 / 15.0, 4 / 5.0, 1 / 15.0, 4 / 15.0};

double added(const BounceReport& b) { return b.change * b.light; }

}  // namespace

int captureCount(const ProbeSet& places) {
  int count = int(places.reflections.size());
  if (places.grid) count += int(std::count_if(places.grid->points.begin(), places.grid->points.end(), [](const AmbientGrid::Point& p) { return p.valid; }));
  return count;
}

Result<PointLight> capturePoint(Capture& capture, const ProbeSet& places, int index, const BakeOptions& options, PointTime& time) {
  if (index < 0 || index >= captureCount(places)) return fail("bake", fmt::format("there is no capture point {}", index), "give 0 to captureCount() - 1");
  const Place place = placeOf(places, index);
  const double start = prefilter::cpuMilliseconds();
  auto level = capture.radiance(place.point, place.probe ? options.size : options.ambientSize);
  if (!level) return fail(place.name + ": " + level.error().place, level.error().what, level.error().remedy);
  const double captured = prefilter::cpuMilliseconds();
  time.captureMs += captured - start;
  if (capture.mended()) capture.report().warn(place.name, fmt::format("{} of {} captured values were negative or not finite: they count as 0", capture.mended(), level->texels.size()));
  PointLight light;
  auto irradiance = irradianceSh(*level, false, options.threads);
  if (!irradiance) return fail(place.name + ": " + irradiance.error().place, irradiance.error().what, irradiance.error().remedy);
  light.irradiance = *irradiance;
  if (place.probe) {
    auto cube = prefilterCubemap(*level, {.lobe = options.lobe, .size = options.size, .threads = options.threads});
    if (!cube) return fail(place.name + ": " + cube.error().place, cube.error().what, cube.error().remedy);
    light.radiance = std::move(*cube);
  }
  time.filterMs += prefilter::cpuMilliseconds() - captured;
  return light;
}

ProbeSet withLight(const ProbeSet& places, std::span<const PointLight> lights) {
  ProbeSet set = places;
  ++set.revision;
  std::size_t next = 0;
  for (ReflectionProbe& p : set.reflections) {
    p.radiance = lights[next].radiance;
    p.irradiance = lights[next++].irradiance;
  }
  if (set.grid)
    for (AmbientGrid::Point& p : set.grid->points)
      if (p.valid) setPoint(p, lights[next++].irradiance);
  return set;
}

ProbeSet blackLight(const ProbeSet& places, const BakeOptions& options) {
  PointLight black;
  black.radiance.lobe = options.lobe;
  const int count = std::max(std::countr_zero(unsigned(options.size)) - 2, 1);
  for (int k = 0; k < count; ++k) {
    const int size = options.size >> k;
    black.radiance.levels.push_back({size, k ? shading::f64::environmentRoughness(double(k), double(count - 1)) : 0, std::vector<float>(std::size_t(size) * std::size_t(size) * 18)});
  }
  return withLight(places, std::vector<PointLight>(std::size_t(captureCount(places)), black));
}

Change changeOf(std::span<const IrradianceSh> before, std::span<const IrradianceSh> now) {
  double apart = 0, all = 0;
  for (std::size_t p = 0; p < now.size(); ++p)
    for (std::size_t i = 0; i < 9; ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        const double d = now[p][i][c] - (p < before.size() ? before[p][i][c] : 0);
        apart += kSquares[i] * d * d;
        all += kSquares[i] * now[p][i][c] * now[p][i][c];
      }
  if (all <= 0) return {};
  return {std::sqrt(apart / all), std::sqrt(all / (3 * double(now.size())))};
}

Result<BounceReport> judge(std::span<const BounceReport> before, const Change& change) {
  BounceReport b;
  b.bounce = int(before.size()) + 1;
  b.change = change.share;
  b.light = change.light;
  const double infinite = std::numeric_limits<double>::infinity();
  if (!before.empty() && added(before.back()) > 0) b.ratio = added(b) / added(before.back());
  // Where a bounce adds nothing, none that follows does: each is made of the one before.
  b.rest = added(b) <= 0 ? 0 : before.empty() || b.ratio >= 1 ? infinite : b.change * b.ratio / (1 - b.ratio);
  int growing = b.ratio >= 1;
  for (std::size_t i = before.size(); i-- > 0 && growing > 0 && growing < kGrowing && before[i].ratio >= 1;) ++growing;
  if (growing >= kGrowing)
    return fail(fmt::format("bounce {}", b.bounce), fmt::format("light grows: q was at least 1 in {} bounces, {:.4g} in this one", kGrowing, b.ratio),
                "surfaces give back more than they get: lower the albedo limit, or take rungs that keep energy (diffuse=coupled-fit)");
  return b;
}

bool wantsMore(std::span<const BounceReport> bounces, const BakeOptions& options) {
  const int done = int(bounces.size());
  if (options.bounces > 0) return done < options.bounces;
  if (done >= options.maxBounces) return false;
  if (done == 0) return true;
  if (bounces.back().rest <= 0) return false;
  return done < kLeastBounces || bounces.back().rest > options.until;
}

}  // namespace burnish::probe
