// The pool's processes: who is started, ended, killed, waited for; and what one call costs when they misbehave.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "decode_jpegs.h"
#include "decode_pictures.h"

using namespace burnish;
using namespace decode_test;
namespace fs = std::filesystem;

namespace {

struct Process {
  pid_t pid, parent;
  char state;
};

/// Every living process that is called burnish-decode, with its parent.
std::vector<Process> decodeProcesses() {
  std::vector<Process> all;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream in(entry.path() / "stat");
    std::string line;
    std::getline(in, line);
    const std::size_t open = line.find('('), close = line.rfind(')');
    if (close == std::string::npos || line.substr(open + 1, close - open - 1) != "burnish-decode") continue;
    Process p{std::stoi(name), 0, 0};
    if (std::sscanf(line.c_str() + close + 1, " %c %d", &p.state, &p.parent) == 2 && p.state != 'Z') all.push_back(p);
  }
  return all;
}

/// The helpers that came up under a program since the watch began: not those of pools that other tests keep.
class Watch {
 public:
  explicit Watch(pid_t program = ::getpid()) : program_(program) {
    for (const Process& p : decodeProcesses()) before_.push_back(p.pid);
  }
  /// All helpers of another program, the keeper first.
  static std::vector<Process> under(pid_t program) {
    Watch watch(program);
    watch.before_.clear();
    return watch.all();
  }
  [[nodiscard]] std::vector<Process> keepers() const { return childrenOf({program_}); }
  [[nodiscard]] std::vector<Process> workers() const {
    std::vector<pid_t> parents;
    for (const Process& p : keepers()) parents.push_back(p.pid);
    return childrenOf(parents);
  }
  [[nodiscard]] Process worker() const {
    const auto all = workers();
    REQUIRE(all.size() == 1);
    return all[0];
  }
  [[nodiscard]] std::vector<Process> all() const {
    auto list = keepers();
    for (const Process& p : workers()) list.push_back(p);
    return list;
  }

 private:
  [[nodiscard]] std::vector<Process> childrenOf(const std::vector<pid_t>& parents) const {
    std::vector<Process> found;
    for (const Process& p : decodeProcesses())
      if (std::find(parents.begin(), parents.end(), p.parent) != parents.end() &&
          std::find(before_.begin(), before_.end(), p.pid) == before_.end())
        found.push_back(p);
    return found;
  }
  pid_t program_;
  std::vector<pid_t> before_;
};

bool exists(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
  std::string line;
  std::getline(in, line);
  const std::size_t close = line.rfind(')');
  return close != std::string::npos && line[close + 2] != 'Z';
}
bool within(std::chrono::milliseconds time, const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

const Bytes& smallPicture() {
  static const Bytes kBytes = bytesOfArray(kJpegRgb);
  return kBytes;
}
std::unique_ptr<ImageDecoder> newPool(int processes = 1) { return makeDecoderPool({kHelper, processes}); }

}  // namespace

TEST_CASE("A pool starts nothing before it is needed, reuses what it started, and ends it", "[decode][pool]") {
  const Watch watch;
  {
    auto pool = newPool();
    CHECK_FALSE(pool->decode(bytesOf("no picture"), "x"));
    CHECK_FALSE(pool->decode(makePng(20000, 1, {}, [](int, int, int) { return 0u; }), "too wide"));
    CHECK(watch.all().empty());
    REQUIRE(pool->decode(smallPicture(), "a"));
    const pid_t first = watch.worker().pid;
    for (int i = 0; i < 20; ++i) REQUIRE(pool->decode(smallPicture(), "b"));
    CHECK(watch.worker().pid == first);
    CHECK(watch.all().size() == 2);
  }
  CHECK(within(std::chrono::seconds(30), [&] { return watch.all().empty(); }));
}

