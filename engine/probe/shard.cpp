#include "probe/shard.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <cerrno>
#include <cstring>

#include "probe/folder.h"

namespace burnish::probe {
namespace {

namespace fs = std::filesystem;

/// Shards that start at one time look at and change a bake's state one after the other. Short; the bakes themselves go on side by side.
Result<core::UniqueFd> stateLock(const Paths& paths) {
  core::UniqueFd fd(::open((paths.work / kStateLockName).c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
  int result = fd ? 0 : -1;
  while (fd && (result = ::flock(fd.get(), LOCK_EX)) != 0 && errno == EINTR) {
  }
  if (result != 0) return fail((paths.work / kStateLockName).string(), fmt::format("cannot be locked ({})", std::strerror(errno)), "check the permissions, or choose another folder");
  return fd;
}

Result<void> begin(const Paths& paths, const StateFolder& states, const Prepared& prepared, const BakeOptions& options) {
  if (auto ok = LightStore(paths.light).make(); !ok) return ok;
  states.forget();
  if (auto ok = writePlaces(paths, prepared.places); !ok) return ok;
  return states.write(BakeState{prepared.id, prepared.options, options});
}

/// Begins a bake or joins the one that is there.
Result<void> join(WorkLock& lock, const Paths& paths, const StateFolder& states, const Prepared& prepared, const BakeOptions& options, const BakeJob& job) {
  const std::string folder = paths.folder.string();
  const auto state = states.state();
  if (!state && !(job.resume && job.bounce == 1)) return fail(state.error());
  if (state && *state && (*state)->id == prepared.id) return {};
  if (job.bounce > 1)
    return fail(folder, state && *state ? "holds the bake of another scene or of other options" : fmt::format("holds no bake whose bounce {} could be baked", job.bounce), "give all shards the same scene and options, from bounce 1 on");
  std::error_code error;
  const bool other = !state || *state, finished = fs::exists(fs::symlink_status(paths.folder / kManifestName, error));
  if ((other || finished) && !job.resume)
    return fail(folder, other ? "holds the bake of another scene or of other options" : "holds probes already", "--resume begins anew and takes what still holds, or choose another folder");
  if (other && !lock.alone()) return fail(folder, "other shards bake another scene or with other options here", "wait for them, or choose another folder");
  auto begun = begin(paths, states, prepared, options);
  if (other)
    if (auto shared = lock.share(); !shared) return shared;
  return begun;
}

/// The bounces that are joined, as many as this one needs.
Result<std::vector<BounceRecord>> joinedBounces(const Paths& paths, const StateFolder& states, const Prepared& prepared, const BakeJob& job) {
  auto joined = states.bounces(prepared.id);
  if (!joined) return fail(joined.error());
  if (int(joined->size()) < job.bounce - 1)
    return fail(paths.folder.string(), fmt::format("bounce {} cannot be baked: bounce {} is not joined", job.bounce, joined->size() + 1), "bake all of its shards, and join them: burnish bake --merge");
  if (int(joined->size()) >= job.bounce && !job.resume) return fail(paths.folder.string(), fmt::format("bounce {} is joined already", job.bounce), fmt::format("bake bounce {}; --resume mends what is damaged", joined->size() + 1));
  return joined;
}

}  // namespace

Result<BakeReport> bakeShard(const ProcAddress& getProcAddress, const Scene& scene, const BakeOptions& options, const BakeJob& job, Report& report) {
  const Paths paths(job.folder);
  if (auto made = ensureFolder(paths.folder); !made) return fail(made.error());
  auto lock = WorkLock::take(paths.folder, Access::Shared);
  if (!lock) return fail(lock.error());
  const auto prepared = prepare(getProcAddress, scene, options, report);
  if (!prepared) return fail(prepared.error());
  const StateFolder states(paths.work);
  auto held = stateLock(paths);
  if (!held) return fail(held.error());
  if (auto ok = join(*lock, paths, states, *prepared, options, job); !ok) return fail(ok.error());
  held->reset();
  const auto joined = joinedBounces(paths, states, *prepared, job);
  if (!joined) return fail(joined.error());

  LightStore store(paths.light);
  store.index(report);
  BounceLight before, now;
  if (job.bounce > 1) {
    auto loaded = loadBounce(store, paths, unitsOf(prepared->places), (*joined)[std::size_t(job.bounce - 2)].keys, report);
    if (!loaded) return fail(loaded.error());
    before = std::move(*loaded);
  }
  PartRecord part{.bounce = job.bounce, .shard = job.shard, .shards = job.shards, .captured = 0, .reused = 0, .keys = prepared->keys.ofBounce(before.contents)};
  const auto log = reportsOf(*joined);
  Baker baker(getProcAddress, paths, *prepared, options, job, store, report);
  const auto counts = baker.bounce(job.bounce, part.keys, job.bounce > 1 ? &before : nullptr, std::span(log).first(std::size_t(job.bounce - 1)), now);
  baker.takeWarnings();
  if (!counts) return fail(counts.error());
  part.captured = counts->captured, part.reused = counts->reused;
  if (int(joined->size()) < job.bounce)
    if (auto ok = states.write(prepared->id, part); !ok) return fail(ok.error());
  return BakeReport{{*counts}, baker.time.captureMs, baker.time.filterMs, baker.storeMs, 0};
}

}  // namespace burnish::probe
