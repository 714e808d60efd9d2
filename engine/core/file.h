// Guarded file access: regular files only, sizes checked before reading, never blocking, and writes that are complete or absent.
#pragma once
#include <burnish/result.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace burnish::core {

/// Reads a whole regular file of at most maxBytes. Opens without blocking (a FIFO or device is refused, not waited for).
Result<std::vector<std::byte>> readFile(const std::filesystem::path& file, std::uint64_t maxBytes);

/// Resolves `uri` (as found in an asset; percent-encoding is undone) against `folder` and makes sure that the canonical result lies below the canonical folder,
/// unless allowOutside. Refuses absolute paths, schemes (file:, http:), NUL bytes, and links that lead out.
Result<std::filesystem::path> resolveInside(const std::filesystem::path& folder, std::string_view uri, bool allowOutside);

/// Writes under a temporary name in the same folder, flushes to disk, renames. On any error the temporary file is removed and an old file stays intact.
Result<void> writeFileAtomic(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace burnish::core
