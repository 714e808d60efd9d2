// core/file: files that are complete or absent, whatever stops the writing.
#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "core/file.h"
#include "file_sandbox.h"

using namespace burnish;
using namespace file_test;

TEST_CASE("writeFileAtomic writes, replaces, keeps modes and follows links", "[file]") {
  const Sandbox box;
  const fs::path folder = box.root / "out", file = folder / "f.bin";
  fs::create_directory(folder);
  const mode_t old = ::umask(027);
  REQUIRE(core::writeFileAtomic(file, bytesOf("first")));
  ::umask(old);
  CHECK(Sandbox::get(file) == "first");
  CHECK(fs::status(file).permissions() == fs::perms(0640));
  fs::permissions(file, fs::perms(0604));
  REQUIRE(core::writeFileAtomic(file, bytesOf("second")));
  CHECK(Sandbox::get(file) == "second");
  CHECK(fs::status(file).permissions() == fs::perms(0604));
  REQUIRE(core::writeFileAtomic(file, {}));
  CHECK(Sandbox::get(file).empty());

  fs::create_symlink("f.bin", folder / "link");
  REQUIRE(core::writeFileAtomic(folder / "link", bytesOf("third")));
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(Sandbox::get(file) == "third");
  fs::create_symlink("new.bin", folder / "dangling");
  REQUIRE(core::writeFileAtomic(folder / "dangling", bytesOf("fourth")));
  CHECK(Sandbox::get(folder / "new.bin") == "fourth");
  const std::string longest(255, 'n');
  REQUIRE(core::writeFileAtomic(folder / longest, bytesOf("fifth")));
  CHECK(box.filesIn(folder) == 5);
}

TEST_CASE("writeFileAtomic refuses what it cannot write, in one clear error", "[file]") {
  const Sandbox box;
  fs::create_symlink("loop", box.root / "loop");
  for (const fs::path& file :
       {fs::path(), box.root, box.root / "no/such/folder/f", box.root / "secret.txt/f", fs::path(box.root / "asset/"),
        box.root / "loop", box.root / std::string(256, 'n'), fs::path("/proc/no-such-file")}) {
    INFO(file);
    auto written = core::writeFileAtomic(file, bytesOf("x"));
    REQUIRE_FALSE(written);
    CHECK_FALSE(written.error().what.empty());
    CHECK_FALSE(written.error().remedy.empty());
  }
  CHECK(box.filesIn(box.root) == 3);
}

TEST_CASE("writeFileAtomic writes straight to devices, pipes and descriptors", "[file]") {
  const Sandbox box;
  CHECK(core::writeFileAtomic("/dev/null", bytesOf("gone")));
  CHECK(fs::is_character_file("/dev/null"));
  auto full = core::writeFileAtomic("/dev/full", bytesOf("x"));
  REQUIRE_FALSE(full);
  CHECK(full.error().remedy.find("room") != std::string::npos);

  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const fs::path captured = box.root / "captured";
  const int code = inChild([&] {
    ::dup2(ends[1], 1);
    if (!core::writeFileAtomic("/dev/stdout", bytesOf("to the pipe"))) return 1;
    const int file = ::open(captured.c_str(), O_WRONLY | O_CREAT, 0600);
    ::dup2(file, 1);
    if (::write(1, "before ", 7) != 7) return 2;
    return core::writeFileAtomic("/dev/stdout", bytesOf("after")) ? 0 : 3;
  });
  CHECK(code == 0);
  char buffer[32] = {};
  CHECK(::read(ends[0], buffer, sizeof buffer) == 11);
  CHECK(std::string(buffer) == "to the pipe");
  ::close(ends[0]);
  ::close(ends[1]);
  CHECK(Sandbox::get(captured) == "before after");
}

