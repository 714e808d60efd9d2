#include <fmt/format.h>

#include <algorithm>

#include "cost/choices_scenes.h"

namespace burnish::cost {
namespace {

struct Filter {
  int size;
  double error;
};
constexpr Filter kFilters[] = {{64, 1e-4}, {128, 1e-4}, {256, 1e-2}, {256, 1e-4}, {256, 1e-6}, {512, 1e-4}};
constexpr Filter kExact{1024, 1e-6};

/// CPU time of the filter, without tables that later calls find made.
Result<double> filterMs(const Image& map, Filter f) {
  PrefilterOptions options;
  options.size = f.size, options.error = f.error;
  PrefilterReport report;
  if (auto made = prefilterCubemap(map, options, &report); !made) return fail(made.error());
  return std::max(report.cpuMs - report.tablesMs, 0.0);
}

std::uint64_t bytesOf(int size) {
  std::uint64_t texels = 0;
  for (int s = size; s >= 8; s /= 2) texels += 6ull * std::uint64_t(s) * std::uint64_t(s);
  return 8 * texels;
}

}  // namespace

Result<SceneChoice> filterChoice(const Bench& bench, std::string& idle) {
  SceneChoice choice;
  const FramePlan plan = bench.plan(bench.base());
  const Environment& e = bench.scene().environment;
  const bool read = std::any_of(plan.passes.begin(), plan.passes.end(), [](const PassPlan& p) { return std::find(p.reads.begin(), p.reads.end(), "environment cube") != p.reads.end(); });
  if (!read || e.map.empty()) {
    idle = read ? "the surroundings are one colour: there is nothing to filter" : "no reflections of the surroundings are looked up";
    return choice;
  }
  choice.name = "prefilter";
  choice.what = "how the surroundings are filtered for reflections: texels along an edge of the cube, allowed error; the time of its pass is the filter's, once, when the map is loaded";
  choice.calledBy = "environment_lighting: the environment map";
  std::vector<Filter> filters(std::begin(kFilters), std::end(kFilters));
  if (std::none_of(filters.begin(), filters.end(), [&](Filter f) { return f.size == e.filterSize && f.error == e.filterError; })) filters.push_back({e.filterSize, e.filterError});
  std::stable_sort(filters.begin(), filters.end(), [](Filter a, Filter b) { return a.size != b.size ? a.size < b.size : a.error > b.error; });
  filters.push_back(kExact);
  for (const Filter f : filters) {
    const auto ms = filterMs(e.map, f);
    if (!ms) return fail(ms.error());
    SceneSetting& s = choice.settings.emplace_back();
    s.name = fmt::format("{} at {:.0e}", f.size, f.error);
    s.note = fmt::format("{:.1f} MB", double(bytesOf(f.size)) / 1e6);
    s.inForce = f.size == e.filterSize && f.error == e.filterError;
    s.onceMs = *ms;
    s.apply = [f](Scene& scene) {
      scene.environment.filterSize = f.size, scene.environment.filterError = f.error;
      ++scene.environment.revision;
    };
  }
  choice.exact = choice.settings.size() - 1;
  return choice;
}

}  // namespace burnish::cost
