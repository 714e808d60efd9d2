// Writing a folder of files so that it is complete or absent (burnish/core/file.h).
#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>

#include "core/unique_fd.h"
#include "core/write_pending.h"

namespace burnish::core {
namespace {

namespace fs = std::filesystem;

/// A folder without a name in the end: it is removed with what it holds, unless it was renamed into place.
class PendingFolder {
 public:
  explicit PendingFolder(const fs::path& parent) : parent_(::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {}
  PendingFolder(const PendingFolder&) = delete;
  PendingFolder& operator=(const PendingFolder&) = delete;
  ~PendingFolder() {
    if (!name_.empty()) remove();
  }

  bool create() {
    if (!parent_) return false;
    for (int tries = 0; tries < 16; ++tries) {
      std::string name = temporaryName();
      if (::mkdirat(parent_.get(), name.c_str(), 0777) == 0) {
        name_ = std::move(name);
        fd_.reset(::openat(parent_.get(), name_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
        return static_cast<bool>(fd_);
      }
      if (errno != EEXIST) return false;
    }
    return false;
  }
  [[nodiscard]] int fd() const { return fd_.get(); }

  bool add(const NamedBytes& file) {
    UniqueFd out(::openat(fd_.get(), file.name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
    if (!out || !writeAll(out.get(), file.bytes) || !flushed(out.get())) return false;
    return ::close(out.release()) == 0 || errno == EINTR;
  }

  /// Takes the name; what bore it bears the temporary one from then on, and goes with this object.
  bool placeAs(const std::string& name, bool replacing) {
    const unsigned flags = replacing ? RENAME_EXCHANGE : RENAME_NOREPLACE;
    if (::renameat2(parent_.get(), name_.c_str(), parent_.get(), name.c_str(), flags) == 0) {
      if (!replacing) name_.clear();
    } else if (errno != EINVAL && errno != ENOSYS && errno != EXDEV) {
      return false;
    } else if (!placeInTwoSteps(name, replacing)) {
      return false;
    }
    ::fsync(parent_.get());  // a folder that cannot be flushed still holds the files
    return true;
  }

 private:
  bool placeInTwoSteps(const std::string& name, bool replacing) {
    const std::string aside = temporaryName();
    if (replacing && ::renameat(parent_.get(), name.c_str(), parent_.get(), aside.c_str()) != 0) return false;
    if (::renameat(parent_.get(), name_.c_str(), parent_.get(), name.c_str()) != 0) {
      const int error = errno;
      if (replacing) (void)::renameat(parent_.get(), aside.c_str(), parent_.get(), name.c_str());
      errno = error;
      return false;
    }
    name_ = replacing ? aside : std::string();
    return true;
  }

  /// Files only: nothing else is ever in a folder of ours, and an old one was looked through.
  void remove() {
    UniqueFd fd(::openat(parent_.get(), name_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (DIR* entries = fd ? ::fdopendir(fd.get()) : nullptr) {
      while (const dirent* entry = ::readdir(entries)) (void)::unlinkat(::dirfd(entries), entry->d_name, 0);  // not . and ..
      fd.release();
      ::closedir(entries);
    }
    (void)::unlinkat(parent_.get(), name_.c_str(), AT_REMOVEDIR);
  }

  UniqueFd parent_, fd_;
  std::string name_;
};

/// Whether all that an old folder holds may go.
Result<void> checkOld(const fs::path& folder, const std::function<bool(std::string_view)>& mayReplace) {
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
    const std::string name = entries->path().filename().string();
    std::error_code ignored;
    if (!fs::is_regular_file(entries->symlink_status(ignored)) || !mayReplace(name))
      return fail(folder.string(), fmt::format("holds '{}', which is none of the files to be replaced", name), "name a new folder");
  }
  if (error) return fail(folder.string(), fmt::format("cannot be listed ({})", error.message()), "check the permissions");
  return {};
}

}  // namespace

Result<void> replaceFolder(const fs::path& folder, std::span<const NamedBytes> files,
                           const std::function<bool(std::string_view)>& mayReplace) {
  fs::path target = folder.has_filename() ? folder : folder.parent_path();  // "out/" is "out"
  if (target.empty() || folder.native().find('\0') != std::string::npos || target.filename() == "." || target.filename() == "..")
    return fail(folder.string(), "is no folder name", "name a folder");
  std::error_code error;
  if (fs::is_symlink(target, error)) {  // the folder is replaced, not the link
    target = fs::canonical(target, error);
    if (error) return fail(folder.string(), fmt::format("is a link that leads nowhere ({})", error.message()), "name a folder");
  }
  struct stat old {};
  const bool exists = ::stat(target.c_str(), &old) == 0;
  if (exists && !S_ISDIR(old.st_mode)) return fail(folder.string(), "is no folder", "name a new folder");
  if (exists)
    if (auto ok = checkOld(target, mayReplace); !ok) return ok;
  if (exists && ::faccessat(AT_FDCWD, target.c_str(), W_OK | X_OK, AT_EACCESS) != 0) return writeError(folder, "opening it for writing", errno);
  for (const NamedBytes& file : files)
    if (!fitsSizeLimit(file.bytes.size())) return writeError(folder / file.name, "writing", EFBIG);

  PendingFolder pending(target.has_parent_path() ? target.parent_path() : fs::path("."));
  if (!pending.create()) return writeError(folder, "creating a folder beside it", errno);
  for (const NamedBytes& file : files)
    if (!pending.add(file)) return writeError(folder / file.name, "writing", errno);
  if (exists) (void)::fchmod(pending.fd(), old.st_mode & 0777);
  if (!flushed(pending.fd())) return writeError(folder, "flushing it to disk", errno);
  if (!pending.placeAs(target.filename().string(), exists)) return writeError(folder, "renaming it into place", errno);
  return {};
}

}  // namespace burnish::core
