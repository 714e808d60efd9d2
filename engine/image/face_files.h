// Which files are the six faces of a cube: names, patterns, folders.
#pragma once
#include <burnish/result.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace burnish::image {

/// The names that writeCubemap uses, in the order of faces; readers know others as well.
inline constexpr std::array<std::string_view, 6> kFaceNames = {"px", "nx", "py", "ny", "pz", "nz"};

using FacePaths = std::array<std::filesystem::path, 6>;  ///< +X -X +Y -Y +Z -Z

/// "level3_px.exr", a file of a folder that writeCubemap wrote.
std::string faceFileName(int level, std::size_t face);
[[nodiscard]] bool isFaceFileName(std::string_view name);

/// The six files of a pattern: its %s stands for a face's name.
Result<FacePaths> facesOfPattern(const std::filesystem::path& pattern);

struct FaceFolder {
  std::vector<FacePaths> levels;  ///< more than one only where writeCubemap wrote them
};
/// The faces in a folder: level0_px.exr and so on, else the one set of six pictures that it holds.
Result<FaceFolder> facesOfFolder(const std::filesystem::path& folder);

}  // namespace burnish::image
