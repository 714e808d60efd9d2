// JSON text to a document, for text that nobody vouches for: depth and number of values are counted before anything is
// built.
#pragma once
#include <burnish/result.h>

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>

namespace burnish::asset {

using Json = nlohmann::json;

struct JsonLimits {
  int depth = 64;                           ///< nested arrays and objects
  std::uint64_t values = 16 * 1024 * 1024;  ///< the document takes up to some 100 bytes for each
};

/// Parses UTF-8 JSON text (a byte order mark is skipped). `place` is the file, for errors; faults inside a value (a
/// number that overflows, a name given twice) carry the JSON path, faults of syntax the line and column. Neither the
/// parser nor this code recurses, whatever the text holds.
Result<Json> parseJson(std::span<const std::byte> text, const std::string& place, const JsonLimits& limits = {});

/// Appends "/key" to a JSON pointer, escaped as RFC 6901 asks ('~' is "~0", '/' is "~1"). Long keys are cut, control
/// characters shown as '?'.
void appendPointer(std::string& pointer, std::string_view key);

}  // namespace burnish::asset
