#include "scene/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace burnish::scene {
namespace {

constexpr double kFarthest = 1e9;  // metres

bool finite(const AmbientGrid& g) {
  const auto good = [](glm::dvec3 v) { return std::abs(v.x) <= kFarthest && std::abs(v.y) <= kFarthest && std::abs(v.z) <= kFarthest; };
  const glm::dvec3 s = g.spacing;
  return good(g.origin) && good(g.axes[0]) && good(g.axes[1]) && good(g.axes[2]) && good(s) && s.x > 1e-6 && s.y > 1e-6 && s.z > 1e-6 && std::abs(g.margin) <= kFarthest;
}

std::string fault(const AmbientGrid& g) {
  if (!finite(g)) return "its place or spacing is not finite, not above 1e-6 m or beyond 1e9 m: it is left out";
  const glm::ivec3 n = g.counts;
  if (n.x < 1 || n.y < 1 || n.z < 1 || double(n.x) * n.y * n.z != double(g.points.size())) return fmt::format("it has {} points where {} x {} x {} are counted: it is left out", g.points.size(), n.x, n.y, n.z);
  if (std::none_of(g.points.begin(), g.points.end(), [](const AmbientGrid::Point& p) { return p.valid; })) return "none of its points is valid: it is left out";
  return {};
}

}  // namespace

const AmbientGrid* usableGrid(const Scene& scene, Report* report) {
  if (!scene.probes.grid || scene.probes.grid->points.empty()) return nullptr;
  const AmbientGrid& g = *scene.probes.grid;
  const std::string why = fault(g);
  if (why.empty()) return &g;
  if (report) report->warn(g.name.empty() ? "ambient lattice" : fmt::format("ambient lattice '{}'", g.name), why);
  return nullptr;
}

bool meetsGrid(const AmbientGrid& g, const ViewFrame& frame) {
  const glm::dvec3 size = glm::dvec3(g.counts - 1) * g.spacing, half = (size + g.spacing) * 0.5 + std::max(g.margin, 0.0);
  const glm::dvec3 extent = glm::abs(g.axes[0]) * half.x + glm::abs(g.axes[1]) * half.y + glm::abs(g.axes[2]) * half.z;
  return Frustum(frame).meetsBox(g.origin + g.axes * (size * 0.5) - frame.eye, extent);
}

}  // namespace burnish::scene
