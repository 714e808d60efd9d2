#include "image/helper_path.h"

#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>
#include <vector>

namespace burnish::image {
namespace {

namespace fs = std::filesystem;
constexpr const char* kName = "burnish-decode";

bool runnable(const fs::path& file) {
  struct stat status {};
  return ::stat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode) && ::access(file.c_str(), X_OK) == 0;
}

/// The folder of the object that this code was linked into: libburnish.so, or the program itself.
fs::path libraryFolder() {
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&findDecodeHelper), &info) == 0 || !info.dli_fname) return {};
  std::error_code error;
  const fs::path file = fs::canonical(info.dli_fname, error);
  return error ? fs::path() : file.parent_path();
}

std::vector<fs::path> candidates() {
  std::vector<fs::path> found;
  std::error_code error;
  if (const fs::path self = fs::read_symlink("/proc/self/exe", error); !error) {
    found.push_back(self.parent_path() / kName);
    found.push_back(self.parent_path().parent_path() / "libexec/burnish" / kName);
  }
  if (const fs::path library = libraryFolder(); !library.empty())
    for (const fs::path& root :
         {library.parent_path(), library.parent_path().parent_path()}) {  // lib, or lib/x86_64-linux-gnu
      found.push_back(root / "bin" / kName);
      found.push_back(root / "libexec/burnish" / kName);
    }
#ifdef BURNISH_HELPER_FOLDER
  found.push_back(fs::path(BURNISH_HELPER_FOLDER) / kName);
#endif
  return found;
}

}  // namespace

Result<fs::path> findDecodeHelper(const fs::path& asked) {
  if (!asked.empty()) {
    if (runnable(asked)) return fs::absolute(asked);
    return fail(asked.string(), "is not a program that can be run; pictures cannot be decoded without it",
                "name the burnish-decode program in DecoderPoolOptions::helper, or leave it empty");
  }
  std::string places;
  for (const fs::path& file : candidates()) {
    if (runnable(file)) return file;
    const std::string folder = file.parent_path().string();
    if (places.find(folder) == std::string::npos) places += (places.empty() ? "" : ", ") + folder;
  }
  return fail(kName, "the program that decodes pictures was not found in " + places,
              "install it beside the running program, or name it in DecoderPoolOptions::helper");
}

}  // namespace burnish::image
