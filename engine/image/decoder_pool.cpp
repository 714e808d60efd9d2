// ImageDecoder in helper processes: who waits for which worker, time limits, and one clear error for whatever a worker does.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <cstring>
#include <mutex>
#include <string>
#include <vector>

#include "image/decode_keeper.h"
#include "image/helper_path.h"
#include "image/picture_header.h"

namespace burnish {
namespace {

using namespace image;

constexpr std::uint64_t kPage = 65536;                     // a multiple of every page size in use
constexpr std::uint64_t kKeptMemory = 32ull * 1024 * 1024;  // stays with an idle worker: touched pages cost less than new ones

std::uint64_t roundUp(std::uint64_t bytes) { return (bytes + kPage - 1) / kPage * kPage; }

/// Shared memory, mapped for as long as it takes to copy pixels out of it.
class Mapping {
 public:
  Mapping(int fd, std::uint64_t offset, std::size_t bytes)
      : bytes_(bytes), at_(::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, fd, static_cast<off_t>(offset))) {}
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  ~Mapping() {
    if (at_ != MAP_FAILED) ::munmap(at_, bytes_);
  }
  [[nodiscard]] const std::byte* data() const { return at_ == MAP_FAILED ? nullptr : static_cast<const std::byte*>(at_); }

 private:
  std::size_t bytes_;
  void* at_;
};

/// Makes room for the file and its pixels, and stores the file. False: errno tells.
bool fillMemory(int fd, std::span<const std::byte> file, std::uint64_t totalBytes) {
  struct stat status {};
  if (::fstat(fd, &status) != 0) return false;
  if (static_cast<std::uint64_t>(status.st_size) < totalBytes && ::ftruncate(fd, static_cast<off_t>(totalBytes)) != 0) return false;
  std::size_t done = 0;
  while (done < file.size()) {
    const ssize_t n = ::pwrite(fd, file.data() + done, std::min<std::size_t>(file.size() - done, 1u << 30), static_cast<off_t>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

/// What ended a worker, in words. `status` as waitpid gives it; 0 and -1: it ended without a signal.
Error deathOf(int status, std::string_view name, double seconds) {
  if (status > 0 && WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU)
      return {std::string(name), fmt::format("was not decoded within {:g} s", seconds), "make the picture smaller, or export it again if it is damaged"};
    if (signal == SIGKILL)
      return {std::string(name), "decoding was ended from outside (signal 9), perhaps for want of memory", "try again, or make the picture smaller"};
    return {std::string(name), fmt::format("is damaged: the decoder crashed on it (signal {}, {})", signal, ::strsignal(signal)),
            "export the picture again"};
  }
  return {std::string(name), "is damaged: the decoder ended on it", "export the picture again"};
}

class DecoderPool final : public ImageDecoder {
 public:
  explicit DecoderPool(DecoderPoolOptions options) : options_(std::move(options)), slots_(static_cast<std::size_t>(std::max(options_.processes, 1))) {
    if (options_.startNow) startInBackground();
  }
  ~DecoderPool() override {
    for (Slot& slot : slots_) slot.worker.socket.reset();
  }

  Result<Image> decode(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits) override {
    auto header = readPictureHeader(file, name);
    if (!header) return fail(header.error());
    if (auto ok = checkPictureLimits(*header, limits, name); !ok) return fail(ok.error());
    const Lease lease(*this);
    // A worker that died while idle is found out by the first message; that is not this picture's fault.
    for (int tries = 0; tries < 2; ++tries) {
      if (auto ok = provideWorker(lease.slot(), name); !ok) return fail(ok.error());
      bool unsent = false;
      auto picture = decodeWith(lease.slot().worker, file, name, *header, limits, unsent);
      if (!unsent) return picture;
      endWorker(lease.slot().worker);
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
    if (auto helper = findDecodeHelper(options_.helper)) (void)keeper_.start(*helper);  // a failure shows again, and is told, at decode
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

  Result<Image> decodeWith(Worker& worker, std::span<const std::byte> file, std::string_view name, const PictureHeader& header,
                           const DecodeLimits& limits, bool& unsent) {
    DecodeRequest request;
    request.maxSide = limits.maxSide;
    request.fileBytes = file.size();
    request.pixelOffset = roundUp(file.size());
    request.pixelCapacity = roundUp(header.decodedBytes());
    request.maxBytes = limits.maxBytes;
    request.seconds = limits.seconds;
    if (!fillMemory(worker.memory.get(), file, request.pixelOffset + request.pixelCapacity))
      return fail(std::string(name), fmt::format("no shared memory to decode it ({})", std::strerror(errno)), "free some memory");
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                                                 std::chrono::duration<double>(std::clamp(limits.seconds, 0.0, 1e6)));
    if (!sendMessage(worker.socket.get(), &request, sizeof request)) {
      unsent = true;
      return fail(std::string(name), "the decode helper is gone");
    }
    DecodeAnswer answer;
    const Receipt receipt = receiveMessage(worker.socket.get(), &answer, sizeof answer, deadline);
    if (receipt == Receipt::TimedOut) {
      endWorker(worker);
      return fail(deathOf(SIGXCPU, name, limits.seconds));
    }
    if (receipt == Receipt::Closed) return fail(deathOf(endWorker(worker), name, limits.seconds));
    auto picture = takePicture(worker, request, answer, name, limits);
    trimMemory(worker);
    return picture;
  }

  /// Copies the pixels out. The answer is believed no more than the file was: sizes are checked against what was asked for.
  Result<Image> takePicture(Worker& worker, const DecodeRequest& request, DecodeAnswer& answer, std::string_view name, const DecodeLimits& limits) {
    answer.what[sizeof answer.what - 1] = answer.remedy[sizeof answer.remedy - 1] = 0;
    if (!answer.ok) return fail(std::string(name), answer.what, answer.remedy);
    const bool sane = answer.width > 0 && answer.width <= limits.maxSide && answer.height > 0 && answer.height <= limits.maxSide &&
                      answer.channels >= 1 && answer.channels <= 4 && answer.type <= static_cast<std::uint32_t>(PixelType::F32);
    Image picture{answer.width, answer.height, answer.channels, static_cast<PixelType>(answer.type), {}};
    if (!sane || picture.byteSize() > request.pixelCapacity) {
      endWorker(worker);
      return fail(std::string(name), "is damaged: the decoder's answer makes no sense", "export the picture again");
    }
    const Mapping pixels(worker.memory.get(), request.pixelOffset, picture.byteSize());
    if (!pixels.data()) return fail(std::string(name), "no memory to take its pixels over", "free some memory");
    try {
      picture.data.assign(pixels.data(), pixels.data() + picture.byteSize());
    } catch (const std::exception&) {
      return fail(std::string(name), fmt::format("no memory for its {} bytes", picture.byteSize()), "free some memory");
    }
    return picture;
  }

  /// The file cannot shrink (it is sealed), but its pages can go.
  static void trimMemory(Worker& worker) {
    struct stat status {};
    if (!worker.memory || ::fstat(worker.memory.get(), &status) != 0) return;
    const auto used = static_cast<std::uint64_t>(status.st_blocks) * 512;
    if (used > kKeptMemory)
      (void)::fallocate(worker.memory.get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(kKeptMemory),
                        std::max<off_t>(status.st_size - static_cast<off_t>(kKeptMemory), 1));
  }

  const DecoderPoolOptions options_;
  std::mutex mutex_;  ///< guards Slot::busy; a slot's worker belongs to whoever holds the slot
  std::condition_variable freed_;
  std::vector<Slot> slots_;
  std::mutex keeperMutex_;
  DecodeKeeper keeper_;
};

}  // namespace

std::unique_ptr<ImageDecoder> makeDecoderPool(DecoderPoolOptions options) { return std::make_unique<DecoderPool>(std::move(options)); }

}  // namespace burnish
