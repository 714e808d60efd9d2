// Results of captures between bounces and between bakes: files in work/light, named by the keys of what they hold, each with a hash of its own (docs/probe_files.md, "work/").
#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "core/hash.h"
#include "probe/bounce.h"

namespace burnish::probe {

/// Capture points that share a file: one reflection probe, or up to kRun grid points in a row.
struct Unit {
  int first = 0, count = 1;
  bool reflection = true;
};
inline constexpr int kRun = 16;
std::vector<Unit> unitsOf(const ProbeSet& places);
/// Of a unit's points' keys: the name of its file.
std::string unitName(const Unit& unit, std::span<const core::Hash128> keys);

/// A point's light with its radiance as the file holds it.
struct StoredLight {
  IrradianceSh irradiance{};
  std::vector<std::byte> radiance;  ///< KTX2; empty: a grid point
  core::Hash128 content;            ///< contentOf()
};
StoredLight storedLight(const IrradianceSh& irradiance, std::vector<std::byte> radiance);

class LightStore {
 public:
  explicit LightStore(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// Makes the folder if it is missing.
  Result<void> make() const;
  /// Remembers the grid points of all files that are there, whatever run they are in. Damaged files are warnings, and count as missing.
  void index(Report& report);

  /// The light of a reflection probe; none: there is no such file, or it is damaged, which is a warning.
  [[nodiscard]] std::optional<StoredLight> reflection(const core::Hash128& key, Report& report) const;
  /// The light of a grid point that index() or put() knows.
  [[nodiscard]] std::optional<StoredLight> point(const core::Hash128& key) const;
  /// The lights of all points of a unit, from its own file; none: it is missing or damaged.
  [[nodiscard]] std::optional<std::vector<StoredLight>> unit(const Unit& unit, std::span<const core::Hash128> keys, Report& report) const;
  /// `keys` of the whole bounce; complete or absent. A file that is there and whole is left.
  Result<void> put(const Unit& unit, std::span<const core::Hash128> keys, std::span<const StoredLight> lights);

  /// Takes away all that is not named, and what killed bakes left.
  void keepOnly(const std::set<std::string>& names) const;
  /// Names of files whose own hash is not that of their bytes.
  [[nodiscard]] std::vector<std::string> damaged() const;

 private:
  std::filesystem::path folder_;
  std::map<core::Hash128, IrradianceSh> points_;
};

}  // namespace burnish::probe
