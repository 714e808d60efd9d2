#include "image/decode_keeper.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>

#include "core/spawn_plan.h"

namespace burnish::image {
namespace {

constexpr auto kStartTime = std::chrono::seconds(60);   // a cold disk and 134 MB of libraries
constexpr auto kAnswerTime = std::chrono::seconds(20);  // the keeper only forks and waits for killed children

bool socketPair(core::UniqueFd& ours, core::UniqueFd& theirs) {
  int pair[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair) != 0) return false;
  ours.reset(pair[0]);
  theirs.reset(pair[1]);
  return true;
}

int spawn(const std::filesystem::path& helper, int socket, pid_t& pid) {
  core::SpawnPlan plan;
  posix_spawn_file_actions_adddup2(&plan.actions, socket, kKeeperSocket);
  posix_spawn_file_actions_addopen(&plan.actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&plan.actions, 2, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addclosefrom_np(&plan.actions, 3);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&plan.attributes, &none);
  posix_spawnattr_setsigdefault(&plan.attributes, &all);
  posix_spawnattr_setpgroup(&plan.attributes, 0);  // Ctrl-C is for the program, which then ends its helpers
  posix_spawnattr_setflags(&plan.attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::string name = helper.string(), libraries = "LD_LIBRARY_PATH=";
  const char* path = std::getenv("LD_LIBRARY_PATH");
  if (path) libraries += path;
  char* arguments[] = {name.data(), nullptr};
  char* environment[] = {path ? libraries.data() : nullptr, nullptr};
  return ::posix_spawn(&pid, helper.c_str(), &plan.actions, &plan.attributes, arguments, environment);
}

std::string startFailure(const std::filesystem::path& helper) {
  return fmt::format("the decode helper {} did not get ready", helper.string());
}

}  // namespace

WindowMap::WindowMap(int memory) {
  void* at = ::mmap(nullptr, kFileOffset, PROT_READ, MAP_SHARED, memory, 0);
  if (at != MAP_FAILED) at_ = at;
}
WindowMap::~WindowMap() {
  if (at_) ::munmap(at_, kFileOffset);
}

Receipt receiveMessage(int socket, void* message, std::size_t size, Deadline deadline) {
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()).count();
    pollfd waiting{socket, POLLIN, 0};
    const int n = ::poll(&waiting, 1, static_cast<int>(std::clamp<long long>(left + 1, 0, 1 << 30)));
    if (n < 0 && errno == EINTR) continue;
    if (n == 0 && left <= 0) return Receipt::TimedOut;
    if (n == 0) continue;
    const ssize_t got = ::recv(socket, message, size, MSG_DONTWAIT);
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    std::uint32_t magic = 0;
    if (got == static_cast<ssize_t>(size)) std::memcpy(&magic, message, sizeof magic);
    return magic == kDecodeMagic ? Receipt::Message : Receipt::Closed;
  }
}

bool sendMessage(int socket, const void* message, std::size_t size) {
  ssize_t n = 0;
  do n = ::send(socket, message, size, MSG_NOSIGNAL);
  while (n < 0 && errno == EINTR);
  return n == static_cast<ssize_t>(size);
}

Result<void> DecodeKeeper::start(const std::filesystem::path& helper) {
  if (socket_) return {};
  core::UniqueFd theirs;
  if (!socketPair(socket_, theirs))
    return fail("decoder pool", fmt::format("no socket for the helper ({})", std::strerror(errno)), "close some files");
  // Not 0 itself (a host without standard input): posix_spawn's dup2 onto the same number is a special case in libc
  // versions.
  if (theirs.get() == kKeeperSocket) theirs.reset(::fcntl(theirs.get(), F_DUPFD_CLOEXEC, 3));
  ready_ = false;
  if (const int error = spawn(helper, theirs.get(), pid_); error != 0) {
    pid_ = -1;
    socket_.reset();
    return fail(helper.string(), fmt::format("cannot be started ({})", std::strerror(error)),
                "check that it is the burnish-decode program");
  }
  return {};
}

