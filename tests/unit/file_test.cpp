// core/file: what untrusted names can reach, and files that are complete or absent.
#include <burnish/result.h>
#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "core/file.h"

namespace fs = std::filesystem;
using namespace burnish;

namespace {

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

std::span<const std::byte> bytesOf(std::string_view text) { return std::as_bytes(std::span(text.data(), text.size())); }
std::string textOf(const std::vector<std::byte>& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// Runs `body` in a child; gives its exit code, or 1000 + signal.
int inChild(const std::function<int()>& body) {
  const pid_t pid = ::fork();
  if (pid == 0) ::_exit(body());
  int status = 0;
  REQUIRE(::waitpid(pid, &status, 0) == pid);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

}  // namespace

TEST_CASE("readFile reads regular files up to the limit", "[file]") {
  const Sandbox box;
  auto bytes = core::readFile(box.root / "asset/a.bin", 6);
  REQUIRE(bytes);
  CHECK(textOf(*bytes) == "inside");
  Sandbox::put(box.root / "empty", "");
  CHECK(core::readFile(box.root / "empty", 0).value().empty());
  auto large = core::readFile(box.root / "asset/a.bin", 5);
  REQUIRE_FALSE(large);
  CHECK(large.error().place.find("a.bin") != std::string::npos);
  CHECK(large.error().what.find("6 bytes") != std::string::npos);
  CHECK_FALSE(large.error().remedy.empty());
}

TEST_CASE("readFile refuses what is not a regular file, without waiting for it", "[file]") {
  const Sandbox box;
  const fs::path fifo = box.root / "fifo", sock = box.root / "socket";
  REQUIRE(::mkfifo(fifo.c_str(), 0600) == 0);
  const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{AF_UNIX, {}};
  std::strncpy(address.sun_path, sock.c_str(), sizeof address.sun_path - 1);
  REQUIRE(::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  ::close(listener);
  const auto begin = std::chrono::steady_clock::now();
  for (const auto& [file, kind] : {std::pair<fs::path, const char*>{fifo, "FIFO"}, {sock, "socket"}, {"/dev/zero", "device"},
                                   {"/dev/tty", "device"}, {box.root, "folder"}, {box.root / "none", "open"}}) {
    INFO(file);
    auto bytes = core::readFile(file, 1 << 20);
    REQUIRE_FALSE(bytes);
    CHECK(bytes.error().message().find(kind) != std::string::npos);
    CHECK_FALSE(bytes.error().remedy.empty());
  }
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(1));
}

TEST_CASE("A sparse file of 3 GB is refused by its size alone", "[file]") {
  const Sandbox box;
  const fs::path file = box.root / "asset/sparse.bin";
  Sandbox::put(file, "x");
  fs::resize_file(file, 3ull << 30);
  struct rusage before {}, after {};
  ::getrusage(RUSAGE_SELF, &before);
  REQUIRE_FALSE(core::readFile(file, 2ull << 30));
  REQUIRE_FALSE(core::readFileInside(box.root / "asset", "sparse.bin", false, 4));
  ::getrusage(RUSAGE_SELF, &after);
  CHECK(after.ru_maxrss - before.ru_maxrss < 10240);
}

TEST_CASE("Names inside the asset's folder are found", "[file]") {
  const Sandbox box;
  const fs::path asset = box.root / "asset";
  Sandbox::put(asset / "with space.bin", "1");
  Sandbox::put(asset / "100%.bin", "2");
  Sandbox::put(asset / "lit%20eral.bin", "3");
  Sandbox::put(asset / "..dots", "4");
  fs::create_symlink("textures/t.png", asset / "link.png");
  fs::create_symlink(asset / "textures", asset / "absolute link");
  const std::pair<const char*, const char*> cases[] = {{"a.bin", "inside"},
                                                       {"./a.bin", "inside"},
                                                       {"textures/t.png", "texture"},
                                                       {"textures/../a.bin", "inside"},
                                                       {"textures\\t.png", "texture"},
                                                       {"with%20space.bin", "1"},
                                                       {"with space.bin", "1"},
                                                       {"100%.bin", "2"},
                                                       {"100%25.bin", "2"},
                                                       {"lit%20eral.bin", "3"},
                                                       {"..dots", "4"},
                                                       {"link.png", "texture"},
                                                       {"absolute%20link/t.png", "texture"}};
  for (const auto& [uri, content] : cases) {
    INFO(uri);
    auto path = core::resolveInside(asset, uri, false);
    REQUIRE(path);
    CHECK(path->is_absolute());
    CHECK(path->native().starts_with(asset.native() + "/"));
    CHECK(Sandbox::get(*path) == content);
    CHECK(textOf(core::readFileInside(asset, uri, false, 100).value()) == content);
  }
}

TEST_CASE("Names that lead out of the asset's folder are refused", "[file]") {
  const Sandbox box;
  const fs::path asset = box.root / "asset";
  fs::create_directories(box.root / "asset-two");
  Sandbox::put(box.root / "asset-two/b.bin", "beside");
  fs::create_symlink("../secret.txt", asset / "file link");
  fs::create_symlink(box.root, asset / "folder link");
  fs::create_symlink("loop", asset / "loop");
  REQUIRE(::mkfifo((asset / "fifo").c_str(), 0600) == 0);
  const std::string absolute = (box.root / "secret.txt").string(), fileUri = "file://" + absolute;
  const std::string_view nul("a.bin\0.png", 10);
  const std::string_view refused[] = {"", "../secret.txt", "textures/../../secret.txt", "%2e%2e/secret.txt", "..%2fsecret.txt", "%2E%2E%2Fsecret.txt",
                                      "..\\secret.txt", "textures\\..\\..\\secret.txt", "%2e%2e%5csecret.txt", "../asset-two/b.bin", "../asset/a.bin",
                                      absolute, "/etc/passwd", "%2fetc%2fpasswd", "\\etc\\passwd", fileUri, "file:a.bin", "FILE:///etc/passwd",
                                      "http://localhost/a.bin", "https%3A//localhost/a.bin", "data:,x", "C:\\a.bin", "c:/a.bin", nul, "a.bin%00.png",
                                      "file link", "file%20link", "folder link/secret.txt", "folder link/asset/../secret.txt", "loop", "fifo", "textures",
                                      ".", "none.bin", "a.bin/", "a.bin/x"};
  for (std::string_view uri : refused) {
    INFO(std::string(uri));
    auto path = core::resolveInside(asset, uri, false);
    CHECK_FALSE(path);
    auto bytes = core::readFileInside(asset, uri, false, 100);
    REQUIRE_FALSE(bytes);
    CHECK_FALSE(bytes.error().what.empty());
    CHECK_FALSE(bytes.error().remedy.empty());
    CHECK(bytes.error().message().find('\0') == std::string::npos);
  }
  SECTION("allowOutside lets paths out, and still fetches nothing") {
    CHECK(textOf(core::readFileInside(asset, "../secret.txt", true, 100).value()) == "secret");
    CHECK(textOf(core::readFileInside(asset, absolute, true, 100).value()) == "secret");
    CHECK(textOf(core::readFileInside(asset, "file%20link", true, 100).value()) == "secret");
    for (std::string_view uri : {std::string_view(fileUri), std::string_view("http://localhost/"), nul, std::string_view("fifo"), std::string_view("textures")})
      CHECK_FALSE(core::readFileInside(asset, uri, true, 100));
  }
}

TEST_CASE("A folder that is itself reached through a link is no way out", "[file]") {
  const Sandbox box;
  fs::create_directory_symlink(box.root / "asset", box.root / "alias");
  CHECK(core::resolveInside(box.root / "alias", "a.bin", false).value() == box.root / "asset/a.bin");
  CHECK_FALSE(core::resolveInside(box.root / "alias", "../secret.txt", false));
  CHECK_FALSE(core::resolveInside(box.root / "no such folder", "a.bin", false));
}

TEST_CASE("A name exchanged for a link while it is read never gives what lies outside", "[file]") {
  const Sandbox box;
  const fs::path asset = box.root / "asset", name = asset / "swap.bin";
  Sandbox::put(asset / "good", "inside");
  fs::create_symlink("../secret.txt", asset / "bad");
  std::atomic<bool> stop{false};
  std::thread swapper([&] {
    while (!stop) {
      fs::remove(name);
      fs::create_hard_link(asset / "good", name);
      fs::remove(name);
      fs::copy_symlink(asset / "bad", name);
    }
  });
  int inside = 0, leaked = 0, refused = 0;
  for (int i = 0; i < 20000; ++i) {
    auto bytes = core::readFileInside(asset, "swap.bin", false, 100);
    if (!bytes) ++refused;
    else if (textOf(*bytes) == "inside") ++inside;
    else ++leaked;
  }
  stop = true;
  swapper.join();
  CHECK(leaked == 0);
  CHECK(inside > 0);
  CHECK(refused > 0);
}

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
  for (const fs::path& file : {fs::path(), box.root, box.root / "no/such/folder/f", box.root / "secret.txt/f", fs::path(box.root / "asset/"), box.root / "loop",
                               box.root / std::string(256, 'n'), fs::path("/proc/no-such-file")}) {
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
    const struct rlimit limit {4096, 4096};
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
    if (::unshare(namespaces) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return kNoNamespaces;
    if (::mount("none", folder.c_str(), "tmpfs", 0, "size=64k") != 0) return kNoNamespaces;
    if (!core::writeFileAtomic(folder / "f.bin", bytesOf("old"))) return 1;
    auto written = core::writeFileAtomic(folder / "f.bin", bytesOf(large));
    if (written || written.error().remedy.find("room") == std::string::npos) return 2;
    return Sandbox::get(folder / "f.bin") == "old" && box.filesIn(folder) == 1 ? 0 : 3;
  });
  if (code == kNoNamespaces) WARN("no file system can be mounted here: a full disk was tried through /dev/full and RLIMIT_FSIZE alone");
  else CHECK(code == 0);
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
  // Killed exactly between linkat and rename a temporary name stays: one kill in 200 in this loop that does nothing but write.
  const bool hasUnnamedFiles = ::access("/proc/self/fd", F_OK) == 0 && ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600) >= 0;
  if (hasUnnamedFiles) CHECK(box.filesIn(folder) <= 3 + static_cast<std::size_t>(kills) / 50);
}
