#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "probe/work.h"

namespace burnish::probe {
namespace {

namespace fs = std::filesystem;

Result<void> locked(int fd, Access access, const fs::path& folder) {
  int result = 0;
  do result = ::flock(fd, (access == Access::Alone ? LOCK_EX : LOCK_SH) | LOCK_NB);
  while (result != 0 && errno == EINTR);
  if (result == 0) return {};
  if (errno == EWOULDBLOCK) return fail(folder.string(), "another bake is writing here", "wait for it, or choose another folder");
  return fail(folder.string(), fmt::format("cannot be locked ({})", std::strerror(errno)), "choose a folder on a file system that has locks");
}

}  // namespace

Result<WorkLock> WorkLock::take(const fs::path& folder, Access access) {
  const fs::path work = folder / kWorkName;
  std::error_code error;
  fs::create_directory(work, error);
  if (error) return fail(work.string(), fmt::format("cannot be made ({})", error.message()), "check the permissions, or choose another folder");
  WorkLock lock;
  for (const std::string_view name : {kStateLockName, kLockName}) {
    lock.fd_.reset(::open((work / name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
    if (!lock.fd_) return fail((work / name).string(), fmt::format("cannot be opened ({})", std::strerror(errno)), "check the permissions, or choose another folder");
  }
  if (auto ok = locked(lock.fd_.get(), access, folder); !ok) return fail(ok.error());
  return lock;
}

Result<void> WorkLock::share() { return locked(fd_.get(), Access::Shared, kWorkName); }
bool WorkLock::alone() {
  if (locked(fd_.get(), Access::Alone, kWorkName)) return true;
  // A failed change may have let the old lock go (flock(2)).
  (void)locked(fd_.get(), Access::Shared, kWorkName);
  return false;
}

Result<WorkLock> lockIfWork(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder / kWorkName / kLockName, error)) return WorkLock();
  return WorkLock::take(folder, Access::Alone);
}

}  // namespace burnish::probe
