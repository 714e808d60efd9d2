// Joining the shards of a bounce: files alone, neither a scene nor a context.
#include <fmt/format.h>

#include <algorithm>

#include "probe/bake.h"
#include "probe/folder.h"

namespace burnish::probe {
namespace {

namespace fs = std::filesystem;

/// The parts are those of all shards, once each, and agree. `sum`: captured and reused.
Result<void> checkParts(const Paths& paths, const std::vector<PartRecord>& parts, int bounce, BounceReport& sum) {
  const std::string folder = paths.folder.string();
  if (parts.empty()) return fail(folder, fmt::format("no shard of bounce {} is baked", bounce), fmt::format("bake them: burnish bake SCENE -o {} --shard I/N --bounce {}", folder, bounce));
  const int shards = parts.front().shards;
  std::vector<bool> there(std::size_t(shards), false);
  for (const PartRecord& part : parts) {
    if (part.shards != shards) return fail(folder, fmt::format("bounce {} has shards of {} and of {}", bounce, shards, part.shards), "remove the parts of one kind from work/, or bake all shards of one kind");
    if (part.keys != parts.front().keys) return fail(folder, fmt::format("shards {} and {} of bounce {} do not agree on what is baked", parts.front().shard + 1, part.shard + 1, bounce), "bake them again");
    there[std::size_t(part.shard)] = true;
    sum.captured += part.captured, sum.reused += part.reused;
  }
  std::string missing;
  for (int i = 0; i < shards; ++i)
    if (!there[std::size_t(i)]) missing += fmt::format("{}{}/{}", missing.empty() ? "" : ", ", i + 1, shards);
  if (!missing.empty()) return fail(folder, fmt::format("bounce {} is not baked by shard {}", bounce, missing), "wait for it, or bake it");
  return {};
}

struct Merging {
  const Paths& paths;
  const BakeState& state;
  const ProbeSet& places;
  std::vector<Unit> units;
  LightStore store;
  Report& report;
};

Result<MergeReport> joinNext(Merging& m, const StateFolder& states, std::vector<BounceRecord> joined) {
  const int bounce = int(joined.size()) + 1;
  MergeReport out;
  const auto parts = states.parts(m.state.id, bounce);
  if (!parts) return fail(parts.error());
  if (auto ok = checkParts(m.paths, *parts, bounce, out.bounce); !ok) return fail(ok.error());
  const auto now = loadBounce(m.store, m.paths, m.units, parts->front().keys, m.report);
  if (!now) return fail(now.error());
  std::vector<IrradianceSh> before;
  if (!joined.empty()) {
    const auto light = loadBounce(m.store, m.paths, m.units, joined.back().keys, m.report);
    if (!light) return fail(light.error());
    before = light->irradiances();
  }
  const auto judged = judge(reportsOf(joined), changeOf(before, now->irradiances()));
  if (!judged) return fail(judged.error());
  joined.push_back({*judged, parts->front().keys});
  if (auto ok = states.write(m.state.id, joined.back()); !ok) return fail(ok.error());
  states.forgetParts(bounce);
  const BounceReport counts = out.bounce;
  out.bounce = *judged;
  out.bounce.captured = counts.captured, out.bounce.reused = counts.reused;
  if (wantsMore(reportsOf(joined), m.state.stop)) return out;
  out.finished = true;
  if (auto ok = finishBake(m.paths, m.state, m.places, m.units, joined, now->lights); !ok) return fail(ok.error());
  return out;
}

/// All bounces are joined: the set may still have to be written.
Result<MergeReport> finishAgain(Merging& m, const std::vector<BounceRecord>& joined) {
  Report ignored;
  const auto old = readManifest(m.paths.folder, ignored);
  if (old && old->bake && old->bake->id == m.state.id) return fail(m.paths.folder.string(), fmt::format("the bake is finished, after {} bounces", joined.size()), "there is nothing to join");
  const auto light = loadBounce(m.store, m.paths, m.units, joined.back().keys, m.report);
  if (!light) return fail(light.error());
  if (auto ok = finishBake(m.paths, m.state, m.places, m.units, joined, light->lights); !ok) return fail(ok.error());
  return MergeReport{joined.back().report, true};
}

Result<MergeReport> merge(const fs::path& folder, Report& report) {
  const Paths paths(folder);
  std::error_code error;
  if (!fs::exists(paths.work / kLockName, error)) return fail(folder.string(), "holds no bake", "bake the shards of bounce 1 into it first");
  const auto lock = WorkLock::take(folder, Access::Alone);
  if (!lock) return fail(lock.error());
  const StateFolder states(paths.work);
  const auto state = states.state();
  if (!state) return fail(state.error());
  if (!*state) return fail(folder.string(), "holds no bake", "bake the shards of bounce 1 into it first");
  const auto places = readSet(paths.places, report);
  if (!places) return fail(places.error());
  auto joined = states.bounces((*state)->id);
  if (!joined) return fail(joined.error());
  Merging m{paths, **state, places->set, unitsOf(places->set), LightStore(paths.light), report};
  if (!joined->empty() && !wantsMore(reportsOf(*joined), (*state)->stop)) return finishAgain(m, *joined);
  return joinNext(m, states, std::move(*joined));
}

}  // namespace
}  // namespace burnish::probe

namespace burnish {

Result<MergeReport> mergeBounce(const std::filesystem::path& folder, Report& report) {
  try {
    return probe::merge(folder, report);
  } catch (const std::bad_alloc&) {
    return fail(folder.string(), "there is not enough memory to join it", "join it on a machine with more");
  }
}

}  // namespace burnish
