// The pool's side of the helper program: starting it, and having it fork and end workers
// (engine/image/decode_protocol.h).
#pragma once
#include <burnish/result.h>
#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <utility>

#include "core/unique_fd.h"
#include "image/decode_protocol.h"

namespace burnish::image {

using Deadline = std::chrono::steady_clock::time_point;

enum class Receipt { Message, Closed, TimedOut };
/// Waits until the deadline for one whole message of `size` bytes that starts with kDecodeMagic; anything else counts
/// as Closed.
Receipt receiveMessage(int socket, void* message, std::size_t size, Deadline deadline);
/// False when the other end is gone.
bool sendMessage(int socket, const void* message, std::size_t size);

/// The windows of a worker's memory, mapped for reading.
class WindowMap {
 public:
  WindowMap() = default;
  explicit WindowMap(int memory);
  WindowMap(WindowMap&& other) noexcept : at_(std::exchange(other.at_, nullptr)) {}
  WindowMap& operator=(WindowMap&& other) noexcept {
    std::swap(at_, other.at_);
    return *this;
  }
  WindowMap(const WindowMap&) = delete;
  WindowMap& operator=(const WindowMap&) = delete;
  ~WindowMap();
  [[nodiscard]] const std::byte* window(std::size_t index) const {
    return static_cast<const std::byte*>(at_) + index * kWindowBytes;
  }
  [[nodiscard]] explicit operator bool() const { return at_ != nullptr; }

 private:
  void* at_ = nullptr;
};

/// One worker as the keeper made it. Closing the socket makes it exit.
struct Worker {
  pid_t pid = -1;
  core::UniqueFd socket;
  core::UniqueFd memory;  ///< memfd, sealed against shrinking
  WindowMap windows;
  [[nodiscard]] bool alive() const { return static_cast<bool>(socket); }
};

/// Not safe to use from two threads at a time; the pool holds a lock.
class DecodeKeeper {
 public:
  DecodeKeeper() = default;
  DecodeKeeper(const DecodeKeeper&) = delete;
  DecodeKeeper& operator=(const DecodeKeeper&) = delete;
  ~DecodeKeeper() { stop(); }

  /// Starts the program unless it runs; returns at once, loading goes on in the background. Not inherited: any
  /// descriptor, any environment variable but LD_LIBRARY_PATH, any signal setting.
  Result<void> start(const std::filesystem::path& helper);
  /// start(), waiting for it if need be (up to a minute on a machine that starts cold), then a new worker. Starts the
  /// program anew, once, when it turns out to be gone.
  Result<Worker> fork(const std::filesystem::path& helper, std::uint64_t memoryBytes);
  /// Ends a worker for good. Returns its wait status (SIGKILL when it was still running), or -1 when that is not known
  /// any more.
  int end(Worker& worker);
  void stop();

 private:
  bool awaitReady();
  bool ask(const KeeperOrder& order, const int* descriptors, KeeperAnswer& answer);

  core::UniqueFd socket_;
  pid_t pid_ = -1;
  bool ready_ = false;
};

}  // namespace burnish::image
