#include <burnish/probe.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>

#include "cost/choices_scenes.h"

namespace burnish::cost {
namespace {

constexpr int kSize = 64;                 ///< texels along an edge of a capture
constexpr std::size_t kMostProbes = 12;   ///< the nearest to the eye
constexpr double kLeastSeconds = 20;      ///< of wall time, for places and for each bake
constexpr int kBounces[] = {1, 2, 4};

/// Gone with whatever is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code ignored;
    path_ = std::filesystem::temp_directory_path(ignored) / fmt::format("burnish-cost-{}", getpid());
    std::filesystem::remove_all(path_, ignored);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The `count` probes nearest to the eye, in the order that they had.
void keepNearest(std::vector<ReflectionProbe>& probes, glm::dvec3 eye, std::size_t count) {
  std::vector<double> distances;
  for (const ReflectionProbe& p : probes) distances.push_back(glm::distance(p.center, eye));
  std::vector<double> sorted = distances;
  std::sort(sorted.begin(), sorted.end());
  if (count >= sorted.size()) return;
  const double farthest = count == 0 ? -1 : sorted[count - 1];
  std::vector<ReflectionProbe> kept;
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (distances[i] <= farthest && kept.size() < count) kept.push_back(std::move(probes[i]));
  probes = std::move(kept);
}

void add(SceneChoice& choice, ProbeSet probes, std::string name, double onceMs, std::string note = {}) {
  SceneSetting& s = choice.settings.emplace_back();
  s.name = std::move(name), s.note = std::move(note), s.onceMs = onceMs;
  s.apply = [probes = std::make_shared<const ProbeSet>(std::move(probes))](Scene& scene) {
    const std::uint64_t revision = scene.probes.revision + 1;
    scene.probes = *probes;
    scene.probes.revision = revision;
  };
}

bool baked(const ProbeSet& set) {
  return !set.reflections.empty() && std::all_of(set.reflections.begin(), set.reflections.end(), [](const ReflectionProbe& p) { return !p.radiance.levels.empty(); });
}

/// Places without light: the scene's, or its rooms'.
Result<std::vector<ReflectionProbe>> placesOf(const Scene& scene) {
  std::vector<ReflectionProbe> places = scene.probes.reflections;
  if (places.empty()) {
    Report ignored;
    PlacementOptions options;
    options.grid = false;
    auto found = placeProbes(scene, options, ignored);
    if (!found) return fail(found.error());
    places = std::move(found->reflections);
  }
  for (ReflectionProbe& p : places) p.radiance = {}, p.irradiance = {};
  return places;
}

}  // namespace

Result<SceneChoice> probeChoice(const ProcAddress& getProcAddress, const Bench& bench, const std::function<double()>& secondsLeft, std::string& idle) {
  SceneChoice choice;
  const Scene& scene = bench.scene();
  const std::string late = "the time was too short for a bake";
  if (secondsLeft() < kLeastSeconds) return idle = late, choice;
  auto places = placesOf(scene);
  if (!places) return fail(places.error());
  if (places->empty()) return idle = "the scene has no probes, and no rooms were found in it", choice;
  keepNearest(*places, bench.view().eye, kMostProbes);
  choice.name = "probes";
  choice.what = fmt::format("reflection probes and the bounces of light in them; captures of {0} x {0} texels, no lattice; the time of its pass is the bake's, once", kSize);
  const std::size_t found = places->size(), given = scene.probes.reflections.size();
  choice.calledBy = given > 0 ? fmt::format("the scene's {} reflection probes", given) : found == 1 ? std::string("1 room that was found") : fmt::format("{} rooms that were found", found);
  const bool own = baked(scene.probes);
  add(choice, {}, "none", 0);
  choice.settings.back().inForce = scene.probes.reflections.empty() && !scene.probes.grid;
  Scene toBake = scene;
  toBake.probes = {};
  toBake.probes.reflections = *places;
  const TemporaryFolder folder;
  ProbeSet best;
  double sum = 0, last = 0;
  for (const int bounces : kBounces) {
    if (secondsLeft() < std::max(kLeastSeconds, 3 * last)) break;
    BakeOptions options;
    options.quality = bench.base();
    options.size = kSize;
    options.bounces = bounces;
    BakeJob job;
    job.folder = folder.path();
    job.resume = bounces != kBounces[0];  // the bounces before are still right
    Report ignored;
    const auto done = bakeProbes(getProcAddress, toBake, options, job, ignored);
    if (!done) return fail(done.error());
    sum += done->captureMs + done->filterMs + done->storeMs, last = done->wallMs / 1000;
    auto set = readProbes(folder.path(), ignored);
    if (!set) return fail(set.error());
    best = std::move(*set);
    add(choice, best, fmt::format("{} of {}, {} bounce{}", best.reflections.size(), best.reflections.size(), bounces, bounces == 1 ? "" : "s"), sum);
  }
  if (choice.settings.size() < 2) return idle = late, SceneChoice{};
  // Fewer of them, lit as the last ones are.
  const std::size_t all = best.reflections.size();
  const std::string light = choice.settings.back().name.substr(choice.settings.back().name.find(','));
  std::vector<std::size_t> counts;
  for (const std::size_t count : {std::size_t(1), all / 2})
    if (count > 0 && count < all && (counts.empty() || counts.back() != count)) counts.push_back(count);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    ProbeSet fewer = best;
    keepNearest(fewer.reflections, bench.view().eye, counts[i]);
    add(choice, std::move(fewer), fmt::format("{} of {}{}", counts[i], all, light), sum, "the nearest to the eye");
    std::rotate(choice.settings.begin() + std::ptrdiff_t(1 + i), choice.settings.end() - 1, choice.settings.end());
  }
  if (own) {
    add(choice, scene.probes, "the scene's own", 0, "as it was loaded");
    choice.settings.back().inForce = true;
  }
  choice.exact = choice.settings.size() - 1;
  return choice;
}

}  // namespace burnish::cost
