// Reading files that an untrusted asset may name (burnish/core/file.h).
// A path is first opened with O_PATH, which has no side effect on FIFOs, devices or automounts and takes no right to
// read; everything is then checked on that descriptor (fstat; its canonical path through /proc/self/fd) and the same
// inode is opened for reading through /proc/self/fd. So nothing can be exchanged between the check and the use
// (CWE-367). openat2's RESOLVE_BENEATH was not taken: it also refuses links that leave the folder and come back, and
// needs a newer kernel.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <climits>
#include <cstring>
#include <string>

#include "core/file.h"
#include "core/unique_fd.h"

namespace burnish::core {
namespace {

std::string fdLink(int fd) { return fmt::format("/proc/self/fd/{}", fd); }

const char* kindOf(mode_t mode) {
  switch (mode & S_IFMT) {
    case S_IFDIR:
      return "a folder";
    case S_IFIFO:
      return "a FIFO";
    case S_IFCHR:
    case S_IFBLK:
      return "a device";
    case S_IFSOCK:
      return "a socket";
    default:
      return "not a regular file";
  }
}

/// A printable, bounded form of a name that an asset chose.
std::string shown(std::string_view text) {
  std::string out;
  for (char c : text.substr(0, 200)) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    else
      out += c;
  }
  if (text.size() > 200) out += "...";
  return out;
}

tl::unexpected<Error> openError(const std::string& place, int error) {
  const char* remedy = error == ENOENT || error == ENOTDIR ? "check the name"
                       : error == EACCES                   ? "check the permissions"
                       : error == ELOOP                    ? "check the symbolic links"
                                                           : "";
  return fail(place, fmt::format("cannot open it ({})", std::strerror(error)), remedy);
}

struct Opened {
  UniqueFd fd;  ///< O_PATH
  struct stat status {};
};

/// Opens a regular file for looking at, not yet for reading.
Result<Opened> openRegular(const std::filesystem::path& file, const std::string& place) {
  Opened opened;
  opened.fd.reset(::open(file.c_str(), O_PATH | O_CLOEXEC));
  if (!opened.fd) return openError(place, errno);
  if (::fstat(opened.fd.get(), &opened.status) != 0) return openError(place, errno);
  if (!S_ISREG(opened.status.st_mode))
    return fail(place, fmt::format("is {}", kindOf(opened.status.st_mode)), "name a regular file");
  return opened;
}

/// Reads what `opened` names: the size first, then exactly that many bytes (a file that grows meanwhile is cut there).
Result<std::vector<std::byte>> readOpened(const Opened& opened, const std::filesystem::path& file,
                                          const std::string& place, std::uint64_t maxBytes) {
  UniqueFd fd(::open(fdLink(opened.fd.get()).c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!fd && errno == ENOENT) fd.reset(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));  // no /proc
  if (!fd) return openError(place, errno);
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) return openError(place, errno);
  if (status.st_dev != opened.status.st_dev || status.st_ino != opened.status.st_ino)
    return fail(place, "changed while it was opened", "try again");
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > maxBytes)
    return fail(place, fmt::format("is {} bytes long, the limit here is {}", size, maxBytes),
                "use a smaller file or raise the limit");
  std::vector<std::byte> bytes;
  try {
    bytes.resize(size);
  } catch (const std::exception&) {
    return fail(place, fmt::format("no memory for its {} bytes", size), "use a smaller file");
  }
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::read(fd.get(), bytes.data() + done, std::min<std::size_t>(bytes.size() - done, 1u << 30));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return fail(place, fmt::format("reading failed ({})", std::strerror(errno)), "check the disk");
    if (n == 0) break;  // it shrank: what is there is the file
    done += static_cast<std::size_t>(n);
  }
  bytes.resize(done);
  return bytes;
}

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char lower = static_cast<char>(c | 0x20);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/// RFC 3986 section 2.1. A '%' without two hexadecimal digits stays (exporters write "100%.png").
std::string percentDecoded(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hexDigit(uri[i + 1]) : -1;
    const int low = high >= 0 ? hexDigit(uri[i + 2]) : -1;
    if (low >= 0) {
      out += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

std::string withSlashes(std::string text) {
  for (char& c : text)
    if (c == '\\') c = '/';
  return text;
}

/// RFC 3986 section 3.1, which also catches drive letters.
bool hasScheme(std::string_view uri) {
  const auto isLetter = [](char c) { return (c | 0x20) >= 'a' && (c | 0x20) <= 'z'; };
  if (uri.empty() || !isLetter(uri[0])) return false;
  for (char c : uri.substr(1)) {
    if (c == ':') return true;
    if (!isLetter(c) && !(c >= '0' && c <= '9') && c != '+' && c != '-' && c != '.') return false;
  }
  return false;
}

/// Whether `..` climbs above the start at any point of the path.
bool climbsOut(std::string_view path) {
  int depth = 0;
  while (!path.empty()) {
    const std::size_t slash = path.find('/');
    const std::string_view part = path.substr(0, slash);
    if (part == "..")
      --depth;
    else if (!part.empty() && part != ".")
      ++depth;
    if (depth < 0) return true;
    path = slash == std::string_view::npos ? std::string_view{} : path.substr(slash + 1);
  }
  return false;
}

/// What can be refused by looking at the text alone.
Result<void> checkText(const std::string& place, std::string_view uri, const std::string& decoded, bool allowOutside) {
  const std::string slashed = withSlashes(decoded);
  if (uri.empty()) return fail(place, "the path is empty", "name a file");
  if (decoded.find('\0') != std::string::npos)
    return fail(place, "the path holds a NUL byte", "name a file of the asset's folder");
  if (hasScheme(uri) || hasScheme(decoded))
    return fail(place, "the path has a scheme; only files are read, nothing is fetched",
                "store the file beside the asset and name it by a relative path");
  if (allowOutside) return {};
  if (slashed[0] == '/') return fail(place, "the path is absolute", "use a path relative to the asset's folder");
  if (climbsOut(slashed)) return fail(place, "the path leaves the asset's folder", "move the file into the folder");
  return {};
}

/// The canonical path behind an O_PATH descriptor; where there is no /proc, that of `path`, found by walking it.
Result<std::filesystem::path> canonicalOf(const UniqueFd& fd, const std::filesystem::path& path,
                                          const std::string& place) {
  char buffer[PATH_MAX];
  const ssize_t n = ::readlink(fdLink(fd.get()).c_str(), buffer, sizeof buffer);
  if (n > 0 && n < static_cast<ssize_t>(sizeof buffer) && buffer[0] == '/')
    return std::filesystem::path(std::string(buffer, static_cast<std::size_t>(n)));
  std::error_code error;
  std::filesystem::path canonical = std::filesystem::canonical(path, error);
  if (error) return fail(place, fmt::format("cannot be resolved ({})", error.message()), "check the name");
  return canonical;
}

bool liesBelow(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const std::string& inner = file.native();
  const std::string& outer = folder.native();
  if (outer == "/") return true;
  return inner.size() > outer.size() && inner.starts_with(outer) && inner[outer.size()] == '/';
}

struct Resolved {
  Opened opened;
  std::filesystem::path canonical;
};

Result<Resolved> openInside(const std::filesystem::path& folder, std::string_view uri, bool allowOutside,
                            const std::string& place) {
  const std::string decoded = percentDecoded(uri);
  if (auto ok = checkText(place, uri, decoded, allowOutside); !ok) return fail(ok.error());
  const std::filesystem::path base = folder.empty() ? std::filesystem::path(".") : folder;
  UniqueFd baseFd(::open(base.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!baseFd) return openError(base.string(), errno);
  // The text as written comes last: names that hold a literal "%20" exist, but the URI reading has precedence.
  // It cannot climb out either: undecoded it holds no more dots than decoded, and it is checked like the others.
  Result<Resolved> answer = fail(place, "was not found", "check the name");
  bool first = true;
  for (const std::string& candidate : {decoded, withSlashes(decoded), std::string(uri)}) {
    if (!first && candidate == decoded) continue;
    if (!allowOutside && (candidate[0] == '/' || climbsOut(candidate))) continue;
    if (candidate.find('\0') != std::string::npos) continue;
    auto opened = openRegular(base / candidate, place);
    if (opened) {
      auto canonical = canonicalOf(opened->fd, base / candidate, place);
      auto canonicalBase = canonicalOf(baseFd, base, place);
      if (!canonical) return fail(canonical.error());
      if (!canonicalBase) return fail(canonicalBase.error());
      if (!allowOutside && !liesBelow(*canonical, *canonicalBase))
        return fail(place, "is a link that leaves the asset's folder", "copy the file into the folder");
      return Resolved{std::move(*opened), std::move(*canonical)};
    }
    if (first) answer = fail(opened.error());
    first = false;
  }
  return answer;
}

}  // namespace

Result<std::vector<std::byte>> readFile(const std::filesystem::path& file, std::uint64_t maxBytes) {
  const std::string place = shown(file.native());
  if (file.native().find('\0') != std::string::npos) return fail(place, "the path holds a NUL byte", "check the name");
  auto opened = openRegular(file, place);
  if (!opened) return fail(opened.error());
  return readOpened(*opened, file, place, maxBytes);
}

Result<std::filesystem::path> resolveInside(const std::filesystem::path& folder, std::string_view uri,
                                            bool allowOutside) {
  auto resolved = openInside(folder, uri, allowOutside, shown(uri));
  if (!resolved) return fail(resolved.error());
  return resolved->canonical;
}

Result<std::vector<std::byte>> readFileInside(const std::filesystem::path& folder, std::string_view uri,
                                              bool allowOutside, std::uint64_t maxBytes) {
  const std::string place = shown(uri);
  auto resolved = openInside(folder, uri, allowOutside, place);
  if (!resolved) return fail(resolved.error());
  return readOpened(resolved->opened, resolved->canonical, place, maxBytes);
}

}  // namespace burnish::core
