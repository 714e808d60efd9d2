// Guarded file access: regular files only, sizes checked before reading, never blocking, and writes that are complete
// or absent.
#pragma once
#include <burnish/result.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace burnish::core {

/// Reads a whole regular file of at most maxBytes. Opens without blocking (a FIFO or device is refused, not waited
/// for), and looks at the size before reading a byte (a sparse file of 3 GB costs nothing). Errors name the file.
Result<std::vector<std::byte>> readFile(const std::filesystem::path& file, std::uint64_t maxBytes);

/// Resolves `uri` (as found in an asset; percent-encoding is undone) against `folder` to the canonical path of an
/// existing regular file, and makes sure that it lies below the canonical folder, unless allowOutside. Refuses schemes
/// (file:, http:, data:, C:) and NUL bytes always; absolute paths, `..` (backslashes count as separators) and links
/// that lead out unless allowOutside. `uri`s are tried decoded, then decoded with backslashes as slashes, then as
/// written ("100%25.png"). The answer is true at the time of the call: whoever reads a file of an untrusted tree uses
/// readFileInside.
Result<std::filesystem::path> resolveInside(const std::filesystem::path& folder, std::string_view uri,
                                            bool allowOutside);

/// resolveInside and readFile in one, without a race: the file is opened first, and what is checked and read is that
/// very file, so that a link swapped in between changes nothing. Hard links and bind mounts count as inside.
Result<std::vector<std::byte>> readFileInside(const std::filesystem::path& folder, std::string_view uri,
                                              bool allowOutside, std::uint64_t maxBytes);

/// Writes under a temporary name in the same folder, flushes to disk, renames. On any error (full disk, no right to
/// write, RLIMIT_FSIZE) the temporary file is removed and an old file stays intact. A new file's mode follows the
/// umask, an old one's is kept. A symbolic link is followed: its target is replaced, not the link. What is not a
/// regular file (/dev/stdout, a pipe, /dev/null) is written straight. Not even SIGKILL leaves a half-written file under
/// the name; where the file system has O_TMPFILE (ext4, xfs, btrfs, tmpfs) it leaves a temporary one only in the
/// instant between naming and renaming it.
Result<void> writeFileAtomic(const std::filesystem::path& file, std::span<const std::byte> bytes);

struct NamedBytes {
  std::string name;  ///< without a folder
  std::vector<std::byte> bytes;
};

/// Puts a folder that holds exactly these files at `folder`, all or none: they are written and flushed in a temporary
/// folder beside it, which then takes its place in one step (renameat2). An old folder goes only if `mayReplace` is true
/// of each name in it and all are regular files; else, and on any other error, it stays as it was. The step is one where
/// the file system can exchange names (ext4, xfs, btrfs, tmpfs); elsewhere a kill between two renames leaves the old
/// folder under a temporary name. A kill may leave a temporary folder (.burnish-*.tmp) behind, never a mixed one.
Result<void> replaceFolder(const std::filesystem::path& folder, std::span<const NamedBytes> files,
                           const std::function<bool(std::string_view)>& mayReplace);

}  // namespace burnish::core
