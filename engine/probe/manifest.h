// probes.json: what a folder of probes holds (docs/probe_files.md).
#pragma once
#include <burnish/probe.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/hash.h"

namespace burnish::probe {

using Json = nlohmann::ordered_json;

inline constexpr std::string_view kManifestName = "probes.json";
inline constexpr int kSchemaVersion = 1, kFormatVersion = 1;
// What a folder may hold at most. More is an error, on writing as on reading.
inline constexpr std::size_t kMostReflections = 4096, kMostGridPoints = 1 << 18;
inline constexpr int kMostSize = 2048;                                      ///< texels along an edge of a cube
inline constexpr std::uint64_t kMostManifestBytes = 64ull << 20, kMostDecodedBytes = 4ull << 30;

/// A file beside the manifest.
struct FileEntry {
  std::string name;
  std::uint64_t bytes = 0;
  core::Hash128 hash;
};

/// What a bake says of its set.
struct BakeNotes {
  core::Hash128 id;  ///< of all that the bake's bytes depend on
  Json options = Json::object();
  std::vector<BounceReport> bounces;   ///< captured and reused are not kept: they differ between a bake and the same one resumed
  std::vector<core::Hash128> keys;     ///< of the reflection probes' inputs in the last bounce
  std::optional<core::Hash128> gridKey;
};

struct Manifest {
  struct Reflection {
    ReflectionProbe probe;          ///< without levels
    std::optional<FileEntry> file;  ///< none: not baked
    int size = 0, levels = 0;
    double scale = 1;
  };
  struct Grid {
    AmbientGrid grid;  ///< its points have `valid` alone
    std::optional<FileEntry> irradiance, distances;
  };
  std::string writer;
  std::optional<ReflectionLobe> lobe;
  std::vector<Reflection> reflections;
  std::optional<Grid> grid;
  std::optional<BakeNotes> bake;
};

/// The same manifest gives the same bytes.
std::string manifestText(const Manifest& manifest);
/// `place`: the file, for errors, which name the JSON path. Members that are not known are warnings.
Result<Manifest> parseManifest(std::span<const std::byte> text, const std::string& place, Report& report);

/// A bounce as the log has it, without captured and reused; what is not finite is null.
Json bounceJson(const BounceReport& bounce);
/// Objects a member a line, lists of numbers and texts in one line.
std::string jsonText(const Json& document);
/// The last member of every document of ours is the XXH3-128 of all that stands before its line. `text`: what jsonText() made of an object that is not empty.
inline constexpr std::string_view kSealName = "xxh3_128";
std::string sealed(std::string text);
/// Whether the document ends in its own hash.
Result<void> checkSeal(std::span<const std::byte> text, const std::string& place);
/// Whether a name may stand in a manifest: small letters, digits, '_', '-' and '.', not first, ending in .ktx2.
bool isPayloadName(std::string_view name);

/// What the format demands of a set: counts, finite numbers, axes that are unit and orthogonal, sizes of what points hold. `place` is the folder, for errors.
Result<void> checkSet(const ProbeSet& set, const std::string& place);
Result<void> checkProbe(const ReflectionProbe& probe, const std::string& place);
Result<void> checkGrid(const AmbientGrid& grid, const std::string& place);

}  // namespace burnish::probe
