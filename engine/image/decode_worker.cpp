#include "image/decode_worker.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

namespace burnish::image {
namespace {

/// Of the file's copy, this much stays with an idle worker: pages that exist cost less than new ones.
constexpr off_t kKeptBytes = 32 * 1024 * 1024;

/// Stores the file behind the windows. False: errno tells.
bool storeFile(int memory, std::span<const std::byte> file) {
  std::size_t done = 0;
  while (done < file.size()) {
    const std::size_t part = std::min<std::size_t>(file.size() - done, 1u << 30);
    const ssize_t n = ::pwrite(memory, file.data() + done, part, static_cast<off_t>(kFileOffset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

/// The memory cannot shrink (it is sealed), but its pages can go.
void trimMemory(int memory) {
  struct stat status {};
  if (::fstat(memory, &status) == 0 && status.st_blocks * 512 > kKeptBytes)
    (void)::fallocate(memory, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, kKeptBytes,
                      std::max<off_t>(status.st_size - kKeptBytes, 1));
}

Deadline after(double seconds) {
  const std::chrono::duration<double> time(std::clamp(seconds, 0.0, 1e6));
  return std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(time);
}

tl::unexpected<Error> noMemory(std::string_view name, std::uint64_t bytes) {
  return fail(std::string(name), fmt::format("no memory for its {} bytes", bytes),
              "free some memory, or make the picture smaller");
}

/// Reads a worker's answers to one request.
class Reader {
 public:
  Reader(Worker& worker, std::string_view name, Deadline deadline)
      : worker_(worker), name_(name), deadline_(deadline) {}

  Conversation read(const PictureHeader& header, const DecodeLimits& limits) {
    if (auto stopped = next()) return std::move(*stopped);
    Image picture{answer_.width, answer_.height, answer_.channels, static_cast<PixelType>(answer_.type), {}};
    const bool sane = answer_.kind == AnswerKind::Header && picture.width == header.width &&
                      picture.height == header.height && picture.channels >= 1 && picture.channels <= 4 &&
                      picture.type == header.type;
    if (!sane || picture.byteSize() > std::min(header.decodedBytes(), limits.maxBytes)) return senseless();
    try {
      picture.data.reserve(picture.byteSize());
    } catch (const std::exception&) {
      return {Outcome::Unusable, noMemory(name_, picture.byteSize())};
    }
    return readPixels(std::move(picture));
  }

 private:
  Conversation readPixels(Image picture) {
    const std::size_t total = picture.byteSize();
    for (std::size_t turn = 0; picture.data.size() < total; turn = (turn + 1) % kWindows) {
      if (auto stopped = next()) return std::move(*stopped);
      if (answer_.kind != AnswerKind::Pixels || answer_.bytes == 0 ||
          answer_.bytes > std::min(kWindowBytes, total - picture.data.size()))
        return senseless();
      const std::byte* window = worker_.windows.window(turn);
      picture.data.insert(picture.data.end(), window, window + answer_.bytes);
      const WindowFree message;
      if (!sendMessage(worker_.socket.get(), &message, sizeof message)) return {Outcome::Died, fail("", "")};
    }
    return {Outcome::Answered, std::move(picture)};
  }

  /// Receives the next answer; gives the conversation's end if that is what came instead.
  std::optional<Conversation> next() {
    const Receipt receipt = receiveMessage(worker_.socket.get(), &answer_, sizeof answer_, deadline_);
    if (receipt == Receipt::TimedOut) return Conversation{Outcome::TimedOut, fail("", "")};
    if (receipt == Receipt::Closed) return Conversation{Outcome::Died, fail("", "")};
    if (answer_.kind != AnswerKind::Failed) return std::nullopt;
    answer_.what[sizeof answer_.what - 1] = answer_.remedy[sizeof answer_.remedy - 1] = 0;
    return Conversation{Outcome::Answered, fail(std::string(name_), answer_.what, answer_.remedy)};
  }
  [[nodiscard]] Conversation senseless() const {
    return {Outcome::Unusable,
            fail(std::string(name_), "is damaged: the decoder's answer makes no sense", "export the picture again")};
  }

  Worker& worker_;
  std::string_view name_;
  Deadline deadline_;
  DecodeAnswer answer_;
};

}  // namespace

Conversation decodeWith(Worker& worker, std::span<const std::byte> file, std::string_view name,
                        const PictureHeader& header, const DecodeLimits& limits) {
  if (!storeFile(worker.memory.get(), file)) return {Outcome::Unusable, noMemory(name, file.size())};
  DecodeRequest request;
  request.maxSide = limits.maxSide;
  request.maxBytes = limits.maxBytes;
  request.seconds = limits.seconds;
  request.fileBytes = file.size();
  const Deadline deadline = after(limits.seconds);
  if (!sendMessage(worker.socket.get(), &request, sizeof request)) return {Outcome::Unsent, fail("", "")};
  Conversation conversation = Reader(worker, name, deadline).read(header, limits);
  trimMemory(worker.memory.get());
  return conversation;
}

}  // namespace burnish::image
