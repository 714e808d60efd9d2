// ImageDecoder in helper processes: who waits for which worker, time limits, and one clear error for whatever a worker
// does.
#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <condition_variable>
#include <csignal>
#include <cstring>
#include <mutex>
#include <string>
#include <vector>

#include "image/decode_worker.h"
#include "image/helper_path.h"

namespace burnish {
namespace {

using namespace image;

/// What ended a worker, in words. `status` as waitpid gives it; 0 and -1: it ended without a signal.
Error deathOf(int status, std::string_view name, double seconds) {
  if (status > 0 && WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU)
      return {std::string(name), fmt::format("was not decoded within {:g} s", seconds),
              "make the picture smaller, or export it again if it is damaged"};
    if (signal == SIGKILL)
      return {std::string(name), "decoding was ended from outside (signal 9), perhaps for want of memory",
              "try again, or make the picture smaller"};
    return {std::string(name),
            fmt::format("is damaged: the decoder crashed on it (signal {}, {})", signal, ::strsignal(signal)),
            "export the picture again"};
  }
  return {std::string(name), "is damaged: the decoder ended on it", "export the picture again"};
}

class DecoderPool final : public ImageDecoder {
 public:
  explicit DecoderPool(DecoderPoolOptions options)
      : options_(std::move(options)), slots_(static_cast<std::size_t>(std::max(options_.processes, 1))) {
    if (options_.startNow) startInBackground();
  }
  ~DecoderPool() override {
    for (Slot& slot : slots_) slot.worker.socket.reset();
  }

  [[nodiscard]] int concurrency() const override { return std::max(options_.processes, 1); }

  Result<Image> decode(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits) override {
    auto header = readPictureHeader(file, name);
    if (!header) return fail(header.error());
    if (auto ok = checkPictureLimits(*header, limits, name); !ok) return fail(ok.error());
    const Lease lease(*this);
    // A worker that died while idle is found out by the first message; that is not this picture's fault.
    for (int tries = 0; tries < 2; ++tries) {
      if (auto ok = provideWorker(lease.slot(), name); !ok) return fail(ok.error());
      Conversation answer = decodeWith(lease.slot().worker, file, name, *header, limits);
      if (answer.outcome == Outcome::Answered) return std::move(answer.picture);
      const int status = endWorker(lease.slot().worker);
      if (answer.outcome == Outcome::Unusable) return std::move(answer.picture);
      if (answer.outcome == Outcome::TimedOut) return fail(deathOf(SIGXCPU, name, limits.seconds));
      if (answer.outcome == Outcome::Died) return fail(deathOf(status, name, limits.seconds));
    }
    return fail(std::string(name), "the decode helper ends as soon as it starts", "check the burnish-decode program");
  }

 private:
  struct Slot {
    Worker worker;
    bool busy = false;
  };

  /// A slot for the length of one call; waits for one. Prefers those whose worker runs already.
  class Lease {
   public:
    explicit Lease(DecoderPool& pool) : pool_(pool) {
      std::unique_lock lock(pool.mutex_);
      pool.freed_.wait(lock, [&] { return (slot_ = pool.idleSlot()) != nullptr; });
      slot_->busy = true;
    }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    ~Lease() {
      const std::scoped_lock lock(pool_.mutex_);
      slot_->busy = false;
      pool_.freed_.notify_one();
    }
    [[nodiscard]] Slot& slot() const { return *slot_; }

   private:
    DecoderPool& pool_;
    Slot* slot_ = nullptr;
  };

  Slot* idleSlot() {
    Slot* found = nullptr;
    for (Slot& slot : slots_)
      if (!slot.busy && (!found || slot.worker.alive())) found = &slot;
    return found;
  }

  void startInBackground() {
    if (auto helper = findDecodeHelper(options_.helper))
      (void)keeper_.start(*helper);  // a failure shows again, and is told, at decode
  }

  Result<void> provideWorker(Slot& slot, std::string_view name) {
    if (slot.worker.alive()) return {};
    const std::scoped_lock lock(keeperMutex_);
    auto helper = findDecodeHelper(options_.helper);
    auto worker = helper ? keeper_.fork(*helper, options_.memoryBytes) : fail(helper.error());
    if (!worker) {
      const Error& e = worker.error();
      return fail(std::string(name), "cannot be decoded: " + e.place + ": " + e.what, e.remedy);
    }
    slot.worker = std::move(*worker);
    return {};
  }

  int endWorker(Worker& worker) {
    const std::scoped_lock lock(keeperMutex_);
    return keeper_.end(worker);
  }

  const DecoderPoolOptions options_;
  std::mutex mutex_;  ///< guards Slot::busy; a slot's worker belongs to whoever holds the slot
  std::condition_variable freed_;
  std::vector<Slot> slots_;
  std::mutex keeperMutex_;
  DecodeKeeper keeper_;
};

}  // namespace

std::unique_ptr<ImageDecoder> makeDecoderPool(DecoderPoolOptions options) {
  return std::make_unique<DecoderPool>(std::move(options));
}

}  // namespace burnish
