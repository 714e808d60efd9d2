// placeProbes(): rooms become places for reflection probes, and all of them together a lattice.
#include <burnish/probe.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "probe/placement_lattice.h"
#include "probe/visibility.h"

namespace burnish {
namespace {

using probe::Room;

bool inBox(const ReflectionProbe& box, glm::dvec3 point) {
  const glm::dvec3 p = glm::abs(glm::transpose(box.axes) * (point - box.center));
  return glm::all(glm::lessThanEqual(p, box.halfSize + 1e-6));
}

/// Whether a box that the scene has covers at least half of the room.
bool hasProbe(const ProbeSet& set, const Room& room) {
  constexpr int kSteps = 8;
  return std::any_of(set.reflections.begin(), set.reflections.end(), [&](const ReflectionProbe& box) {
    int covered = 0;
    for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
      const glm::dvec3 share = (glm::dvec3(i % kSteps, i / kSteps % kSteps, i / (kSteps * kSteps)) + 0.5) * (2.0 / kSteps) - 1.0;
      covered += inBox(box, room.center + room.axes * (share * room.halfSize));
    }
    return covered * 2 >= kSteps * kSteps * kSteps;
  });
}

ReflectionProbe probeOf(const Room& room, std::size_t number) {
  ReflectionProbe p;
  p.name = fmt::format("room {}", number);
  p.center = room.center;
  p.axes = room.axes;
  p.halfSize = room.halfSize;
  p.capture = room.capture;
  p.fade = glm::min(glm::dvec3(0.5), room.halfSize * 0.25);
  // In the middle of a doorway, half its depth from either box, a quarter of the light at most is the sky's.
  p.margin = std::clamp(2 * room.doors, 0.25, 2.0);
  return p;
}

Result<void> checked(const PlacementOptions& options) {
  if (!(options.gridSpacing >= 0) || !std::isfinite(options.gridSpacing)) return fail("PlacementOptions::gridSpacing", "is not a length of at least 0", "give metres, or 0");
  if (options.maxGridPoints < 8) return fail("PlacementOptions::maxGridPoints", fmt::format("is {}", options.maxGridPoints), "allow at least 8");
  return {};
}

/// The lattice over the rooms.
AmbientGrid gridFor(const probe::Rooms& found, const PlacementOptions& options, Report& report) {
  double wanted = 0;
  AmbientGrid grid = probe::latticeOver(found.rooms, found.axes, options.gridSpacing, options.maxGridPoints, wanted);
  if (wanted > std::max(options.maxGridPoints, 8))
    report.warn("probe placement", fmt::format("a lattice as close as asked for has {:.0f} points, at most {} are allowed: neighbours are {:.2f} x {:.2f} x {:.2f} m apart", wanted, options.maxGridPoints,
                                               grid.spacing.x, grid.spacing.y, grid.spacing.z));
  return grid;
}

}  // namespace

Result<ProbeSet> placeProbes(const Scene& scene, const PlacementOptions& options, Report& report) {
  if (auto good = checked(options); !good) return fail(good.error());
  auto geometry = probe::Geometry::create(scene, &report);
  if (!geometry) return fail(geometry.error());
  const auto progress = [&](double from, double to) {
    return [&options, from, to](double share) {
      if (options.progress) options.progress(from + (to - from) * share);
    };
  };
  ProbeSet set = scene.probes;
  ++set.revision;
  const probe::Rooms found = probe::findRooms(*geometry, {}, options.threads, progress(0, 0.4));
  if (found.rooms.empty())
    report.warn("probe placement", fmt::format("no room is found: nothing that is covered, closed on most sides and as large as {} m³{}", probe::RoomLimits{}.volume,
                                               found.cell > 0.25 ? fmt::format(" (the scene is so large that what is smaller than about {:.1f} m is not seen)", 4 * found.cell) : ""));
  if (options.rooms)
    for (const Room& room : found.rooms)
      if (!hasProbe(scene.probes, room)) set.reflections.push_back(probeOf(room, set.reflections.size() - scene.probes.reflections.size() + 1));
  if (options.grid && !set.grid && !found.rooms.empty()) set.grid = gridFor(found, options, report);
  if (set.grid && set.grid->points.empty())
    if (auto filled = probe::fillPoints(*geometry, *set.grid, options.threads, progress(0.4, 1)); !filled) return fail(filled.error());
  if (options.progress) options.progress(1);
  return set;
}

}  // namespace burnish
