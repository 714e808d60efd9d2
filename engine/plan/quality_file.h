// Quality files: text that people edit and that nobody vouches for.
#pragma once
#include <burnish/quality.h>

#include <cstddef>
#include <span>
#include <string>

namespace burnish::plan {

inline constexpr int kQualityVersion = 1;
inline constexpr std::uint64_t kMostQualityBytes = 256 * 1024;

/// A number of Quality, by its name in files. `least`, `most`: what the renderer takes.
struct QualityNumber {
  std::string_view name;
  int Quality::* whole = nullptr;    ///< one of the two
  float Quality::* number = nullptr;
  double least = 0, most = 0;
  [[nodiscard]] double of(const Quality& quality) const { return whole ? double(quality.*whole) : double(quality.*number); }
};
std::span<const QualityNumber> qualityNumbers();

/// The file's text; `place` is the file, for errors. Fails where a number is out of its range.
Result<std::string> qualityText(const Quality& quality, std::string_view comment, const std::string& place);
/// What a file's text says.
Result<Quality> parseQuality(std::span<const std::byte> text, const std::string& place);

}  // namespace burnish::plan
