#include "samples.h"

#include <fmt/format.h>

#include <algorithm>

#include "messages.h"

namespace cli {
namespace fs = std::filesystem;

namespace {
fs::path sceneIn(const fs::path& folder) {
  std::error_code error;
  for (const std::string& stem : {folder.filename().string(), std::string("scene")})
    for (const char* ending : {".gltf", ".glb"})
      if (const fs::path file = folder / (stem + ending); fs::is_regular_file(file, error)) return file;
  return {};
}
}  // namespace

fs::path samplesFolder() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : self.parent_path().parent_path() / "share/burnish/samples";
}

std::vector<std::string> sampleNames() {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(samplesFolder(), error), end; !error && it != end; it.increment(error))
    if (!sceneIn(it->path()).empty()) names.push_back(it->path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

burnish::Result<fs::path> resolveScene(const std::string& scene) {
  std::error_code error;
  const std::vector<std::string> names = sampleNames();
  const bool isSample = std::find(names.begin(), names.end(), scene) != names.end();
  // A folder that happens to be called like a sample (the one in samples/, say) is no scene.
  if (fs::exists(scene, error) && !(isSample && fs::is_directory(scene, error))) return fs::path(scene);
  if (isSample) return sceneIn(samplesFolder() / scene);
  const std::string samples = names.empty() ? fmt::format("no samples are installed in {}", samplesFolder().string()) : "samples: " + listed(names);
  return burnish::fail(scene, "no such file or sample" + didYouMean(scene, names), fmt::format("give a .gltf or .glb file or a sample ({})", samples));
}

}  // namespace cli
