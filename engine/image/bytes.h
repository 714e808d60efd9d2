// Reading files that nobody vouches for, byte by byte, and writing them.
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

namespace burnish::image {

/// A cursor over untrusted bytes: reading past the end sets `bad` and gives zeros.
class Bytes {
 public:
  explicit Bytes(std::span<const std::byte> file) : file_(file) {}
  std::uint32_t u8() { return at_ < file_.size() ? std::to_integer<std::uint32_t>(file_[at_++]) : (bad_ = true, 0u); }
  std::uint32_t be16() {
    const std::uint32_t high = u8();
    return high << 8 | u8();
  }
  std::uint32_t be32() {
    const std::uint32_t high = be16();
    return high << 16 | be16();
  }
  std::uint32_t leU32() {
    std::uint32_t value = 0;
    for (int shift = 0; shift < 32; shift += 8) value |= u8() << shift;
    return value;
  }
  std::uint64_t leU64() {
    const std::uint64_t low = leU32();
    return low | std::uint64_t(leU32()) << 32;
  }
  std::int32_t le32() { return std::bit_cast<std::int32_t>(leU32()); }
  /// The next n bytes, which are consumed; none, and `bad`, if there are fewer.
  std::span<const std::byte> take(std::size_t n) {
    if (n > file_.size() - at_) return at_ = file_.size(), bad_ = true, std::span<const std::byte>{};
    at_ += n;
    return file_.subspan(at_ - n, n);
  }
  void skip(std::size_t n) { n <= file_.size() - at_ ? at_ += n : (at_ = file_.size(), bad_ = true); }
  /// Text up to `end`, which is consumed; at most `longest` bytes.
  std::string_view textUntil(char end, std::size_t longest) {
    const char* begin = reinterpret_cast<const char*>(file_.data()) + at_;
    const std::size_t room = std::min(longest + 1, file_.size() - at_);
    const void* found = room > 0 ? std::memchr(begin, end, room) : nullptr;
    if (!found) return bad_ = true, std::string_view{};
    const auto length = static_cast<std::size_t>(static_cast<const char*>(found) - begin);
    at_ += length + 1;
    return {begin, length};
  }
  [[nodiscard]] bool bad() const { return bad_; }
  [[nodiscard]] std::size_t position() const { return at_; }
  [[nodiscard]] std::size_t left() const { return file_.size() - at_; }

 private:
  std::span<const std::byte> file_;
  std::size_t at_ = 0;
  bool bad_ = false;
};

/// Little-endian numbers and text at the end of a growing file.
class ByteWriter {
 public:
  void u32(std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) bytes_.push_back(static_cast<std::byte>(value >> shift & 0xff));
  }
  void u64(std::uint64_t value) {
    u32(static_cast<std::uint32_t>(value));
    u32(static_cast<std::uint32_t>(value >> 32));
  }
  void bytes(std::span<const std::byte> more) { bytes_.insert(bytes_.end(), more.begin(), more.end()); }
  void text(std::string_view more) { bytes(std::as_bytes(std::span(more.data(), more.size()))); }
  /// Zeros up to a multiple of `alignment`.
  void align(std::size_t alignment) {
    while (bytes_.size() % alignment != 0) bytes_.push_back(std::byte(0));
  }
  void zeros(std::size_t n) { bytes_.resize(bytes_.size() + n); }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace burnish::image
