#include "image/face_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "image/cube_texels.h"

namespace burnish::image {
namespace {

namespace fs = std::filesystem;

/// Names of the faces +X -X +Y -Y +Z -Z, as tools write them.
constexpr std::array<std::array<std::string_view, 6>, 5> kNames = {{{"px", "nx", "py", "ny", "pz", "nz"},
                                                                    {"posx", "negx", "posy", "negy", "posz", "negz"},
                                                                    {"right", "left", "top", "bottom", "front", "back"},
                                                                    {"+x", "-x", "+y", "-y", "+z", "-z"},
                                                                    {"0", "1", "2", "3", "4", "5"}}};
constexpr std::size_t kFolderNames = 4;  // plain numbers count in patterns only: in a folder they may be anything
constexpr std::size_t kMostEntries = 4096;

std::string upper(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c); });
  return out;
}
std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
  return out;
}
bool isLetterOrDigit(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool isPictureEnding(std::string_view ending) { return ending == ".exr" || ending == ".hdr" || ending == ".png" || ending == ".jpg" || ending == ".jpeg"; }

/// A file name taken apart: what stands before the face's name, which set of names it is of, which face.
struct FaceName {
  std::string rest;  ///< prefix, '|', ending: the same for the files of one set
  std::size_t set = 0, face = 0;
};
std::optional<FaceName> faceName(const fs::path& file) {
  const std::string stem = lower(file.stem().string()), ending = lower(file.extension().string());
  if (!isPictureEnding(ending)) return std::nullopt;
  for (std::size_t set = 0; set < kFolderNames; ++set)
    for (std::size_t face = 0; face < 6; ++face) {
      const std::string_view name = kNames[set][face];
      if (!stem.ends_with(name)) continue;
      const std::size_t before = stem.size() - name.size();
      if (before > 0 && isLetterOrDigit(stem[before - 1]) && isLetterOrDigit(name[0])) continue;  // "desktop" is no top
      return FaceName{stem.substr(0, before) + "|" + ending, set, face};
    }
  return std::nullopt;
}

Result<std::vector<fs::path>> picturesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  for (std::size_t n = 0; !error && entries != fs::directory_iterator(); entries.increment(error)) {
    if (++n > kMostEntries) return fail(folder.string(), fmt::format("holds more than {} files", kMostEntries), "give a pattern like face_%s.exr");
    std::error_code ignored;
    if (entries->is_regular_file(ignored)) files.push_back(entries->path());
  }
  if (error) return fail(folder.string(), fmt::format("cannot be listed ({})", error.message()), "check the permissions");
  std::sort(files.begin(), files.end());
  return files;
}

bool allExist(const FacePaths& paths) {
  return std::all_of(paths.begin(), paths.end(), [](const fs::path& p) { std::error_code ignored; return fs::exists(p, ignored); });
}

FacePaths facesOfLevel(const fs::path& folder, int level) {
  FacePaths paths;
  for (std::size_t face = 0; face < 6; ++face) paths[face] = folder / faceFileName(level, face);
  return paths;
}

}  // namespace

std::string faceFileName(int level, std::size_t face) { return fmt::format("level{}_{}.exr", level, kFaceNames[face]); }

bool isFaceFileName(std::string_view name) {
  for (int level = 0; level < 31; ++level)
    for (std::size_t face = 0; face < 6; ++face)
      if (name == faceFileName(level, face)) return true;
  return false;
}

Result<FacePaths> facesOfPattern(const fs::path& pattern) {
  const std::string text = pattern.filename().string();
  const std::size_t at = text.find("%s");
  if (at == std::string::npos) return fail(pattern.string(), "has no %s for the face's name", "write face_%s.exr");
  std::string missing;
  std::size_t mostFound = 0;
  for (const auto& names : kNames)
    for (const bool capital : {false, true}) {
      FacePaths paths;
      std::string without;
      std::size_t found = 0;
      for (std::size_t face = 0; face < 6; ++face) {
        paths[face] = pattern.parent_path() / (text.substr(0, at) + (capital ? upper(names[face]) : std::string(names[face])) + text.substr(at + 2));
        std::error_code ignored;
        if (fs::exists(paths[face], ignored)) ++found;
        else if (without.empty()) without = paths[face].filename().string();
      }
      if (found == 6) return paths;
      if (found > mostFound) mostFound = found, missing = without;
    }
  if (mostFound > 0) return fail(pattern.string(), fmt::format("{} of six faces are there; '{}' is not", mostFound, missing), "add the missing faces");
  return fail(pattern.string(), "no file fits the pattern", "put px nx py ny pz nz, posx ..., right left top bottom front back or 0 to 5 where %s stands");
}

Result<FaceFolder> facesOfFolder(const fs::path& folder) {
  FaceFolder out;
  for (int level = 0; level < 31; ++level) {
    const FacePaths paths = facesOfLevel(folder, level);
    if (!allExist(paths)) break;
    out.levels.push_back(paths);
  }
  if (!out.levels.empty()) return out;

  const auto files = picturesIn(folder);
  if (!files) return fail(files.error());
  std::map<std::pair<std::string, std::size_t>, FacePaths> sets;
  for (const fs::path& file : *files)
    if (const auto name = faceName(file)) sets[{name->rest, name->set}][name->face] = file;
  std::erase_if(sets, [](const auto& set) { return std::any_of(set.second.begin(), set.second.end(), [](const fs::path& p) { return p.empty(); }); });
  if (sets.empty())
    return fail(folder.string(), "holds no six faces of a cube", "name the pictures px nx py ny pz nz, posx ... or right left top bottom front back, with the same beginning");
  if (sets.size() > 1)
    return fail(folder.string(), fmt::format("holds {} sets of six faces, '{}' among them", sets.size(), sets.begin()->second[0].filename().string()), "give one as a pattern like face_%s.exr");
  out.levels.push_back(sets.begin()->second);
  return out;
}

}  // namespace burnish::image
