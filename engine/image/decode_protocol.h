// What the decoder pool and its helper program `burnish-decode` say to each other.
//
// The helper is started once and loads the decoding library (some 160 ms of CPU); this process is the *keeper*. It never looks
// at a picture. On the pool's order it forks *workers*, which start in a millisecond with the library loaded and do the
// decoding; a worker that crashes or hangs is ended and another one forked.
//
//   program --- kKeeperSocket (SOCK_SEQPACKET) --- keeper      KeeperOrder -> KeeperAnswer (first of all a Ready answer)
//   program --- a SOCK_SEQPACKET pair a worker --- worker      DecodeRequest -> DecodeAnswer
//   program === a memfd a worker ================= worker      file bytes at 0, pixels at DecodeRequest::pixelOffset
//
// Pixels go through shared memory: the worker decodes straight into it and the program copies them out once (a 4096 x 2048
// float HDR is 100 MB; a pipe would copy it twice more). The program sizes the memfd and seals it against shrinking, so no
// worker can pull pages from under it. A socket keeps message boundaries; every message is one of these structs, whole.
// Both ends are the same build on the same machine, so byte order and layout are those of the compiler.
#pragma once
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
  std::uint64_t memoryBytes = 0;                ///< Fork: address space beyond what the keeper has
};

struct KeeperAnswer {
  std::uint32_t magic = kDecodeMagic;
  KeeperCommand command = KeeperCommand::Ready;  ///< which command this answers
  std::int32_t pid = 0;                          ///< Fork: the worker, or -1
  std::int32_t status = 0;                       ///< Ready: kDecodeLayout. End: as waitpid gives it. Fork that failed: errno
};

struct DecodeRequest {
  std::uint32_t magic = kDecodeMagic;
  std::int32_t maxSide = 0;
  std::uint64_t fileBytes = 0;      ///< at offset 0 of the memfd
  std::uint64_t pixelOffset = 0;    ///< a multiple of the page size
  std::uint64_t pixelCapacity = 0;  ///< bytes there
  std::uint64_t maxBytes = 0;       ///< DecodeLimits::maxBytes
  double seconds = 0;               ///< CPU time for this picture
};

struct DecodeAnswer {
  std::uint32_t magic = kDecodeMagic;
  std::uint32_t ok = 0;
  std::int32_t width = 0, height = 0, channels = 0;
  std::uint32_t type = 0;  ///< PixelType
  char what[232] = {};    ///< Error::what and Error::remedy, when not ok; each ends in a zero
  char remedy[128] = {};
};

/// Tells a helper of another build apart, which would misread every message.
inline constexpr std::int32_t kDecodeLayout = sizeof(DecodeRequest) << 16 | sizeof(DecodeAnswer) << 4 | 1;

}  // namespace burnish::image
