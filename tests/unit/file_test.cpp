// core/file: what untrusted names can reach.
#include "core/file.h"

#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>

#include "file_sandbox.h"

using namespace burnish;
using namespace file_test;

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
  for (const auto& [file, kind] : {std::pair<fs::path, const char*>{fifo, "FIFO"},
                                   {sock, "socket"},
                                   {"/dev/zero", "device"},
                                   {"/dev/tty", "device"},
                                   {box.root, "folder"},
                                   {box.root / "none", "open"}}) {
    INFO(file);
    auto bytes = core::readFile(file, 1 << 20);
    REQUIRE_FALSE(bytes);
    CHECK(bytes.error().message().find(kind) != std::string::npos);
    CHECK_FALSE(bytes.error().remedy.empty());
  }
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(10));  // a FIFO without a writer would keep it for ever
}

TEST_CASE("A sparse file of 3 GB is refused by its size alone", "[file]") {
  const Sandbox box;
  const fs::path file = box.root / "asset/sparse.bin";
  Sandbox::put(file, "x");
  fs::resize_file(file, 3ull << 30);
  struct rusage before {
  }, after{};
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
  const std::string_view refused[] = {"",
                                      "../secret.txt",
                                      "textures/../../secret.txt",
                                      "%2e%2e/secret.txt",
                                      "..%2fsecret.txt",
                                      "%2E%2E%2Fsecret.txt",
                                      "..\\secret.txt",
                                      "textures\\..\\..\\secret.txt",
                                      "%2e%2e%5csecret.txt",
                                      "../asset-two/b.bin",
                                      "../asset/a.bin",
                                      absolute,
                                      "/etc/passwd",
                                      "%2fetc%2fpasswd",
                                      "\\etc\\passwd",
                                      fileUri,
                                      "file:a.bin",
                                      "FILE:///etc/passwd",
                                      "http://localhost/a.bin",
                                      "https%3A//localhost/a.bin",
                                      "data:,x",
                                      "C:\\a.bin",
                                      "c:/a.bin",
                                      nul,
                                      "a.bin%00.png",
                                      "file link",
                                      "file%20link",
                                      "folder link/secret.txt",
                                      "folder link/asset/../secret.txt",
                                      "loop",
                                      "fifo",
                                      "textures",
                                      ".",
                                      "none.bin",
                                      "a.bin/",
                                      "a.bin/x"};
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
    for (std::string_view uri : {std::string_view(fileUri), std::string_view("http://localhost/"), nul,
                                 std::string_view("fifo"), std::string_view("textures")})
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
    if (!bytes)
      ++refused;
    else if (textOf(*bytes) == "inside")
      ++inside;
    else
      ++leaked;
  }
  stop = true;
  swapper.join();
  CHECK(leaked == 0);
  CHECK(inside > 0);
  CHECK(refused > 0);
}
