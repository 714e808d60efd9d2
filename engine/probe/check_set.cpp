// What the format demands of a set, on writing as on reading.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/cube_file.h"
#include "probe/manifest.h"

namespace burnish::probe {
namespace {

constexpr double kFarthest = 1e12;     // metres from the origin, and of any length
constexpr double kUnitError = 1e-4;    // of axes' lengths and cosines

template <class V>
bool within(const V& v, double least = -kFarthest) {
  for (int i = 0; i < V::length(); ++i)
    if (!(double(v[i]) >= least && double(v[i]) <= kFarthest)) return false;
  return true;
}
bool orthonormal(const glm::dmat3& axes) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::abs(glm::dot(axes[i], axes[j]) - (i == j ? 1 : 0)) <= kUnitError)) return false;
  return true;
}
tl::unexpected<Error> bad(const std::string& place, std::string what, const char* remedy) { return fail(place, std::move(what), remedy); }

}  // namespace

Result<void> checkProbe(const ReflectionProbe& p, const std::string& place) {
  const char* metres = "give finite numbers in metres, sizes at least 0";
  if (!within(p.center) || !within(p.capture)) return bad(place, "its centre or capture point is not finite or farther than 1e12 m", metres);
  if (!within(p.halfSize, 0) || !within(p.fade, 0) || !(p.margin >= 0 && p.margin <= kFarthest)) return bad(place, "its half size, fade or margin is negative or not finite", metres);
  if (!orthonormal(p.axes)) return bad(place, "its axes are not unit and orthogonal", "give the columns of a rotation");
  for (const auto& rgb : p.irradiance)
    for (const double v : rgb)
      if (!std::isfinite(v)) return bad(place, "its irradiance holds a value that is not finite", "bake it again");
  return {};
}

Result<void> checkGrid(const AmbientGrid& g, const std::string& place) {
  if (!within(g.origin) || !(g.margin >= 0 && g.margin <= kFarthest)) return bad(place, "its origin or margin is not finite, or the margin is negative", "give finite numbers in metres");
  if (!within(g.spacing, 1e-9)) return bad(place, "its spacing is not above 0 and finite", "give metres between points");
  if (!orthonormal(g.axes)) return bad(place, "its axes are not unit and orthogonal", "give the columns of a rotation");
  std::uint64_t points = 1;
  for (int i = 0; i < 3; ++i) {
    if (g.counts[i] < 1 || std::size_t(g.counts[i]) > kMostGridPoints) return bad(place, fmt::format("{} points along an axis", g.counts[i]), fmt::format("give 1 to {}", kMostGridPoints).c_str());
    points *= static_cast<std::uint64_t>(g.counts[i]);
    if (points > kMostGridPoints) return bad(place, fmt::format("{} points or more", points), fmt::format("at most {} can be stored: enlarge the spacing", kMostGridPoints).c_str());
  }
  return {};
}

namespace {

Result<void> checkPoints(const AmbientGrid& g, const std::string& place) {
  const std::size_t texels = std::size_t(AmbientGrid::kDistanceSize) * AmbientGrid::kDistanceSize, points = std::size_t(g.counts.x) * std::size_t(g.counts.y) * std::size_t(g.counts.z);
  if (!g.points.empty() && g.points.size() != points) return bad(place, fmt::format("holds {} points, its counts make {}", g.points.size(), points), "give all of them or none");
  const bool distances = std::any_of(g.points.begin(), g.points.end(), [](const AmbientGrid::Point& p) { return !p.distances.empty(); });
  for (std::size_t i = 0; i < g.points.size(); ++i) {
    const AmbientGrid::Point& p = g.points[i];
    if (p.distances.size() != texels && !(p.distances.empty() && (!distances || !p.valid)))
      return bad(place, fmt::format("point {} has {} distances, not {}", i, p.distances.size(), texels), "give all valid points distances, or none");
    for (const glm::vec3& rgb : p.irradiance)
      if (!std::isfinite(rgb.x + rgb.y + rgb.z)) return bad(place, fmt::format("point {} holds irradiance that is not finite", i), "bake it again");
    for (const glm::vec2& d : p.distances)
      if (!(d.x >= 0 && d.y >= 0 && std::isfinite(d.x + d.y))) return bad(place, fmt::format("point {} holds a distance that is negative or not finite", i), "find its distances again");
  }
  return {};
}

Result<void> checkRadiance(const Cubemap& cube, const std::string& place) {
  if (cube.levels.empty()) return {};
  if (cube.levels[0].size > kMostSize) return bad(place, fmt::format("faces of {} texels", cube.levels[0].size), fmt::format("bake it with at most {}", kMostSize).c_str());
  return image::checkCubemap(cube, place);
}

}  // namespace

Result<void> checkSet(const ProbeSet& set, const std::string& place) {
  if (set.reflections.size() > kMostReflections) return bad(place, fmt::format("{} reflection probes", set.reflections.size()), fmt::format("at most {} can be stored", kMostReflections).c_str());
  std::optional<ReflectionLobe> lobe;
  for (std::size_t i = 0; i < set.reflections.size(); ++i) {
    const ReflectionProbe& p = set.reflections[i];
    const std::string here = fmt::format("{}: reflection probe {} '{}'", place, i, std::string_view(p.name).substr(0, 80));
    if (auto ok = checkProbe(p, here); !ok) return ok;
    if (auto ok = checkRadiance(p.radiance, here); !ok) return ok;
    if (p.radiance.levels.empty()) continue;
    if (lobe && lobe != p.radiance.lobe) return bad(here, "is filtered for another lobe than the ones before", "bake the whole set for one lobe");
    lobe = p.radiance.lobe;
  }
  if (!set.grid) return {};
  if (auto ok = checkGrid(*set.grid, place + ": grid"); !ok) return ok;
  return checkPoints(*set.grid, place + ": grid");
}

}  // namespace burnish::probe
