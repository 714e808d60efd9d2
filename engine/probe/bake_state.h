// What a bake's work folder says of the bake: what is baked, which bounces are joined, which parts of the next one are there. Each document ends in its own hash.
#pragma once
#include <optional>

#include "probe/manifest.h"

namespace burnish::probe {

/// work/bake.json
struct BakeState {
  core::Hash128 id;  ///< of all that the bake's bytes depend on
  Json options = Json::object();
  BakeOptions stop;  ///< bounces, until, maxBounces alone
};
/// work/bounce_0001.json
struct BounceRecord {
  BounceReport report;               ///< without captured and reused
  std::vector<core::Hash128> keys;   ///< of all capture points
};
/// work/part_0001_1of4.json
struct PartRecord {
  int bounce = 0, shard = 0, shards = 1;
  int captured = 0, reused = 0;
  std::vector<core::Hash128> keys;   ///< of all capture points, of which the shard has its share
};

/// The options as the manifest and bake.json have them; `renderer`: what OpenGL calls itself.
Json optionsJson(const BakeOptions& options, const std::string& renderer);

class StateFolder {
 public:
  explicit StateFolder(std::filesystem::path work) : work_(std::move(work)) {}
  /// None: there is no bake. A damaged document is an error.
  [[nodiscard]] Result<std::optional<BakeState>> state() const;
  Result<void> write(const BakeState& state) const;
  [[nodiscard]] Result<std::optional<BounceRecord>> bounce(const core::Hash128& id, int bounce) const;
  Result<void> write(const core::Hash128& id, const BounceRecord& record) const;
  /// All bounces that are joined, in order.
  [[nodiscard]] Result<std::vector<BounceRecord>> bounces(const core::Hash128& id) const;
  /// Parts of a bounce, in order of their shards.
  [[nodiscard]] Result<std::vector<PartRecord>> parts(const core::Hash128& id, int bounce) const;
  Result<void> write(const core::Hash128& id, const PartRecord& record) const;
  /// Takes away all bounces and parts; or the parts of one bounce.
  void forget() const;
  void forgetParts(int bounce) const;

 private:
  std::filesystem::path work_;
};

}  // namespace burnish::probe
