#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "probe/bake.h"
#include "probe/capture.h"
#include "probe/geometry.h"
#include "probe/visibility.h"

namespace burnish::probe {
namespace {

Result<void> checkSize(int size, const char* what) {
  if (size >= 16 && size <= kMostSize && std::has_single_bit(unsigned(size))) return {};
  return fail("bake options", fmt::format("{} is {}", what, size), fmt::format("give a power of two from 16 to {}", kMostSize));
}

/// The scene's places without light.
ProbeSet placesOf(const Scene& scene) {
  ProbeSet places = scene.probes;
  for (ReflectionProbe& p : places.reflections) p.radiance = {}, p.irradiance = {};
  if (places.grid)
    for (AmbientGrid::Point& p : places.grid->points) p.irradiance = {};
  places.revision = 0;
  return places;
}

}  // namespace

Result<void> checkBake(const Scene& scene, const BakeOptions& o) {
  if (auto ok = checkSize(o.size, "size"); !ok) return ok;
  if (auto ok = checkSize(o.ambientSize, "ambientSize"); !ok) return ok;
  if (!(o.until > 0 && o.until <= 1)) return fail("bake options", fmt::format("until is {}", o.until), "give a share above 0, at most 1");
  if (o.bounces < 0 || o.maxBounces < 1) return fail("bake options", fmt::format("bounces is {}, maxBounces {}", o.bounces, o.maxBounces), "give at least 0 and 1");
  if (!(o.albedoLimit >= 0 && o.albedoLimit <= 1)) return fail("bake options", fmt::format("albedoLimit is {}", o.albedoLimit), "give 0 to 1");
  if (scene.probes.reflections.empty() && !scene.probes.grid)
    return fail(scene.name.empty() ? "the scene" : scene.name, "has no places for probes", "add nodes for them (docs/probes.md), or have them found: burnish bake --auto, placeProbes()");
  return checkSet(placesOf(scene), scene.name.empty() ? "the scene's probes" : scene.name);
}

Result<Prepared> prepare(const ProcAddress& getProcAddress, const Scene& scene, const BakeOptions& options, Report& report) {
  const auto capabilities = queryCapabilities(getProcAddress);
  if (!capabilities) return fail(capabilities.error());
  Prepared out;
  out.places = placesOf(scene);
  out.scene = limited(scene, options.albedoLimit, options.quality, report);
  out.scene.probes = {};
  const auto geometry = Geometry::create(out.scene, &report);
  if (!geometry) return fail(geometry.error());
  if (AmbientGrid* grid = out.places.grid ? &*out.places.grid : nullptr; grid && grid->points.empty())
    if (auto filled = fillPoints(*geometry, *grid, options.threads); !filled) return fail(filled.error());
  if (captureCount(out.places) == 0) return fail(scene.name.empty() ? "the scene" : scene.name, "none of its lattice's points is free", "move the lattice, or add a reflection probe");
  out.keys = Keys::make(out.scene, *geometry, out.places, options, *capabilities);
  out.options = optionsJson(options, fmt::format("{} ({})", capabilities->renderer, capabilities->version));
  core::Hasher id;
  id.text(out.options.dump());
  for (const core::Hash128& key : out.keys.ofBounce({})) id.hash(key);
  // Names and boxes go into the set's manifest whether or not a capture sees them.
  Manifest places;
  for (const ReflectionProbe& p : out.places.reflections) places.reflections.push_back({p, {}, 0, 0, 1});
  if (out.places.grid) places.grid = {*out.places.grid, {}, {}};
  id.text(manifestText(places));
  out.id = id.finish();
  return out;
}

}  // namespace burnish::probe
