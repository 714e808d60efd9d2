// Writing files so that they are complete or absent (burnish/core/file.h).
// The classic order: write under another name in the same folder, fsync, rename, fsync the folder (see "Ensuring data
// reaches disk", LWN 457667). The other name exists only between linkat and rename where the file system has O_TMPFILE.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cerrno>
#include <chrono>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "core/file.h"
#include "core/unique_fd.h"
#include "core/write_pending.h"

namespace burnish::core {

namespace fs = std::filesystem;

tl::unexpected<Error> writeError(const fs::path& file, const char* step, int error) {
  const char* remedy = error == ENOSPC || error == EDQUOT    ? "make room on the disk; an old file was left as it was"
                       : error == EFBIG                      ? "raise the file size limit (ulimit -f)"
                       : error == EACCES || error == EPERM   ? "check the permissions of the file and its folder"
                       : error == ENOENT || error == ENOTDIR ? "create the folder first"
                       : error == EROFS                      ? "choose a folder that can be written to"
                                                             : "check the disk";
  return fail(file.string(), fmt::format("{} failed ({})", step, std::strerror(error)), remedy);
}

bool writeAll(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), std::min<std::size_t>(bytes.size(), 1u << 30));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

bool flushed(int fd) { return ::fsync(fd) == 0 || errno == EINVAL || errno == ENOTSUP || errno == EROFS; }

std::string temporaryName() {
  std::uint64_t random = 0;
  if (::getrandom(&random, sizeof random, GRND_NONBLOCK) != sizeof random)
    random = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count()) ^
             (std::uint64_t(::getpid()) << 40);
  return fmt::format(".burnish-{:016x}.tmp", random);
}

bool fitsSizeLimit(std::size_t size) {
  struct rlimit limit {};
  return ::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || size <= limit.rlim_cur;
}

namespace {

/// N of /dev/fd/N and /proc/self/fd/N: what /dev/stdout leads to; -1 for other paths. Opening such a path again would
/// start at offset 0 and fails for sockets; the descriptor itself is what the caller means.
int descriptorNamed(const fs::path& path) {
  const std::string& text = path.native();
  for (std::string_view prefix : {"/dev/fd/", "/proc/self/fd/"})
    if (text.starts_with(prefix) && text.size() > prefix.size() && text.size() < prefix.size() + 7 &&
        text.find_first_not_of("0123456789", prefix.size()) == std::string::npos)
      return std::atoi(text.c_str() + prefix.size());
  return -1;
}

/// Follows the links of the last path component, so that a link's target is replaced and not the link.
Result<fs::path> linkTarget(fs::path path) {
  const fs::path asked = path;
  for (int hops = 0; hops < 40; ++hops) {
    if (descriptorNamed(path) >= 0) return path;
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0 || !S_ISLNK(status.st_mode)) return path;
    char buffer[PATH_MAX];
    const ssize_t n = ::readlink(path.c_str(), buffer, sizeof buffer);
    if (n <= 0 || n >= static_cast<ssize_t>(sizeof buffer)) return path;
    path = path.parent_path() / fs::path(std::string(buffer, static_cast<std::size_t>(n)));
  }
  return writeError(asked, "following its symbolic links", ELOOP);
}

/// For pipes, terminals and devices: no temporary name can help there.
Result<void> writeStraight(const fs::path& file, UniqueFd fd, std::span<const std::byte> bytes) {
  if (!fd) return writeError(file, "opening it for writing", errno);
  if (!writeAll(fd.get(), bytes)) return writeError(file, "writing", errno);
  return {};
}

/// A file being written in `folder`: without a name where possible, else under a temporary one; removed unless renamed.
class PendingFile {
 public:
  explicit PendingFile(const fs::path& folder) : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {}
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  ~PendingFile() {
    if (!name_.empty()) ::unlinkat(folder_.get(), name_.c_str(), 0);
  }

  bool create() {
    if (!folder_) return false;
    fd_.reset(::openat(folder_.get(), ".", O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666));
    if (fd_ && ::access(fmt::format("/proc/self/fd/{}", fd_.get()).c_str(), F_OK) == 0) return true;
    return createNamed();
  }
  [[nodiscard]] int fd() const { return fd_.get(); }

  /// Gives the file its temporary name if it has none, then the final one, then flushes the folder.
  bool renameTo(const std::string& name) {
    if (name_.empty() && !linkName()) return false;
    if (const int fd = fd_.release(); ::close(fd) != 0 && errno != EINTR) return false;  // NFS reports a full disk here
    if (::renameat(folder_.get(), name_.c_str(), folder_.get(), name.c_str()) != 0) return false;
    name_.clear();
    ::fsync(folder_.get());  // a folder that cannot be flushed still holds the file
    return true;
  }

 private:
  bool createNamed() {
    for (int tries = 0; tries < 16; ++tries) {
      std::string name = temporaryName();
      fd_.reset(::openat(folder_.get(), name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
      if (fd_) {
        name_ = std::move(name);
        return true;
      }
      if (errno != EEXIST) return false;
    }
    return false;
  }
  bool linkName() {
    for (int tries = 0; tries < 16; ++tries) {
      std::string name = temporaryName();
      if (::linkat(AT_FDCWD, fmt::format("/proc/self/fd/{}", fd_.get()).c_str(), folder_.get(), name.c_str(),
                   AT_SYMLINK_FOLLOW) == 0) {
        name_ = std::move(name);
        return true;
      }
      if (errno != EEXIST) return false;
    }
    return false;
  }

  UniqueFd folder_, fd_;
  std::string name_;
};

}  // namespace

Result<void> writeFileAtomic(const fs::path& file, std::span<const std::byte> bytes) {
  if (file.empty() || !file.has_filename() || file.native().find('\0') != std::string::npos)
    return fail(file.string(), "is no file name", "name a file");
  auto followed = linkTarget(file);
  if (!followed) return fail(followed.error());
  const fs::path& target = *followed;
  if (const int number = descriptorNamed(target); number >= 0)
    return writeStraight(file, UniqueFd(::fcntl(number, F_DUPFD_CLOEXEC, 0)), bytes);

  struct stat old {};
  const bool exists = ::stat(target.c_str(), &old) == 0;
  if (exists && S_ISDIR(old.st_mode)) return fail(file.string(), "is a folder", "name a file");
  if (exists && !S_ISREG(old.st_mode))
    return writeStraight(file, UniqueFd(::open(target.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC)), bytes);
  if (exists && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
    return writeError(file, "opening it for writing", errno);
  if (!fitsSizeLimit(bytes.size())) return writeError(file, "writing", EFBIG);

  PendingFile pending(target.has_parent_path() ? target.parent_path() : fs::path("."));
  if (!pending.create()) return writeError(file, "creating a file in its folder", errno);
  if (!writeAll(pending.fd(), bytes)) return writeError(file, "writing", errno);
  if (exists) (void)::fchmod(pending.fd(), old.st_mode & 0777);  // not on file systems without modes
  if (!flushed(pending.fd())) return writeError(file, "flushing it to disk", errno);
  if (!pending.renameTo(target.filename().string())) return writeError(file, "renaming it into place", errno);
  return {};
}

}  // namespace burnish::core
