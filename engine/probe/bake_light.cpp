// Light between bounces, and the end of a bake.
#include <fmt/format.h>

#include <algorithm>

#include "image/cube_file.h"
#include "probe/bake.h"
#include "probe/folder.h"

namespace burnish::probe {

std::vector<IrradianceSh> BounceLight::irradiances() const {
  std::vector<IrradianceSh> out;
  for (const PointLight& light : lights) out.push_back(light.irradiance);
  return out;
}

Result<PointLight> decoded(const StoredLight& stored, const std::string& name) {
  PointLight light;
  light.irradiance = stored.irradiance;
  if (stored.radiance.empty()) return light;
  auto file = image::decodeKtx2(stored.radiance, name, {.maxSide = kMostSize});
  if (!file) return fail(file.error());
  light.radiance = std::move(file->cube);
  return light;
}

Result<BounceLight> loadBounce(const LightStore& store, const Paths& paths, const std::vector<Unit>& units, std::span<const core::Hash128> keys, Report& report) {
  BounceLight out;
  if (units.empty() || keys.size() != std::size_t(units.back().first + units.back().count))
    return fail(paths.work.string(), fmt::format("holds a bounce of {} points, not of those of its places", keys.size()), "remove it, and bake again");
  for (const Unit& unit : units) {
    const auto lights = store.unit(unit, keys, report);
    const std::string name = (paths.light / unitName(unit, keys)).string();
    if (!lights) return fail(name, "is missing or damaged", "bake the shards of its bounce again with --resume, or the whole with --resume");
    for (const StoredLight& stored : *lights) {
      auto light = decoded(stored, name);
      if (!light) return fail(light.error());
      out.lights.push_back(std::move(*light));
      out.contents.push_back(stored.content);
    }
  }
  return out;
}

std::vector<BounceReport> reportsOf(std::span<const BounceRecord> records) {
  std::vector<BounceReport> out;
  for (const BounceRecord& r : records) out.push_back(r.report);
  return out;
}

Result<void> finishBake(const Paths& paths, const BakeState& state, const ProbeSet& places, const std::vector<Unit>& units, std::span<const BounceRecord> bounces, std::span<const PointLight> lights) {
  const BounceReport& last = bounces.back().report;
  if (state.stop.bounces == 0 && !(last.rest <= state.stop.until))
    return fail(paths.folder.string(), fmt::format("after {} bounces the estimated rest of the light is {:.3g}, over {:g}", last.bounce, last.rest, state.stop.until),
                "ask for a larger --until or a count with --bounces, or give the scene darker surfaces (--albedo-limit); --resume takes what is baked");
  BakeNotes notes;
  notes.id = state.id;
  notes.options = state.options;
  notes.bounces = reportsOf(bounces);
  const std::vector<core::Hash128>& keys = bounces.back().keys;
  notes.keys.assign(keys.begin(), keys.begin() + std::ptrdiff_t(places.reflections.size()));
  if (keys.size() > places.reflections.size()) {
    core::Hasher h;
    for (std::size_t i = places.reflections.size(); i < keys.size(); ++i) h.hash(keys[i]);
    notes.gridKey = h.finish();
  }
  if (auto ok = writeSet(paths.folder, withLight(places, lights), &notes); !ok) return ok;
  std::set<std::string> names;
  for (const BounceRecord& bounce : bounces)
    for (const Unit& unit : units) names.insert(unitName(unit, bounce.keys));
  LightStore(paths.light).keepOnly(names);
  return {};
}

}  // namespace burnish::probe