bool DecodeKeeper::awaitReady() {
  if (ready_) return true;
  KeeperAnswer answer;
  ready_ = receiveMessage(socket_.get(), &answer, sizeof answer, std::chrono::steady_clock::now() + kStartTime) ==
               Receipt::Message &&
           answer.command == KeeperCommand::Ready && answer.status == kDecodeLayout;
  return ready_;
}

bool DecodeKeeper::ask(const KeeperOrder& order, const int* descriptors, KeeperAnswer& answer) {
  KeeperOrder copy = order;
  iovec part{&copy, sizeof copy};
  alignas(cmsghdr) char control[CMSG_SPACE(2 * sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &part, message.msg_iovlen = 1;
  if (descriptors) {
    message.msg_control = control, message.msg_controllen = sizeof control;
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET, header->cmsg_type = SCM_RIGHTS, header->cmsg_len = CMSG_LEN(2 * sizeof(int));
    std::memcpy(CMSG_DATA(header), descriptors, 2 * sizeof(int));
  }
  ssize_t n = 0;
  do n = ::sendmsg(socket_.get(), &message, MSG_NOSIGNAL);
  while (n < 0 && errno == EINTR);
  return n == static_cast<ssize_t>(sizeof copy) &&
         receiveMessage(socket_.get(), &answer, sizeof answer, std::chrono::steady_clock::now() + kAnswerTime) ==
             Receipt::Message &&
         answer.command == order.command;
}

Result<Worker> DecodeKeeper::fork(const std::filesystem::path& helper, std::uint64_t memoryBytes) {
  Worker worker;
  core::UniqueFd theirs;
  worker.memory.reset(::memfd_create("burnish-decode", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  const bool sized = worker.memory && ::ftruncate(worker.memory.get(), kFileOffset) == 0 &&
                     ::fcntl(worker.memory.get(), F_ADD_SEALS, F_SEAL_SHRINK) == 0;
  if (sized) worker.windows = WindowMap(worker.memory.get());
  if (!worker.windows || !socketPair(worker.socket, theirs))
    return fail("decoder pool", fmt::format("no socket or shared memory for a helper ({})", std::strerror(errno)),
                "close some files");
  const int descriptors[2] = {theirs.get(), worker.memory.get()};
  for (int tries = 0; tries < 2; ++tries) {
    if (auto started = start(helper); !started) return fail(started.error());
    KeeperAnswer answer;
    if (awaitReady() && ask({kDecodeMagic, KeeperCommand::Fork, 0, 0, memoryBytes}, descriptors, answer)) {
      if (answer.pid <= 0)
        return fail("decoder pool", fmt::format("the helper cannot fork ({})", std::strerror(answer.status)),
                    "end some processes or free memory");
      worker.pid = answer.pid;
      return worker;
    }
    stop();  // it was killed, or is stuck: once more with a new one
  }
  return fail("decoder pool", startFailure(helper),
              "install the one that came with this library; run it by hand to see whether it misses libraries");
}

int DecodeKeeper::end(Worker& worker) {
  worker.socket.reset();
  worker.memory.reset();
  worker.windows = {};
  const pid_t pid = std::exchange(worker.pid, -1);
  KeeperAnswer answer;
  if (pid <= 0 || !socket_) return -1;
  if (ask({kDecodeMagic, KeeperCommand::End, pid, 0, 0}, nullptr, answer)) return answer.status;
  stop();
  return -1;
}

void DecodeKeeper::stop() {
  socket_.reset();  // the keeper exits on this by itself, and its workers with it
  ready_ = false;
  const pid_t pid = std::exchange(pid_, -1);
  if (pid <= 0) return;
  // Loading can last; a number that waitpid does not know (the host reaped it) is never signalled.
  int status = 0;
  if (::waitpid(pid, &status, WNOHANG) != 0) return;
  ::kill(pid, SIGKILL);
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace burnish::image
