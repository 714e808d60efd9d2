// Runs hidden tests of this same program in a process of their own, where the environment must differ from the start.
#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>

namespace burnish::test {

struct Outcome {
  int status = -1;  ///< exit status
  std::string output;
};

/// `prefix` goes before the program ("env A=B", "xvfb-run -a"); `filter` is Catch's.
inline Outcome runSelf(const std::string& prefix, const std::string& filter) {
  std::array<char, 4096> path{};
  const ssize_t length = readlink("/proc/self/exe", path.data(), path.size() - 1);
  const std::string command =
      prefix + " '" + std::string(path.data(), std::size_t(length > 0 ? length : 0)) + "' '" + filter + "' 2>&1";
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return outcome;
  std::array<char, 1024> piece{};
  while (std::fgets(piece.data(), int(piece.size()), pipe)) outcome.output += piece.data();
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

}  // namespace burnish::test
