// burnish-decode: decodes pictures for the decoder pool, in processes of its own (engine/image/decode_protocol.h).
// Not meant to be run by hand. Its standard input is a socket from the pool; the standard output and error go nowhere.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>

#include "image/decode_protocol.h"
#include "oiio_decode.h"

namespace {

using namespace burnish;
using namespace burnish::image;

constexpr int kWorkerSocket = 0, kWorkerMemory = 3;
#ifdef __SANITIZE_ADDRESS__
constexpr rlim_t kSpareFiles = 8;  // the sanitizers' own checks open pipes
#else
constexpr rlim_t kSpareFiles = 0;
#endif

template <class T>
bool sendMessage(int socket, const T& message) {
  return ::send(socket, &message, sizeof message, MSG_NOSIGNAL) == static_cast<ssize_t>(sizeof message);
}

template <class T>
bool receiveMessage(int socket, T& message) {
  ssize_t n = 0;
  do n = ::recv(socket, &message, sizeof message, 0);
  while (n < 0 && errno == EINTR);
  return n == static_cast<ssize_t>(sizeof message) && message.magic == kDecodeMagic;
}

void limit(decltype(RLIMIT_AS) what, rlim_t soft, rlim_t hard) {
  struct rlimit now {};
  if (::getrlimit(what, &now) != 0) return;
  const rlim_t top = std::min(hard, now.rlim_max);
  const struct rlimit value { std::min(soft, top), top };
  ::setrlimit(what, &value);
}

/// Address space in use, in bytes.
std::uint64_t addressSpace() {
  std::FILE* statm = std::fopen("/proc/self/statm", "re");
  unsigned long pages = 0;
  const bool known = statm && std::fscanf(statm, "%lu", &pages) == 1;
  if (statm) std::fclose(statm);
  return known ? std::uint64_t(pages) * std::uint64_t(::sysconf(_SC_PAGESIZE)) : 1024ull * 1024 * 1024;
}

/// What a worker gives up before it sees the first byte: memory, files (none can be opened, none can grow), privileges.
void confineWorker(std::uint64_t memoryBytes) {
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  const rlim_t space = addressSpace() + memoryBytes;
  limit(RLIMIT_AS, space, space);
  limit(RLIMIT_FSIZE, 0, 0);
  limit(RLIMIT_NOFILE, kWorkerMemory + 1 + kSpareFiles, kWorkerMemory + 1 + kSpareFiles);
}

/// The soft limit moves along with each picture: SIGXCPU ends a worker that nobody waits for any more.
void allowCpu(double seconds) {
  struct rusage used {};
  ::getrusage(RUSAGE_SELF, &used);
  const double soft =
      double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 2 + std::ceil(std::clamp(seconds, 0.0, 1e6));
  struct rlimit now {};
  if (::getrlimit(RLIMIT_CPU, &now) != 0) return;
  now.rlim_cur = std::min(static_cast<rlim_t>(soft), now.rlim_max);
  ::setrlimit(RLIMIT_CPU, &now);
}

/// A region of the shared memory.
class Mapped {
 public:
  Mapped(std::size_t bytes, int protection, off_t offset) : size_(bytes) {
    if (bytes > 0) at_ = ::mmap(nullptr, bytes, protection, MAP_SHARED, kWorkerMemory, offset);
  }
  Mapped(const Mapped&) = delete;
  Mapped& operator=(const Mapped&) = delete;
  ~Mapped() {
    if (at_ != MAP_FAILED) ::munmap(at_, size_);
  }
  [[nodiscard]] bool ok() const { return at_ != MAP_FAILED; }
  [[nodiscard]] std::span<std::byte> bytes() const { return {static_cast<std::byte*>(at_), size_}; }

 private:
  std::size_t size_;
  void* at_ = MAP_FAILED;
};

/// Pixels to the pool, a window at a time.
class WindowSink final : public decode::PixelSink {
 public:
  explicit WindowSink(std::span<std::byte> windows) : windows_(windows) {}

  bool begin(const decode::Decoded& layout, std::size_t) override {
    DecodeAnswer header{kDecodeMagic, AnswerKind::Header, layout.width, layout.height, layout.channels};
    header.type = static_cast<std::uint32_t>(layout.type);
    return sendMessage(kWorkerSocket, header);
  }
  std::span<std::byte> room() override {
    if (owed_ == kWindows) {
      WindowFree message;
      if (!receiveMessage(kWorkerSocket, message)) ::_exit(0);  // the pool has given up on this picture
      --owed_;
    }
    return windows_.subspan(turn_ * kWindowBytes, kWindowBytes);
  }
  bool commit(std::size_t bytes) override {
    DecodeAnswer pixels{kDecodeMagic, AnswerKind::Pixels};
    pixels.bytes = bytes;
    turn_ = (turn_ + 1) % kWindows;
    ++owed_;
    return sendMessage(kWorkerSocket, pixels);
  }
  /// Takes in what is still under way, so that the next message is the next request.
  void finish() {
    WindowFree message;
    for (; owed_ > 0; --owed_)
      if (!receiveMessage(kWorkerSocket, message)) ::_exit(0);
  }