TEST_CASE("A file size limit leaves the old file and no temporary one", "[file]") {
  const Sandbox box;
  const fs::path folder = box.root / "out", file = folder / "f.bin";
  fs::create_directory(folder);
  Sandbox::put(file, "old");
  const std::string large(1 << 20, 'x');
  const bool ignoreSignal = GENERATE(false, true);
  const int code = inChild([&] {
    if (ignoreSignal) ::signal(SIGXFSZ, SIG_IGN);
    const struct rlimit limit { 4096, 4096 };
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 1;
    auto written = core::writeFileAtomic(file, bytesOf(large));
    if (written) return 2;
    return written.error().remedy.empty() ? 3 : 0;
  });
  CHECK(code == 0);
  CHECK(Sandbox::get(file) == "old");
  CHECK(box.filesIn(folder) == 1);
}

TEST_CASE("A full disk leaves the old file and no temporary one", "[file]") {
  const Sandbox box;
  const fs::path folder = box.root / "small";
  fs::create_directory(folder);
  constexpr int kNoNamespaces = 77;
  const std::string large(1 << 20, 'x');
  const int code = inChild([&] {
    const int namespaces = CLONE_NEWNS | (::geteuid() == 0 ? 0 : CLONE_NEWUSER);
    if (::unshare(namespaces) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0)
      return kNoNamespaces;
    if (::mount("none", folder.c_str(), "tmpfs", 0, "size=64k") != 0) return kNoNamespaces;
    if (!core::writeFileAtomic(folder / "f.bin", bytesOf("old"))) return 1;
    auto written = core::writeFileAtomic(folder / "f.bin", bytesOf(large));
    if (written || written.error().remedy.find("room") == std::string::npos) return 2;
    return Sandbox::get(folder / "f.bin") == "old" && box.filesIn(folder) == 1 ? 0 : 3;
  });
  if (code == kNoNamespaces)
    WARN("no file system can be mounted here: a full disk was tried through /dev/full and RLIMIT_FSIZE alone");
  else
    CHECK(code == 0);
}

TEST_CASE("No right to write is an error, and nothing is touched", "[file]") {
  const Sandbox box;
  const fs::path folder = box.root / "out", file = folder / "f.bin";
  fs::create_directory(folder);
  Sandbox::put(file, "old");
  fs::permissions(box.root, fs::perms(0755));
  fs::permissions(folder, fs::perms(0555));
  const int code = inChild([&] {
    if (::geteuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) return 1;
    auto written = core::writeFileAtomic(file, bytesOf("new"));
    if (written || written.error().remedy.find("permissions") == std::string::npos) return 2;
    return core::writeFileAtomic(folder / "other", bytesOf("new")) ? 3 : 0;
  });
  fs::permissions(folder, fs::perms(0755));
  CHECK(code == 0);
  CHECK(Sandbox::get(file) == "old");
  CHECK(box.filesIn(folder) == 1);
}

TEST_CASE("SIGKILL at any moment leaves the old or the new file, whole", "[file]") {
  const Sandbox box;
  const fs::path folder = box.root / "out", file = folder / "f.bin";
  fs::create_directory(folder);
  const std::string contents[2] = {std::string(300000, 'a'), std::string(500000, 'b')};
  Sandbox::put(file, contents[0]);
  const int kills = std::getenv("BURNISH_LONG") ? 2000 : 60;
  for (int i = 0; i < kills; ++i) {
    const pid_t pid = ::fork();
    if (pid == 0)
      for (int k = 0;; ++k) (void)core::writeFileAtomic(file, bytesOf(contents[k % 2]));
    std::this_thread::sleep_for(std::chrono::microseconds(200 + 137 * (i % 40)));
    ::kill(pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
    const std::string now = Sandbox::get(file);
    const bool whole = now == contents[0] || now == contents[1];
    REQUIRE(whole);
  }
  // Killed exactly between linkat and rename a temporary name stays: one kill in 200 in this loop that does nothing but
  // write.
  const bool hasUnnamedFiles =
      ::access("/proc/self/fd", F_OK) == 0 && ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600) >= 0;
  if (hasUnnamedFiles) CHECK(box.filesIn(folder) <= 3 + static_cast<std::size_t>(kills) / 50);
}
