#include "gl/program_binary.h"

#include <fmt/format.h>

#include <cstring>

#include "core/file.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace burnish::gl {
namespace {

constexpr std::uint64_t kMaxFileBytes = 64ull << 20;

/// Head of a file, then the driver's bytes. Native byte order: the key binds a file to one driver, so it never travels
/// between machines.
struct Header {
  char magic[8] = {'B', 'R', 'N', 'P', 'R', 'O', 'G', '1'};
  BinaryKey key{};
  std::uint64_t size = 0;
  std::uint64_t hash = 0;  // of format and bytes: a driver may crash on a damaged binary, so none reaches it
  std::uint32_t format = 0, zero = 0;
};
static_assert(sizeof(Header) == 48);

std::uint64_t contentHash(std::uint32_t format, std::span<const std::byte> bytes) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), format);
}

std::filesystem::path fileOf(const std::filesystem::path& folder, const BinaryKey& key) {
  return folder / fmt::format("{:016x}{:016x}.bin", key[0], key[1]);
}

}  // namespace

struct BinaryKeyBuilder::State {
  XXH3_state_t xxh;
};

BinaryKeyBuilder::BinaryKeyBuilder(const Capabilities& caps) : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->xxh);
  addPart(caps.vendor);
  addPart(caps.renderer);
  addPart(caps.version);
}
BinaryKeyBuilder::~BinaryKeyBuilder() = default;

void BinaryKeyBuilder::addPart(std::string_view part) {
  const std::uint64_t size = part.size();  // so that "ab" + "c" differs from "a" + "bc"
  XXH3_128bits_update(&state_->xxh, &size, sizeof size);
  XXH3_128bits_update(&state_->xxh, part.data(), part.size());
}

void BinaryKeyBuilder::add(GLenum stage, std::string_view text) {
  XXH3_128bits_update(&state_->xxh, &stage, sizeof stage);
  addPart(text);
}

BinaryKey BinaryKeyBuilder::finish() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(&state_->xxh);
  return {hash.high64, hash.low64};
}

std::optional<ProgramBinary> readBinary(const std::filesystem::path& folder, const BinaryKey& key) {
  const auto file = core::readFile(fileOf(folder, key), kMaxFileBytes);
  if (!file || file->size() < sizeof(Header)) return {};
  const Header expected;
  Header header;
  std::memcpy(&header, file->data(), sizeof header);
  const std::span<const std::byte> bytes = std::span(*file).subspan(sizeof header);
  const bool whole = std::memcmp(header.magic, expected.magic, sizeof header.magic) == 0 && header.key == key &&
                     header.size == bytes.size() && header.hash == contentHash(header.format, bytes);
  if (!whole) return {};
  return ProgramBinary{header.format, {bytes.begin(), bytes.end()}};
}

void writeBinary(const std::filesystem::path& folder, const BinaryKey& key, const ProgramBinary& binary) {
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  Header header;
  header.key = key;
  header.size = binary.bytes.size();
  header.format = binary.format;
  header.hash = contentHash(binary.format, binary.bytes);
  std::vector<std::byte> file(sizeof header + binary.bytes.size());
  std::memcpy(file.data(), &header, sizeof header);
  std::memcpy(file.data() + sizeof header, binary.bytes.data(), binary.bytes.size());
  (void)core::writeFileAtomic(fileOf(folder, key), file);
}

}  // namespace burnish::gl
