// What is not written, and files and folders that are whole or as they were.
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <thread>

#include "core/file.h"
#include "cube_fixture.h"

using namespace cube_test;

namespace {

/// Runs `body` in a child; gives its exit code, or 1000 + signal.
int inChild(const std::function<int()>& body) {
  const pid_t pid = ::fork();
  if (pid == 0) ::_exit(body());
  int status = 0;
  REQUIRE(::waitpid(pid, &status, 0) == pid);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

constexpr const char* kContainers[] = {"c.dds", "c.ktx2", "c.exr", "c"};

Cubemap grey(float value) {
  Cubemap cube = directionChain(16, 2, ReflectionLobe::BlinnPhong, true);
  for (CubeLevel& level : cube.levels) std::fill(level.texels.begin(), level.texels.end(), value);
  return cube;
}

}  // namespace

TEST_CASE("Cubemaps that would not be read back are not written", "[cubemap]") {
  const Folder folder;
  Report report;
  const Cubemap good = directionChain(8, 3, ReflectionLobe::Ggx, true);
  const auto refused = [&](const std::function<void(Cubemap&)>& spoil) {
    for (const char* name : kContainers) {
      Cubemap bad = good;
      spoil(bad);
      const auto written = writeCubemap(folder.path / name, bad, PixelType::F16, report);
      REQUIRE_FALSE(written);
      CHECK(written.error().place.find(name) != std::string::npos);
      CHECK_FALSE(written.error().remedy.empty());
    }
  };
  refused([](Cubemap& c) { c.levels.clear(); });
  refused([](Cubemap& c) { c.levels[1].size = 3; });
  refused([](Cubemap& c) { c.levels[1].texels.pop_back(); });
  refused([](Cubemap& c) { std::swap(c.levels[0], c.levels[1]); });
  refused([](Cubemap& c) { c.levels[2].roughness = 0.01; });
  refused([](Cubemap& c) { c.levels[2].roughness = 1.01; });
  refused([](Cubemap& c) { c.levels[2].roughness = std::nan(""); });
  refused([](Cubemap& c) { c.lobe.reset(); });
  refused([](Cubemap& c) { c.levels[1].texels[5] = std::nanf(""); });
  refused([](Cubemap& c) { c.levels[1].texels[5] = std::numeric_limits<float>::infinity(); });
  refused([](Cubemap& c) { c.levels[1].texels[5] = -1e-6f; });
  refused([](Cubemap& c) { c.levels.insert(c.levels.end(), {c.levels[2], c.levels[2], c.levels[2]}); });
  CHECK_FALSE(writeCubemap(folder.path / "c.dds", good, PixelType::U8, report));
  CHECK(writeCubemap(folder.path / "c.png", good, PixelType::F16, report).error().remedy.find(".ktx2") != std::string::npos);
  CHECK(fs::is_empty(folder.path));
}

TEST_CASE("Values beyond half floats are held there, with a warning; floats keep them", "[cubemap]") {
  const Folder folder;
  for (const char* name : kContainers) {
    Cubemap cube = grey(1);
    cube.levels[0].texels[7] = 1e5f, cube.levels[1].texels[3] = 1e30f;
    Report report;
    REQUIRE(writeCubemap(folder.path / name, cube, PixelType::F32, report));
    CHECK(report.empty());
    checkSame(*readCubemap(folder.path / name, report, options()), cube);
    REQUIRE(writeCubemap(folder.path / name, cube, PixelType::F16, report));
    REQUIRE(report.warnings().size() == 1);
    CHECK(report.warnings()[0].what.find("2 values above 65504 (largest 1e+30)") == 0);
    cube.levels[0].texels[7] = cube.levels[1].texels[3] = 65504;
    checkSame(*readCubemap(folder.path / name, report, options()), cube);
  }
}

TEST_CASE("A folder of faces goes only if it holds nothing else", "[cubemap]") {
  const Folder folder;
  const fs::path out = folder.path / "probe";
  Report report;
  REQUIRE(writeCubemap(out, directionChain(8, 4, ReflectionLobe::Ggx, true), PixelType::F16, report));
  CHECK(namesIn(out).size() == 24);
  fs::permissions(out, fs::perms(0750));
  REQUIRE(writeCubemap(folder.path / "probe/", directionChain(8, 2, ReflectionLobe::Ggx, true), PixelType::F16, report));
  CHECK(namesIn(out).size() == 12);
  CHECK(fs::status(out).permissions() == fs::perms(0750));
  fs::create_directory_symlink("probe", folder.path / "link");
  REQUIRE(writeCubemap(folder.path / "link", directionChain(8, 1, ReflectionLobe::Ggx, true), PixelType::F16, report));
  CHECK(fs::is_symlink(folder.path / "link"));
  CHECK(namesIn(out).size() == 6);
  for (const char* foreign : {"notes.txt", "level0_qx.exr", "level0_px.exr.bak"}) {
    std::ofstream(out / foreign) << "precious";
    const auto written = writeCubemap(out, grey(1), PixelType::F16, report);
    REQUIRE_FALSE(written);
    CHECK(written.error().what.find(foreign) != std::string::npos);
    CHECK(namesIn(out).size() == 7);
    fs::remove(out / foreign);
  }
  fs::create_directory(out / "level1_px.exr");
  CHECK_FALSE(writeCubemap(out, grey(1), PixelType::F16, report));
  std::ofstream(folder.path / "file") << "precious";
  CHECK_FALSE(writeCubemap(folder.path / "file", grey(1), PixelType::F16, report));
  CHECK_FALSE(writeCubemap(folder.path / "no/such", grey(1), PixelType::F16, report));
  CHECK(namesIn(folder.path) == std::vector<std::string>{"file", "link", "probe"});
}

TEST_CASE("A file size limit and a folder without rights leave what was there", "[cubemap]") {
  const Folder folder;
  Report report;
  for (const char* name : kContainers) REQUIRE(writeCubemap(folder.path / name, grey(1), PixelType::F16, report));
  const int limited = inChild([&] {
    const struct rlimit limit { 64, 64 };
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 1;
    for (const char* name : kContainers) {
      const auto written = writeCubemap(folder.path / name, grey(2), PixelType::F16, report);
      if (written || written.error().remedy.find("ulimit") == std::string::npos) return 2;
    }
    return 0;
  });
  CHECK(limited == 0);
  fs::permissions(folder.path, fs::perms(0555));
  fs::permissions(folder.path / "c", fs::perms(0555));
  const int refused = inChild([&] {
    if (::geteuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) return 1;
    for (const char* name : {"c.dds", "new.ktx2", "new.exr", "c", "new"})
      if (writeCubemap(folder.path / name, grey(2), PixelType::F16, report)) return 2;
    return 0;
  });
  fs::permissions(folder.path, fs::perms(0755));
  fs::permissions(folder.path / "c", fs::perms(0755));
  CHECK(refused == 0);
  CHECK(namesIn(folder.path).size() == 4);
  for (const char* name : kContainers) checkSame(*readCubemap(folder.path / name, report, options()), grey(1));
}

TEST_CASE("SIGKILL at any moment leaves the old or the new set of faces, whole", "[cubemap]") {
  const Folder folder;
  const fs::path out = folder.path / "probe";
  Report report;
  const Cubemap cubes[2] = {grey(1), grey(2)};
  REQUIRE(writeCubemap(out, cubes[0], PixelType::F16, report));
  const int kills = std::getenv("BURNISH_LONG") ? 500 : 40;
  for (int i = 0; i < kills; ++i) {
    const pid_t pid = ::fork();
    if (pid == 0)
      for (int k = 0;; ++k) (void)writeCubemap(out, cubes[k % 2], PixelType::F16, report);
    std::this_thread::sleep_for(std::chrono::microseconds(500 + 791 * (i % 40)));
    ::kill(pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
    if (i % 4 != 0) continue;  // reading takes longer than writing
    const auto read = readCubemap(out, report, options());
    INFO((read ? std::string() : read.error().message()));
    REQUIRE(read);
    CHECK((read->levels[0].texels[0] == 1 || read->levels[0].texels[0] == 2));
    checkSame(*read, grey(read->levels[0].texels[0]));
  }
  for (const std::string& name : namesIn(folder.path)) CHECK((name == "probe" || name.find(".burnish-") == 0));
}
