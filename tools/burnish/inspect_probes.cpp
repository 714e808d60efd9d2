#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "inspect.h"
#include "messages.h"

namespace cli {
namespace {

using burnish::AmbientGrid;
using burnish::ReflectionProbe;

std::string vec(const glm::dvec3& v) { return fmt::format("{:.3f},{:.3f},{:.3f}", v.x, v.y, v.z); }

void printReflection(const ReflectionProbe& p, std::size_t index) {
  const std::string name = p.name.empty() ? fmt::format("probe {}", index) : shown(p.name);
  std::string light = "no light";
  if (!p.radiance.levels.empty()) {
    float most = 0;
    for (const burnish::CubeLevel& level : p.radiance.levels)
      for (const float v : level.texels) most = std::max(most, v);
    light = fmt::format("faces of {}, {} levels, up to {:.4g} cd/m²", p.radiance.levels[0].size, p.radiance.levels.size(), most);
  }
  fmt::print("  {}: box of {:.2f} x {:.2f} x {:.2f} m at {}, captured at {}, fade {}, margin {:g}; {}\n", name, 2 * p.halfSize.x, 2 * p.halfSize.y, 2 * p.halfSize.z, vec(p.center), vec(p.capture), vec(p.fade), p.margin, light);
}

void printGrid(const AmbientGrid& g) {
  const auto valid = std::count_if(g.points.begin(), g.points.end(), [](const AmbientGrid::Point& p) { return p.valid; });
  const bool distances = std::any_of(g.points.begin(), g.points.end(), [](const AmbientGrid::Point& p) { return !p.distances.empty(); });
  const std::string baked = g.points.empty() ? std::string("not baked") : fmt::format("{} of {} free{}", valid, g.points.size(), distances ? "" : ", without distances: light passes walls");
  fmt::print("lattice: {}{} x {} x {} points from {}, {} m apart; {}\n", g.name.empty() ? "" : shown(g.name) + ", ", g.counts.x, g.counts.y, g.counts.z, vec(g.origin), vec(g.spacing), baked);
}

void printBounces(const burnish::ProbeFolder& folder) {
  if (folder.options.empty()) return;
  fmt::print("bake: {}\n", shown(folder.options));
  fmt::print("  {:>6} {:>10} {:>8} {:>10}\n", "bounce", "change", "q", "rest");
  for (const burnish::BounceReport& b : folder.bounces)
    fmt::print("  {:>6} {:>8.3g} % {:>8} {:>10}\n", b.bounce, 100 * b.change, b.ratio > 0 ? fmt::format("{:.3f}", b.ratio) : "-", std::isfinite(b.rest) ? fmt::format("{:.3g} %", 100 * b.rest) : "-");
}

}  // namespace

void printProbes(const burnish::ProbeFolder& folder, const std::string& name) {
  std::uint64_t bytes = 0;
  for (const auto& file : folder.files) bytes += file.bytes;
  fmt::print("{}\n", shown(name));
  if (folder.writer.empty()) fmt::print("format: probes, no set yet\n");
  else fmt::print("format: probes, written by {}, {} files of {:.2f} MB\n", shown(folder.writer), folder.files.size(), double(bytes) / 1e6);
  fmt::print("reflection probes: {}\n", folder.set.reflections.size());
  for (std::size_t i = 0; i < folder.set.reflections.size(); ++i) printReflection(folder.set.reflections[i], i);
  if (folder.set.grid) printGrid(*folder.set.grid);
  printBounces(folder);
  if (folder.joined > 0) fmt::print("work folder: {} bounces joined\n", folder.joined);
  fmt::print("wrong: {}\n", folder.wrong.empty() ? "nothing" : "");
  for (const std::string& text : folder.wrong) fmt::print("  {}\n", shown(text));
}

}  // namespace cli
