#include "probe/bake.h"

#include <fmt/format.h>

#include <chrono>

#include "prefilter/parallel.h"
#include "probe/folder.h"
#include "probe/shard.h"

namespace burnish::probe {
namespace {

namespace fs = std::filesystem;

/// Without --resume nothing may be there that this bake would take the place of.
Result<void> checkFresh(const Paths& paths, const StateFolder& states, bool resume) {
  if (resume) return {};
  std::error_code error;
  if (fs::exists(fs::symlink_status(paths.folder / kManifestName, error))) return fail(paths.folder.string(), "holds probes already", "--resume bakes what has changed in their place, or choose another folder");
  const auto state = states.state();
  if (state && !*state) return {};
  return fail(paths.folder.string(), "holds a bake that was not finished", "--resume goes on with it, or choose another folder");
}

/// All bounces, one after the other.
Result<std::vector<BounceReport>> allBounces(Baker& baker, const Paths& paths, const StateFolder& states, const BakeState& state, const Prepared& prepared, const BakeOptions& options, const BakeJob& job) {
  std::vector<BounceRecord> records;
  std::vector<BounceReport> reports;
  BounceLight light[2];
  do {
    const int bounce = int(records.size()) + 1;
    const BounceLight* before = bounce > 1 ? &light[(bounce - 1) % 2] : nullptr;
    BounceLight& now = light[bounce % 2];
    BounceRecord record;
    record.keys = prepared.keys.ofBounce(before ? std::span<const core::Hash128>(before->contents) : std::span<const core::Hash128>());
    const auto counts = baker.bounce(bounce, record.keys, before, reports, now);
    if (!counts) return fail(counts.error());
    const auto judged = judge(reports, changeOf(before ? before->irradiances() : std::vector<IrradianceSh>(), now.irradiances()));
    if (!judged) return fail(judged.error());
    record.report = *judged;
    const double begin = prefilter::cpuMilliseconds();
    if (auto ok = states.write(state.id, record); !ok) return fail(ok.error());
    baker.storeMs += prefilter::cpuMilliseconds() - begin;
    record.report.captured = counts->captured, record.report.reused = counts->reused;
    reports.push_back(record.report);
    records.push_back(std::move(record));
    if (job.bounced) job.bounced(reports.back());
  } while (wantsMore(reports, options));
  const double begin = prefilter::cpuMilliseconds();
  if (auto ok = finishBake(paths, state, prepared.places, baker.units(), records, light[records.size() % 2].lights); !ok) return fail(ok.error());
  baker.storeMs += prefilter::cpuMilliseconds() - begin;
  return reports;
}

Result<BakeReport> bakeWhole(const ProcAddress& getProcAddress, const Scene& scene, const BakeOptions& options, const BakeJob& job, Report& report) {
  const Paths paths(job.folder);
  if (auto made = ensureFolder(paths.folder); !made) return fail(made.error());
  const auto lock = WorkLock::take(paths.folder, Access::Alone);
  if (!lock) return fail(lock.error());
  const StateFolder states(paths.work);
  if (auto ok = checkFresh(paths, states, job.resume); !ok) return fail(ok.error());
  const auto prepared = prepare(getProcAddress, scene, options, report);
  if (!prepared) return fail(prepared.error());
  const double begin = prefilter::cpuMilliseconds();
  LightStore store(paths.light);
  if (auto ok = store.make(); !ok) return fail(ok.error());
  states.forget();
  BakeState state{prepared->id, prepared->options, options};
  if (auto ok = writePlaces(paths, prepared->places); !ok) return fail(ok.error());
  if (auto ok = states.write(state); !ok) return fail(ok.error());
  store.index(report);
  Baker baker(getProcAddress, paths, *prepared, options, job, store, report);
  baker.storeMs = prefilter::cpuMilliseconds() - begin;
  auto bounces = allBounces(baker, paths, states, state, *prepared, options, job);
  baker.takeWarnings();
  if (!bounces) return fail(bounces.error());
  return BakeReport{std::move(*bounces), baker.time.captureMs, baker.time.filterMs, baker.storeMs, 0};
}

}  // namespace

Result<void> writePlaces(const Paths& paths, const ProbeSet& places) {
  std::error_code error;
  fs::create_directory(paths.places, error);
  if (error) return fail(paths.places.string(), fmt::format("cannot be made ({})", error.message()), "check the permissions, or choose another folder");
  return writeSet(paths.places, places, nullptr);
}

}  // namespace burnish::probe

namespace burnish {

Result<BakeReport> bakeProbes(const ProcAddress& getProcAddress, const Scene& scene, const BakeOptions& options, const BakeJob& job, Report& report) {
  if (job.shards < 1 || job.shard < 0 || job.shard >= job.shards || job.bounce < 0) return fail("bake job", fmt::format("shard {} of {}, bounce {}", job.shard, job.shards, job.bounce), "give 0 <= shard < shards");
  if (job.shards > 1 && job.bounce == 0) return fail("bake job", "a shard of no bounce", "bake shards of one bounce at a time, and join them with mergeBounce()");
  if (auto ok = probe::checkBake(scene, options); !ok) return fail(ok.error());
  const auto begin = std::chrono::steady_clock::now();
  try {
    auto baked = job.bounce > 0 ? probe::bakeShard(getProcAddress, scene, options, job, report) : probe::bakeWhole(getProcAddress, scene, options, job, report);
    if (baked) baked->wallMs = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return baked;
  } catch (const std::bad_alloc&) {
    return fail(job.folder.string(), "there is not enough memory to bake it", "bake fewer or smaller probes");
  }
}

}  // namespace burnish
