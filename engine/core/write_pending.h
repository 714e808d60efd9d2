// What writing a file and writing a folder have in common.
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "core/file.h"

namespace burnish::core {

/// The error of a step of writing that failed with errno `error`, and what to do.
tl::unexpected<Error> writeError(const std::filesystem::path& file, const char* step, int error);
/// Writes everything. `false`: errno tells. Waits where the descriptor does not block (a pipe).
bool writeAll(int fd, std::span<const std::byte> bytes);
/// fsync, where the file system knows it.
bool flushed(int fd);
/// A name that nobody else uses; hidden, short (the target's own may be at the limit of NAME_MAX).
std::string temporaryName();
/// Whether RLIMIT_FSIZE lets a file of this size be written; asked first, since the kernel's answer is a deadly signal.
bool fitsSizeLimit(std::size_t size);

}  // namespace burnish::core
