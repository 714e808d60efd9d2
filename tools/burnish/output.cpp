#include "output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

namespace cli {
namespace fs = std::filesystem;
using burnish::fail;
using burnish::Image;
using burnish::Result;

namespace {

// The one piece of mutable state that is global: signal handlers can reach nothing else.
volatile std::sig_atomic_t gWriting = 0, gPending = 0, gDeferred = 0, gAsked = 0;

void dieOf(int signal) {
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}
extern "C" void onSignal(int signal) {
  if (gDeferred && !gAsked)
    gAsked = 1;
  else if (gWriting)
    gPending = signal;
  else
    dieOf(signal);
}

/// While one lives, a signal waits for the file.
class WriteSection {
 public:
  WriteSection() { gWriting = 1; }
  ~WriteSection() {
    gWriting = 0;
    if (gPending) dieOf(gPending);
  }
  WriteSection(const WriteSection&) = delete;
  WriteSection& operator=(const WriteSection&) = delete;
};

std::string reason() { return std::strerror(errno); }

/// Where the bytes go: the file that a link points to, there or not yet, so that the link stays one.
fs::path destination(fs::path file) {
  std::error_code error;
  for (int hops = 0; hops < 40 && fs::is_symlink(file, error); ++hops) file = file.parent_path() / fs::read_symlink(file, error);
  return file;
}

Result<void> writeWhole(const fs::path& file, std::string_view text) {
  std::string temporary = (file.parent_path() / fmt::format(".{}.XXXXXX", file.filename().string())).string();
  const int fd = mkostemp(temporary.data(), O_CLOEXEC);
  if (fd < 0) return fail(file.string(), "cannot be written: " + reason(), "choose another folder");
  const mode_t mask = umask(0);
  umask(mask);
  bool good = fchmod(fd, 0666 & ~mask) == 0;
  while (good && !text.empty()) {
    const ssize_t n = write(fd, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    good = n > 0;
    if (good) text.remove_prefix(std::size_t(n));
  }
  good = good && fsync(fd) == 0;
  std::string why = good ? std::string() : reason();
  if (close(fd) != 0 && good) good = false, why = reason();
  if (good && std::rename(temporary.c_str(), file.c_str()) != 0) good = false, why = reason();
  if (good) return {};
  unlink(temporary.c_str());
  return fail(file.string(), "cannot be written: " + why, "free some space or choose another folder");
}

}  // namespace

void installSignals() {
  struct sigaction action = {};
  action.sa_handler = onSignal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    // A signal that the parent had ignored (nohup) stays ignored.
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);  // a decode helper that died, or a pager that was closed, is an error value
}

void deferSignals() { gDeferred = 1; }
bool stopAsked() { return gAsked != 0; }

Result<void> checkOutput(const fs::path& file) {
  std::error_code error;
  const fs::path to = destination(file);
  const fs::file_status status = fs::status(to, error);
  if (fs::is_directory(status)) return fail(file.string(), "is a folder", "give the name of a file");
  if (fs::exists(status) && !fs::is_regular_file(status)) return fail(file.string(), "is no regular file", "give the name of a file");
  const fs::path folder = to.has_parent_path() ? to.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) return fail(file.string(), "its folder does not exist", "create " + folder.string());
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    return fail(file.string(), "cannot be written: " + reason(), "choose another folder");
  return {};
}

Result<void> checkCubemapOutput(const fs::path& file) {
  std::error_code error;
  const bool folder = !file.has_filename() || file.extension().empty() || fs::is_directory(file, error);
  if (!folder) return checkOutput(file);
  const fs::path named = file.has_filename() ? file : file.parent_path();
  if (fs::exists(named, error) && !fs::is_directory(named, error)) return fail(file.string(), "is no folder", "name a new folder, or end the name in .dds, .ktx2 or .exr");
  const fs::path parent = named.has_parent_path() ? named.parent_path() : fs::path(".");
  if (!fs::is_directory(parent, error)) return fail(file.string(), "its folder does not exist", "create " + parent.string());
  if (access(parent.c_str(), W_OK | X_OK) != 0) return fail(file.string(), "cannot be written: " + reason(), "choose another folder");
  return {};
}

Result<void> saveCubemap(const fs::path& file, const burnish::Cubemap& cubemap, burnish::PixelType type, burnish::Report& report) {
  const WriteSection section;
  return burnish::writeCubemap(file, cubemap, type, report);
}

namespace {
/// The first three channels.
Image withoutAlpha(const Image& image) {
  if (image.channels < 4) return image;
  Image result = burnish::makeImage(image.width, image.height, 3, image.type);
  const std::size_t bytes = std::size_t(bytesPerChannel(image.type));
  for (std::size_t i = 0; i < image.pixelCount(); ++i)
    std::memcpy(result.data.data() + i * 3 * bytes, image.data.data() + i * 4 * bytes, 3 * bytes);
  return result;
}
}  // namespace

Result<void> writePicture(const fs::path& file, const Image& rgba) {
  const Image rgb = withoutAlpha(rgba);
  const WriteSection section;
  return file.extension() == ".exr" ? burnish::writeExr(destination(file), rgb) : burnish::writePng(destination(file), rgb);
}

Result<void> writeJson(const fs::path& file, const Json& document) {
  const std::string text = document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (file == "-") {
    std::fwrite(text.data(), 1, text.size(), stdout);
    return flushStandardOutput();
  }
  const WriteSection section;
  return writeWhole(destination(file), text);
}

Result<void> flushStandardOutput() {
  const bool good = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (good) return {};
  return fail("standard output", "cannot be written: " + reason(), "free some space or send it elsewhere");
}

}  // namespace cli
