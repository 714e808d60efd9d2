// Where the helper program `burnish-decode` is.
#pragma once
#include <burnish/result.h>

#include <filesystem>

namespace burnish::image {

/// `asked` if it names one; else the first that exists: beside the running program, ../libexec/burnish/ from there, the
/// bin and libexec folders of the tree that holds this library, the folder that the build would install to. No
/// environment variable is read: what runs is decided by whoever installed the program. The error names the places that
/// were looked at.
Result<std::filesystem::path> findDecodeHelper(const std::filesystem::path& asked);

}  // namespace burnish::image
