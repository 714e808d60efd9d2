// traceReference: passes over the picture until it is good enough.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <new>
#include <utility>

#include "pathtrace/film.h"
#include "pathtrace/integrator.h"
#include "pathtrace/state.h"
#include "prefilter/parallel.h"

namespace burnish {
namespace pathtrace {
namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

constexpr int kTile = 16;               // pixels along a side
constexpr int kMaxSide = 16384;
constexpr std::int64_t kMaxPixels = std::int64_t(1) << 26;
constexpr int kMaxSamples = 1'000'000;
constexpr double kPassSeconds = 2;      // how often the caller hears of it
constexpr double kStateSeconds = 30;    // and how often the state is kept
constexpr int kLeastSamples = 16;       // before untilError counts

Result<void> checkOptions(const ReferenceOptions& o) {
  if (o.size.x < 1 || o.size.y < 1 || o.size.x > kMaxSide || o.size.y > kMaxSide || std::int64_t(o.size.x) * o.size.y > kMaxPixels)
    return fail("reference", fmt::format("a picture of {} x {} pixels", o.size.x, o.size.y), fmt::format("sides of 1 to {} and {} pixels in all can be traced", kMaxSide, kMaxPixels));
  if (o.samples < 1 || o.samples > kMaxSamples) return fail("reference", fmt::format("{} samples", o.samples), fmt::format("1 to {} can be taken", kMaxSamples));
  return {};
}

class Tracer {
 public:
  Tracer(const World& world, const ReferenceOptions& options, Film& film)
      : world_(world), integrator_(world, options.bounces), options_(options), film_(film), threads_(prefilter::threadsFor(options.threads)) {}

  /// Takes each pixel to `samples`.
  void pass(int samples) {
    const glm::ivec2 tiles = (film_.size() + kTile - 1) / kTile;
    std::atomic<std::uint64_t> dropped{0};
    prefilter::forEachPiece(tiles.x * tiles.y, threads_, [&](int i) { dropped += tile(glm::ivec2(i % tiles.x, i / tiles.x) * kTile, samples); });
    film_.samples = samples;
    film_.dropped += dropped;
  }

 private:
  std::uint64_t tile(glm::ivec2 from, int samples) {
    std::uint64_t dropped = 0;
    const glm::ivec2 to = glm::min(from + kTile, film_.size());
    for (int y = from.y; y < to.y; ++y)
      for (int x = from.x; x < to.x; ++x) {
        const std::uint32_t index = std::uint32_t(y) * std::uint32_t(film_.size().x) + std::uint32_t(x);
        Pixel& pixel = film_.pixels()[index];
        for (int s = film_.samples; s < samples; ++s) dropped += !pixel.add(std::uint32_t(s), sample({x, y}, index, std::uint32_t(s)));
      }
    return dropped;
  }

  FilmSample sample(glm::ivec2 pixel, std::uint32_t index, std::uint32_t number) const {
    FilmSample out;
    Sampler sampler(options_.seed, index, number);
    const glm::dvec2 place(sampler.next2());
    const PathRay ray = world_.cameraRay(glm::dvec2(pixel) + (options_.pixelArea ? place : glm::dvec2(0.5)));
    out.radiance = integrator_.radiance(ray, sampler, out.direct, out.features);
    return out;
  }

  const World& world_;
  Integrator integrator_;
  const ReferenceOptions& options_;
  Film& film_;
  int threads_;
};

// Up to the end of a group, where the noise is looked at; less where passes take long. What a sample is does not depend on it.
int nextStop(const Film& film, int wanted, double secondsASample) {
  const int group = (film.samples / Sampler::kGroup + 1) * Sampler::kGroup, most = secondsASample > 0 ? std::max(int(kPassSeconds / secondsASample), 1) : 1;
  return std::min({wanted, group, film.samples + most});
}

Result<void> run(Tracer& tracer, const ReferenceOptions& options, const core::Hash128& key, Film& film) {
  const Clock::time_point began = Clock::now();
  Clock::time_point kept = began;
  double perSample = 0;
  const int first = film.samples;
  while (film.samples < options.samples) {
    const bool looked = film.samples >= kLeastSamples && film.samples % Sampler::kGroup == 0;
    if (options.untilError > 0 && looked && film.error() < options.untilError) break;
    const Clock::time_point start = Clock::now();
    const int before = film.samples;
    tracer.pass(nextStop(film, options.samples, perSample));
    perSample = secondsSince(start) / (film.samples - before);
    if (!options.state.empty() && secondsSince(kept) > kStateSeconds) {
      if (auto written = writeState(options.state, key, film); !written) return written;
      kept = Clock::now();
    }
    if (options.progress && !options.progress({film.samples, options.samples, film.error(), secondsSince(began)})) break;
  }
  if (options.state.empty() || film.samples == first) return {};
  return writeState(options.state, key, film);
}

}  // namespace
}  // namespace pathtrace

Result<ReferencePicture> traceReference(const Scene& scene, const View& view, const Quality& quality, const ReferenceOptions& options, Report& report) try {
  using namespace pathtrace;
  if (auto good = checkOptions(options); !good) return fail(good.error());
  auto world = World::create(scene, view, quality, options.size, report);
  if (!world) return fail(world.error());
  Film film(options.size);
  core::Hash128 key;
  if (!options.state.empty()) {
    key = keyOf(scene, view, world->rungs(), options);
    if (auto found = readState(options.state, key, film); !found) return fail(found.error());
  }
  Tracer tracer(*world, options, film);
  if (auto done = run(tracer, options, key, film); !done) return fail(done.error());
  if (film.dropped) report.warn("reference", fmt::format("{} samples were not finite: they do not count", film.dropped));
  ReferencePicture picture = film.picture();
  picture.seed = options.seed;
  picture.bounces = std::max(options.bounces, -1);
  picture.pixelArea = options.pixelArea;
  return picture;
} catch (const std::bad_alloc&) {
  return fail("reference", "memory runs out", "trace a smaller picture or scene");
}

}  // namespace burnish
