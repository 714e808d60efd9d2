// A folder of its own for each file test, gone afterwards.
#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace file_test {

namespace fs = std::filesystem;

/// A folder of its own for each test, gone afterwards.
class Sandbox {
 public:
  Sandbox() {
    std::string name = (fs::temp_directory_path() / "burnish-file-XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
    root = fs::canonical(name);
    fs::create_directories(root / "asset/textures");
    put(root / "secret.txt", "secret");
    put(root / "asset/a.bin", "inside");
    put(root / "asset/textures/t.png", "texture");
  }
  ~Sandbox() { fs::remove_all(root); }
  static void put(const fs::path& file, std::string_view text) { std::ofstream(file, std::ios::binary) << text; }
  static std::string get(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] std::size_t filesIn(const fs::path& folder) const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
  fs::path root;
};

inline std::span<const std::byte> bytesOf(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}
inline std::string textOf(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Runs `body` in a child; gives its exit code, or 1000 + signal.
inline int inChild(const std::function<int()>& body) {
  const pid_t pid = ::fork();
  if (pid == 0) ::_exit(body());
  int status = 0;
  REQUIRE(::waitpid(pid, &status, 0) == pid);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

}  // namespace file_test
