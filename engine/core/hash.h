// XXH3-128: names and checksums of what is stored. Fast, and no defence against someone who wants two files to have one hash.
#pragma once
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace burnish::core {

struct Hash128 {
  std::uint64_t high = 0, low = 0;
  /// 32 hexadecimal digits, as `xxh128sum` prints them.
  [[nodiscard]] std::string hex() const;
  friend auto operator<=>(const Hash128&, const Hash128&) = default;
};
/// Exactly 32 digits in small letters; none: it is no hash.
std::optional<Hash128> parseHash(std::string_view hex);
Hash128 hashOf(std::span<const std::byte> bytes);

/// One hash of many parts. Little-endian machines alone: numbers count as they lie in memory.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  void add(std::span<const std::byte> bytes);
  /// With its length, so that "ab", "c" differs from "a", "bc".
  void text(std::string_view text);
  /// Numbers and enums; -0 counts as 0, so that equal values have equal hashes.
  template <class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void value(T v) {
    if constexpr (std::is_floating_point_v<T>) v = v == 0 ? T(0) : v;
    add(std::as_bytes(std::span(&v, 1)));
  }
  /// Elements without padding (numbers, vectors of floats), with their number.
  template <class T>
    requires std::is_trivially_copyable_v<T>
  void list(std::span<const T> values) {
    value(values.size());
    add(std::as_bytes(values));
  }
  void hash(const Hash128& h) { value(h.high), value(h.low); }
  [[nodiscard]] Hash128 finish() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace burnish::core
