#include "scene/probes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interface/limits.h"

namespace burnish::scene {
namespace {

constexpr double kFarthest = 1e9;  // metres

std::string named(const ReflectionProbe& p, std::size_t index) { return p.name.empty() ? fmt::format("reflection probe {}", index) : fmt::format("reflection probe '{}'", p.name); }

bool finite(const ReflectionProbe& p) {
  const auto good = [](glm::dvec3 v) { return std::abs(v.x) <= kFarthest && std::abs(v.y) <= kFarthest && std::abs(v.z) <= kFarthest; };
  return good(p.center) && good(p.capture) && good(p.halfSize) && good(p.fade) && good(p.axes[0]) && good(p.axes[1]) && good(p.axes[2]) && std::abs(p.margin) <= kFarthest;
}

bool whole(const Cubemap& cube) {
  for (std::size_t k = 0; k < cube.levels.size(); ++k) {
    const CubeLevel& level = cube.levels[k];
    if (level.size < 1 || level.texels.size() != 18 * std::size_t(level.size) * std::size_t(level.size) || (k > 0 && level.size != std::max(cube.levels[k - 1].size / 2, 1))) return false;
  }
  return true;
}

bool alike(const Cubemap& a, const Cubemap& b) { return a.levels.size() == b.levels.size() && a.levels[0].size == b.levels[0].size; }

/// What keeps a probe with light from being used; empty: nothing. `first`: the first that is used.
std::string fault(const ReflectionProbe& p, const ReflectionProbe* first) {
  if (!finite(p)) return "its place is not finite or farther than 1e9 m: it is left out";
  if (!whole(p.radiance)) return "the levels of its cube do not halve or have too few texels: it is left out";
  if (first && !alike(p.radiance, first->radiance))
    return fmt::format("its cube has {} levels from {} texels on, and that of {} has {} from {} on: it is left out (bake them together)", p.radiance.levels.size(), p.radiance.levels[0].size, named(*first, 0),
                       first->radiance.levels.size(), first->radiance.levels[0].size);
  return {};
}

}  // namespace

std::vector<std::uint32_t> usableProbes(const ProbeSet& probes, Report* report) {
  std::vector<std::uint32_t> usable;
  std::size_t past = 0;
  for (std::size_t i = 0; i < probes.reflections.size(); ++i) {
    const ReflectionProbe& p = probes.reflections[i];
    if (p.radiance.levels.empty()) continue;
    const std::string why = fault(p, usable.empty() ? nullptr : &probes.reflections[usable[0]]);
    if (!why.empty()) {
      if (report) report->warn(named(p, i), why);
    } else if (usable.size() == MAX_PROBES) {
      ++past;
    } else {
      usable.push_back(std::uint32_t(i));
    }
  }
  if (past > 0 && report) report->warn("reflection probes", fmt::format("{} of them have light and {} is the limit: the rest is left out", usable.size() + past, MAX_PROBES));
  return usable;
}

glm::dvec3 reachOf(const ReflectionProbe& p) {
  const glm::dvec3 half = glm::max(p.halfSize, glm::dvec3(0)) + std::max(p.margin, 0.0);
  return glm::abs(p.axes[0]) * half.x + glm::abs(p.axes[1]) * half.y + glm::abs(p.axes[2]) * half.z;
}

std::vector<SeenProbe> findProbes(const Scene& scene, const ViewFrame& frame, Report& report, Reach reach) {
  std::vector<SeenProbe> seen;
  if (scene.probes.reflections.empty()) return seen;
  const Frustum frustum(frame);
  const std::vector<std::uint32_t> usable = usableProbes(scene.probes, &report);
  for (std::size_t i = 0; i < usable.size(); ++i) {
    const ReflectionProbe& p = scene.probes.reflections[usable[i]];
    const glm::dvec3 center = p.center - frame.eye;
    if (reach == Reach::InView && !frustum.meetsBox(center, reachOf(p))) continue;
    seen.push_back({usable[i], std::uint32_t(i), center, p.capture - frame.eye});
  }
  const auto volume = [&](const SeenProbe& s) {
    const glm::dvec3 h = glm::max(scene.probes.reflections[s.index].halfSize, glm::dvec3(0));
    return h.x * h.y * h.z;
  };
  std::stable_sort(seen.begin(), seen.end(), [&](const SeenProbe& a, const SeenProbe& b) { return volume(a) < volume(b); });
  return seen;
}

}  // namespace burnish::scene
