// The work folder of a bake: who may write, and what is kept between bounces and between bakes (docs/probe_files.md, "work/").
#pragma once
#include <burnish/result.h>

#include <filesystem>
#include <string_view>

#include "core/unique_fd.h"

namespace burnish::probe {

inline constexpr std::string_view kWorkName = "work", kLockName = "lock", kStateLockName = "state_lock";

enum class Access { Shared, Alone };

/// Holds a folder of probes for as long as it lives, against other programs and against other bakes of this one (flock on work/lock). Shards share a folder; all others are alone in it.
class WorkLock {
 public:
  WorkLock() = default;
  /// Makes work/ and its lock files if they are missing. At once: a folder in use is an error.
  static Result<WorkLock> take(const std::filesystem::path& folder, Access access);
  /// From Alone to Shared.
  Result<void> share();
  /// From Shared to Alone; false: others hold it, and it stays shared.
  bool alone();

 private:
  core::UniqueFd fd_;
};

/// Alone, where the folder has a work folder; else nothing is held and nothing made.
Result<WorkLock> lockIfWork(const std::filesystem::path& folder);

}  // namespace burnish::probe
