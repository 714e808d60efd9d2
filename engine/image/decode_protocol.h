// What the decoder pool and its helper program `burnish-decode` say to each other.
//
// The helper is started once and loads the decoding library (some 160 ms of CPU); this process is the *keeper*. It
// never looks at a picture. On the pool's order it forks *workers*, which start in a millisecond with the library
// loaded and do the decoding; a worker that crashes or hangs is ended and another one forked.
//
//   program --- kKeeperSocket (SOCK_SEQPACKET) --- keeper      KeeperOrder -> KeeperAnswer (first of all a Ready
//   answer) program --- a SOCK_SEQPACKET pair a worker --- worker      DecodeRequest -> DecodeAnswer program === a
//   memfd a worker ================= worker      kWindows windows for pixels, then the file's bytes
//
// Pixels pass through windows of shared memory: the worker decodes rows straight into one while the program copies the
// other out, so that these pages stay in the caches and no more memory is touched than the picture takes (measured with
// a 4096 x 2048 float HDR of 100 MB: docs/decisions). The program sizes the memfd and seals it against shrinking, so no
// worker can pull pages from under it. A socket keeps message boundaries; every message is one of these structs, whole.
//
//   DecodeRequest ->  <- Header  <- Pixels (window 0)  <- Pixels (window 1)  WindowFree ->  <- Pixels (window 0)  ...
//   or  <- Failed
#pragma once
#include <cstddef>
#include <cstdint>

namespace burnish::image {

inline constexpr std::uint32_t kDecodeMagic = 0x44504231;  ///< "1BPD"; change it with any struct below
inline constexpr int kKeeperSocket = 0;                    ///< descriptor number in the helper (its standard input)

enum class KeeperCommand : std::uint32_t { Ready, Fork, End };

struct KeeperOrder {
  std::uint32_t magic = kDecodeMagic;
  KeeperCommand command = KeeperCommand::Fork;  ///< Fork comes with two descriptors: the worker's socket and its memfd
  std::int32_t pid = 0;                         ///< End: which worker
  std::uint32_t reserved = 0;
  std::uint64_t memoryBytes = 0;  ///< Fork: address space beyond what the keeper has
};

struct KeeperAnswer {
  std::uint32_t magic = kDecodeMagic;
  KeeperCommand command = KeeperCommand::Ready;  ///< which command this answers
  std::int32_t pid = 0;                          ///< Fork: the worker, or -1
  std::int32_t status = 0;  ///< Ready: kDecodeLayout. End: as waitpid gives it. Fork that failed: errno
};

inline constexpr std::size_t kWindows = 2;
inline constexpr std::size_t kWindowBytes = 1024 * 1024;             ///< a multiple of every page size in use
inline constexpr std::size_t kFileOffset = kWindows * kWindowBytes;  ///< of the file's bytes in the memfd

struct DecodeRequest {
  std::uint32_t magic = kDecodeMagic;
  std::int32_t maxSide = 0;     ///< DecodeLimits
  std::uint64_t maxBytes = 0;   ///< DecodeLimits
  double seconds = 0;           ///< CPU time for this picture
  std::uint64_t fileBytes = 0;  ///< at kFileOffset
};

enum class AnswerKind : std::uint32_t { Failed, Header, Pixels };

struct DecodeAnswer {
  std::uint32_t magic = kDecodeMagic;
  AnswerKind kind = AnswerKind::Failed;
  std::int32_t width = 0, height = 0, channels = 0;  ///< Header
  std::uint32_t type = 0;                            ///< Header: PixelType
  std::uint64_t bytes = 0;  ///< Pixels: how many, from the start of the window whose turn it is
  char what[232] = {};      ///< Failed: Error::what and Error::remedy; each ends in a zero
  char remedy[128] = {};
};

/// Each allows the worker one more message of Pixels, beyond the first kWindows.
struct WindowFree {
  std::uint32_t magic = kDecodeMagic;
};

/// Tells a helper of another build apart, which would misread every message.
inline constexpr std::int32_t kDecodeLayout = sizeof(DecodeRequest) << 16 | sizeof(DecodeAnswer) << 4 | 1;

}  // namespace burnish::image
