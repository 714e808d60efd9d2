// The GLB container: glTF 2.0, section 4.
#pragma once
#include <burnish/result.h>

#include <cstddef>
#include <optional>
#include <span>

namespace burnish::asset {

struct Glb {
  std::span<const std::byte> json;
  std::optional<std::span<const std::byte>> binary;
};
/// True for files that begin with "glTF".
bool isGlb(std::span<const std::byte> file);
/// Takes a GLB file apart; the spans point into it. Errors name the chunk, chunks of unknown types and bytes after the
/// end are warnings.
Result<Glb> parseGlb(std::span<const std::byte> file, const std::string& place, Report& report);

}  // namespace burnish::asset