TEST_CASE("A worker killed in the middle of a picture costs one error; the next picture decodes", "[decode][pool]") {
  const Watch watch;
  auto pool = newPool();
  REQUIRE(pool->decode(smallPicture(), "a"));
  const pid_t worker = watch.worker().pid;
  ::kill(worker, SIGSTOP);  // so that the kill below meets it with the request in hand
  std::atomic<bool> done{false};
  Result<Image> answer = fail("", "");
  std::thread caller([&] {
    answer = pool->decode(smallPicture(), "killed.jpg");
    done = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK_FALSE(done);
  ::kill(worker, SIGKILL);
  caller.join();
  REQUIRE_FALSE(answer);
  CHECK(answer.error().place == "killed.jpg");
  CHECK(answer.error().what.find("signal 9") != std::string::npos);
  CHECK_FALSE(answer.error().remedy.empty());
  CHECK(pool->decode(smallPicture(), "next"));
}

TEST_CASE("A worker or keeper killed while idle is replaced without an error", "[decode][pool]") {
  const Watch watch;
  auto pool = newPool();
  for (int i = 0; i < 5; ++i) {
    REQUIRE(pool->decode(smallPicture(), "a"));
    const Process worker = watch.worker();
    ::kill(i % 2 == 0 ? worker.pid : worker.parent, SIGKILL);  // a keeper's workers follow it
    REQUIRE(
        within(std::chrono::seconds(30), [&] { return !exists(worker.pid) && (i % 2 == 0 || !exists(worker.parent)); }));
  }
  CHECK(pool->decode(smallPicture(), "last"));
}

TEST_CASE("A picture that takes too long is given up in time; the next one decodes", "[decode][pool]") {
  const Watch watch;
  auto pool = newPool();
  REQUIRE(pool->decode(smallPicture(), "a"));
  const pid_t worker = watch.worker().pid;
  ::kill(worker, SIGSTOP);  // stands for any hang
  DecodeLimits limits;
  limits.seconds = 0.2;
  const auto begin = std::chrono::steady_clock::now();
  auto answer = pool->decode(smallPicture(), "slow.png", limits);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  REQUIRE_FALSE(answer);
  CHECK(answer.error().message().find("0.2 s") != std::string::npos);
  CHECK(seconds > 0.19);
  CHECK(seconds < 10);
  CHECK_FALSE(exists(worker));
  CHECK(pool->decode(smallPicture(), "next"));
}

TEST_CASE("A worker's memory is limited", "[decode][pool]") {
  DecoderPoolOptions options{kHelper, 1};
  options.memoryBytes = 100ull << 20;
  auto pool = makeDecoderPool(options);
  auto answer = pool->decode(makeHdr("+Y 2500 +X 2500", 2500 * 2500, [](int) { return 0x80808080u; }),
                             "large.hdr");  // 75 MB at once
  REQUIRE_FALSE(answer);
#ifndef __SANITIZE_ADDRESS__  // which ends the process instead of throwing bad_alloc
  CHECK(answer.error().message().find("memory") != std::string::npos);
#endif
  auto next = pool->decode(smallPicture(), "next");
  CHECK((next ? "" : next.error().message()) == "");
}

TEST_CASE("A missing or wrong helper is one clear error with a remedy", "[decode][pool]") {
  for (const char* helper : {"/no/such/burnish-decode", "/etc/passwd", "/tmp", "/bin/true", "/bin/false"}) {
    INFO(helper);
    auto pool = makeDecoderPool({helper, 1, true});
    for (int i = 0; i < 2; ++i) {
      auto answer = pool->decode(smallPicture(), "p.jpg");
      REQUIRE_FALSE(answer);
      CHECK(answer.error().place == "p.jpg");
      CHECK(answer.error().what.find(helper) != std::string::npos);
      CHECK_FALSE(answer.error().remedy.empty());
    }
  }
  auto found = makeDecoderPool({});  // beside this test program
  CHECK(found->decode(smallPicture(), "p.jpg"));
}

TEST_CASE("Many threads share a pool; no more workers run than asked for", "[decode][pool]") {
  const Watch watch;
  auto pool = newPool(2);
  const Bytes png = makePng(64, 64, {2, 8}, [](int x, int y, int c) { return unsigned(x + 2 * y + 3 * c) & 255; });
  const Image want = pool->decode(png, "want").value();
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 25; ++i) {
        if ((i + t) % 5 == 0) {
          Bytes broken = png;
          broken.resize(png.size() / 2);
          if (pool->decode(broken, "broken")) ++wrong;
          continue;
        }
        auto image = pool->decode(png, "p");
        if (!image || image->data != want.data) ++wrong;
      }
    });
  for (auto& thread : threads) thread.join();
  CHECK(wrong == 0);
  CHECK(watch.keepers().size() == 1);
  CHECK(watch.workers().size() == 2);
}

TEST_CASE("Helpers end with a program that is killed", "[decode][pool]") {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    auto pool = newPool();
    const bool ok = pool->decode(smallPicture(), "a").has_value();
    (void)!::write(ends[1], ok ? "y" : "n", 1);
    for (;;) ::pause();
  }
  char answer = 0;
  REQUIRE(::read(ends[0], &answer, 1) == 1);
  CHECK(answer == 'y');
  const auto helpers = Watch::under(child);
  if (helpers.size() == 2) ::kill(helpers[1].pid, SIGSTOP);  // even one that does not listen
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  CHECK(helpers.size() == 2);
  CHECK(within(std::chrono::seconds(30), [&] {
    return std::none_of(helpers.begin(), helpers.end(), [](const Process& p) { return exists(p.pid); });
  }));
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_CASE("A helper inherits no file of the program, and can open none", "[decode][pool]") {
  const int leaked = ::open("/etc/passwd", O_RDONLY);  // without close-on-exec, as careless hosts do
  const Watch watch;
  auto pool = newPool();
  REQUIRE(pool->decode(smallPicture(), "a"));
  for (const Process& p : watch.all()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(p.pid) + "/fd", error)) {
      const std::string target = fs::read_symlink(entry.path(), error);
      INFO(target);
      CHECK((target.starts_with("socket:") || target.starts_with("/dev/null") ||
             target.starts_with("/memfd:burnish-decode")));
    }
    if (p.parent == ::getpid()) continue;
    std::ifstream limits("/proc/" + std::to_string(p.pid) + "/limits");
    const std::string text{std::istreambuf_iterator<char>(limits), {}};
    if (text.empty()) continue;  // hidden from this user
    const auto soft = [&](const char* name) {
      const std::size_t at = text.find(name);
      return at == std::string::npos ? -1L : std::strtol(text.c_str() + at + std::strlen(name), nullptr, 10);
    };
    CHECK(soft("Max file size") == 0);
#ifdef __SANITIZE_ADDRESS__
    CHECK(soft("Max open files") == 12);  // the sanitizers' own checks open pipes
#else
    CHECK(soft("Max open files") == 4);
#endif
    CHECK(soft("Max core file size") == 0);
    CHECK(soft("Max address space") > 0);
    CHECK(soft("Max cpu time") > 0);
  }
  ::close(leaked);
}

TEST_CASE("A pool works in a program without standard streams", "[decode][pool]") {
  const pid_t child = ::fork();
  if (child == 0) {
    for (int fd = 0; fd < 3; ++fd) ::close(fd);
    ::signal(SIGPIPE, SIG_DFL);
    bool ok = false;
    {
      auto pool = newPool();
      ok = pool->decode(smallPicture(), "a").has_value();
    }
    ::_exit(ok ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK(status == 0);
}
