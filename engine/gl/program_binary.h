// Program binaries on disk: one file each, named by a hash of everything that the program is made from.
#pragma once
#include <burnish/context.h>
#include <glad/gl.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

namespace burnish::gl {

/// XXH3-128 of driver vendor, renderer, version and the full text of every stage.
using BinaryKey = std::array<std::uint64_t, 2>;
class BinaryKeyBuilder {
 public:
  explicit BinaryKeyBuilder(const Capabilities& caps);
  ~BinaryKeyBuilder();
  BinaryKeyBuilder(const BinaryKeyBuilder&) = delete;
  BinaryKeyBuilder& operator=(const BinaryKeyBuilder&) = delete;
  void add(GLenum stage, std::string_view text);
  [[nodiscard]] BinaryKey finish() const;

 private:
  void addPart(std::string_view part);
  struct State;
  std::unique_ptr<State> state_;
};

struct ProgramBinary {
  GLenum format = 0;
  std::vector<std::byte> bytes;
};
/// Nothing where the file is missing, was written for another key, or is damaged in any way (its own hash decides).
std::optional<ProgramBinary> readBinary(const std::filesystem::path& folder, const BinaryKey& key);
/// Makes the folder when it is missing; complete or not at all. A failure costs the next start a compilation and is not
/// reported.
void writeBinary(const std::filesystem::path& folder, const BinaryKey& key, const ProgramBinary& binary);

}  // namespace burnish::gl
