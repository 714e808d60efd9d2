// What the ways of baking have in common: in one go, in shards, and joining them (docs/probe_files.md, "work/").
#pragma once
#include "probe/bake_state.h"
#include "probe/keys.h"
#include "probe/light_store.h"
#include "probe/work.h"

namespace burnish::probe {

/// The parts of a folder.
struct Paths {
  explicit Paths(const std::filesystem::path& given) : folder(given), work(given / kWorkName), light(work / "light"), places(work / "places") {}
  std::filesystem::path folder, work, light, places;
};

/// A scene made ready: as captures see it, its places without light and with a whole grid, its keys.
struct Prepared {
  Scene scene;
  ProbeSet places;
  Keys keys;
  core::Hash128 id;
  Json options;
};
/// Errors: options out of range, no places, places that cannot be stored.
Result<void> checkBake(const Scene& scene, const BakeOptions& options);
Result<Prepared> prepare(const ProcAddress& getProcAddress, const Scene& scene, const BakeOptions& options, Report& report);

/// Light of all capture points in one bounce.
struct BounceLight {
  std::vector<PointLight> lights;
  std::vector<core::Hash128> contents;
  [[nodiscard]] std::vector<IrradianceSh> irradiances() const;
};
Result<PointLight> decoded(const StoredLight& stored, const std::string& name);
/// Of a bounce that is whole in the store. The error names the file that is not.
Result<BounceLight> loadBounce(const LightStore& store, const Paths& paths, const std::vector<Unit>& units, std::span<const core::Hash128> keys, Report& report);

std::vector<BounceReport> reportsOf(std::span<const BounceRecord> records);
/// After the last bounce: an error where the rest is still over what was asked for. Else the set is written, and the store keeps what these bounces need.
Result<void> finishBake(const Paths& paths, const BakeState& state, const ProbeSet& places, const std::vector<Unit>& units, std::span<const BounceRecord> bounces, std::span<const PointLight> lights);

/// How long the rest takes, from what was measured.
class TimeLeft {
 public:
  /// `alone`: no bounce follows.
  TimeLeft(const BakeOptions& options, bool alone, int reflections, int gridPoints) : options_(options), alone_(alone), reflections_(reflections), gridPoints_(gridPoints) {}
  void captured(bool reflection, double seconds);
  /// Seconds, negative while nothing was measured. `left`: of this bounce.
  [[nodiscard]] double seconds(int leftReflections, int leftGridPoints, int bounce, std::span<const BounceReport> bounces) const;

 private:
  [[nodiscard]] double each(bool reflection) const;
  [[nodiscard]] double bouncesAfter(int bounce, std::span<const BounceReport> bounces) const;

  const BakeOptions& options_;
  bool alone_;
  int reflections_, gridPoints_;
  double sum_[2] = {};
  int count_[2] = {};
};

/// Captures a bounce's points, or takes them from the store.
class Baker {
 public:
  Baker(const ProcAddress& getProcAddress, const Paths& paths, const Prepared& prepared, const BakeOptions& options, const BakeJob& job, LightStore& store, Report& report);
  ~Baker();
  /// The units that job.shard of job.shards has. `before`: the light of the bounce before, nullptr in the first. `now` gets what it captured or found.
  Result<BounceReport> bounce(int bounce, std::span<const core::Hash128> keys, const BounceLight* before, std::span<const BounceReport> log, BounceLight& now);
  [[nodiscard]] const std::vector<Unit>& units() const { return units_; }
  /// What captures had to say.
  void takeWarnings();
  PointTime time;
  double storeMs = 0;

 private:
  Result<Capture*> capture(const BounceLight* before);
  Result<StoredLight> point(int index, bool reflection, const BounceLight* before);
  Result<std::vector<StoredLight>> unit(const Unit& unit, std::span<const core::Hash128> keys, const BounceLight* before, BounceReport& report);

  ProcAddress getProcAddress_;
  const Paths& paths_;
  const Prepared& prepared_;
  const BakeOptions& options_;
  const BakeJob& job_;
  LightStore& store_;
  Report& report_;
  std::vector<Unit> units_;
  TimeLeft left_;
  std::unique_ptr<Capture> capture_;
  bool lit_ = false;  ///< the capture has the light of the bounce before
};

}  // namespace burnish::probe