 private:
  std::span<std::byte> windows_;
  std::size_t turn_ = 0, owed_ = 0;  ///< owed: windows sent whose WindowFree was not received
};

void answerRequest(const DecodeRequest& request, std::span<std::byte> windows) {
  Error error{"", "there is no memory to decode it", "make the picture smaller"};
  const Mapped file(request.fileBytes, PROT_READ, kFileOffset);
  if (file.ok()) {
    WindowSink sink(windows);
    auto decoded = decode::decodePicture(file.bytes(), "", {request.maxSide, request.maxBytes, request.seconds}, sink);
    sink.finish();
    if (decoded) return;
    error = decoded.error();
  }
  DecodeAnswer answer;
  std::strncpy(answer.what, error.what.c_str(), sizeof answer.what - 1);
  std::strncpy(answer.remedy, error.remedy.c_str(), sizeof answer.remedy - 1);
  sendMessage(kWorkerSocket, answer);
}

[[noreturn]] void serveAsWorker() {
  const Mapped windows(kFileOffset, PROT_READ | PROT_WRITE, 0);
  DecodeRequest request;
  while (windows.ok() && receiveMessage(kWorkerSocket, request)) {
    allowCpu(request.seconds);
    answerRequest(request, windows.bytes());
  }
  ::_exit(0);  // no destructors: this is a fork
}

/// In the forked child: its two descriptors take their numbers, all others close.
[[noreturn]] void becomeWorker(int socket, int memory, std::uint64_t memoryBytes, pid_t keeper) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // the keeper has one thread that forks, so this follows the process
  if (::getppid() != keeper) ::_exit(0);
  ::prctl(PR_SET_NAME, "burnish-decode");
  if (::dup2(socket, kWorkerSocket) < 0 || ::dup2(memory, kWorkerMemory) < 0) ::_exit(1);
  ::close_range(kWorkerMemory + 1, ~0u, 0);
  confineWorker(memoryBytes);
  serveAsWorker();
}

struct OrderWithDescriptors {
  KeeperOrder order;
  int socket = -1, memory = -1;
};

bool receiveOrder(OrderWithDescriptors& received) {
  alignas(cmsghdr) char control[CMSG_SPACE(2 * sizeof(int))];
  iovec part{&received.order, sizeof received.order};
  msghdr message{};
  message.msg_iov = &part, message.msg_iovlen = 1;
  message.msg_control = control, message.msg_controllen = sizeof control;
  ssize_t n = 0;
  do n = ::recvmsg(kKeeperSocket, &message, MSG_CMSG_CLOEXEC);
  while (n < 0 && errno == EINTR);
  if (n != static_cast<ssize_t>(sizeof received.order) || received.order.magic != kDecodeMagic) return false;
  const cmsghdr* header = CMSG_FIRSTHDR(&message);
  if (header && header->cmsg_level == SOL_SOCKET && header->cmsg_type == SCM_RIGHTS &&
      header->cmsg_len == CMSG_LEN(2 * sizeof(int))) {
    int descriptors[2];
    std::memcpy(descriptors, CMSG_DATA(header), sizeof descriptors);
    received.socket = descriptors[0], received.memory = descriptors[1];
  }
  return true;
}

KeeperAnswer forkWorker(const OrderWithDescriptors& received) {
  KeeperAnswer answer{kDecodeMagic, KeeperCommand::Fork, -1, EINVAL};
  const pid_t keeper = ::getpid();
  if (received.socket >= 0 && received.memory >= 0) {
    // dup2 must not meet the numbers that it writes to.
    const int socket = ::fcntl(received.socket, F_DUPFD_CLOEXEC, 16),
              memory = ::fcntl(received.memory, F_DUPFD_CLOEXEC, 16);
    answer.pid = ::fork();
    if (answer.pid == 0) becomeWorker(socket, memory, received.order.memoryBytes, keeper);
    answer.status = answer.pid < 0 ? errno : 0;
    ::close(socket);
    ::close(memory);
  }
  ::close(received.socket);
  ::close(received.memory);
  return answer;
}

/// Only children that were not waited for are ever signalled, so the number cannot have passed to a stranger.
KeeperAnswer endWorker(pid_t pid) {
  KeeperAnswer answer{kDecodeMagic, KeeperCommand::End, pid, 0};
  if (pid > 0 && ::waitpid(pid, &answer.status, WNOHANG) == 0) {
    ::kill(pid, SIGKILL);
    ::waitpid(pid, &answer.status,
              0);  // the true reason where it was dying already: its socket closes before it can be waited for
  }
  return answer;
}

int keep() {
  ::prctl(PR_SET_DUMPABLE, 0);
  limit(RLIMIT_CORE, 0, 0);
  if (::chdir("/") != 0) return 1;
  decode::prepareOpenImageIo();
  if (!sendMessage(kKeeperSocket, KeeperAnswer{kDecodeMagic, KeeperCommand::Ready, 0, kDecodeLayout})) return 0;
  OrderWithDescriptors received;
  while (receiveOrder(received)) {
    const bool isFork = received.order.command == KeeperCommand::Fork;
    const KeeperAnswer answer = isFork ? forkWorker(received) : endWorker(received.order.pid);
    if (!sendMessage(kKeeperSocket, answer)) break;
    received = {};
  }
  return 0;  // the pool is gone: the workers follow by PR_SET_PDEATHSIG
}

bool startedByPool() {
  int type = 0;
  socklen_t length = sizeof type;
  return ::getsockopt(kKeeperSocket, SOL_SOCKET, SO_TYPE, &type, &length) == 0 && type == SOCK_SEQPACKET;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view argument = argc > 1 ? argv[1] : "";
  if (argument == "--help" || argument == "--version" || !startedByPool()) {
    std::fprintf(
        argument.empty() ? stderr : stdout,
        "burnish-decode %s: decodes pictures for the burnish library and program, which start it by themselves.\n",
        BURNISH_VERSION);
    return argument.empty() ? 2 : 0;
  }
  const int status = keep();
  ::_exit(status);  // 260 libraries' destructors have nothing to say here
}
