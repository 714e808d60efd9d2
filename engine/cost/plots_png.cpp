#include "cost/plots_png.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <span>
#include <thread>

#include "core/spawn_plan.h"
#include "core/unique_fd.h"
#include "core/write_pending.h"

namespace burnish::cost {
namespace {

using namespace std::chrono_literals;
constexpr std::size_t kMostBytes = 64u << 20;
constexpr unsigned char kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};

/// The program with these as standard input and output, in a group of its own: Ctrl-C is for whoever called us.
int start(const std::string& program, int input, int output, pid_t& pid) {
  core::SpawnPlan plan;
  posix_spawn_file_actions_adddup2(&plan.actions, input, 0);
  posix_spawn_file_actions_adddup2(&plan.actions, output, 1);
  posix_spawn_file_actions_addopen(&plan.actions, 2, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addclosefrom_np(&plan.actions, 3);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&plan.attributes, &none);
  posix_spawnattr_setsigdefault(&plan.attributes, &all);
  posix_spawnattr_setpgroup(&plan.attributes, 0);
  posix_spawnattr_setflags(&plan.attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::string words[] = {program, "--format=png", "--zoom=2"};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  return ::posix_spawnp(&pid, program.c_str(), &plan.actions, &plan.attributes, arguments, environ);
}

/// The exit status, or -1 where the time was over and the program was ended.
int waitFor(pid_t pid, double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  int status = 0;
  for (;;) {
    const pid_t got = ::waitpid(pid, &status, WNOHANG);
    if (got == pid) return status;
    if (got < 0 && errno != EINTR) return -1;
    if (std::chrono::steady_clock::now() >= end) break;
    std::this_thread::sleep_for(3ms);
  }
  ::kill(-pid, SIGKILL);
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {}
  return -1;
}

bool readBack(int fd, std::vector<std::byte>& bytes) {
  struct stat info {};
  if (::fstat(fd, &info) != 0 || info.st_size <= 0 || static_cast<std::size_t>(info.st_size) > kMostBytes) return false;
  bytes.resize(static_cast<std::size_t>(info.st_size));
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t got = ::pread(fd, bytes.data() + at, bytes.size() - at, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += static_cast<std::size_t>(got);
  }
  return bytes.size() > sizeof kSignature && std::memcmp(bytes.data(), kSignature, sizeof kSignature) == 0;
}

}  // namespace

Result<std::vector<std::byte>> rasterized(std::string_view svg, const std::string& program, double seconds) {
  // Files in memory, so that neither end waits for the other. Not numbers under 3, which the program's own take.
  const auto memory = [] {
    const core::UniqueFd low(::memfd_create("plot", MFD_CLOEXEC));
    return core::UniqueFd(low ? ::fcntl(low.get(), F_DUPFD_CLOEXEC, 3) : -1);
  };
  const core::UniqueFd input = memory(), output = memory();
  if (!input || !output || !core::writeAll(input.get(), std::as_bytes(std::span(svg))) || ::lseek(input.get(), 0, SEEK_SET) != 0)
    return fail(program, fmt::format("no memory file for a plot ({})", std::strerror(errno)), "close some files");
  pid_t pid = -1;
  if (const int error = start(program, input.get(), output.get(), pid); error != 0)
    return fail(program, fmt::format("cannot be started ({})", std::strerror(error)), "install librsvg2-bin to get the plots as PNG too");
  const int status = waitFor(pid, seconds);
  if (status == -1) return fail(program, fmt::format("a plot took longer than {} s", seconds), "the plots are there as SVG");
  std::vector<std::byte> bytes;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !readBack(output.get(), bytes)) return fail(program, "a plot could not be drawn", "the plots are there as SVG");
  return bytes;
}

}  // namespace burnish::cost
