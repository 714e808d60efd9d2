#include "probe/folder.h"

#include <fmt/format.h>

#include <set>

#include "core/file.h"
#include "image/cube_file.h"
#include "probe/payload.h"
#include "probe/work.h"

namespace burnish::probe {
namespace {

namespace fs = std::filesystem;

bool isOurs(std::string_view name) { return isPayloadName(name) && (name.starts_with("reflection_") || name.starts_with("grid_")); }
/// Of a writer that was killed: whoever asks is the only one now.
bool isLeftover(std::string_view name) { return name.starts_with(".burnish-") && name.ends_with(".tmp"); }

bool sameFile(const fs::path& file, const FileEntry& entry) {
  const auto bytes = core::readFile(file, entry.bytes);
  return bytes && bytes->size() == entry.bytes && core::hashOf(*bytes) == entry.hash;
}

/// Puts payloads beside a manifest that does not name them yet; what it wrote goes again unless keep() is called.
class Payloads {
 public:
  explicit Payloads(fs::path folder) : folder_(std::move(folder)) {}
  Payloads(const Payloads&) = delete;
  Payloads& operator=(const Payloads&) = delete;
  ~Payloads() {
    std::error_code ignored;
    for (const std::string& name : fresh_) fs::remove(folder_ / name, ignored);
  }
  Result<FileEntry> put(const std::string& stem, std::span<const std::byte> bytes) {
    FileEntry entry{"", bytes.size(), core::hashOf(bytes)};
    entry.name = fmt::format("{}.{}.ktx2", stem, entry.hash.hex().substr(0, 16));
    std::error_code ignored;
    const bool there = fs::exists(fs::symlink_status(folder_ / entry.name, ignored));
    if (!there || !sameFile(folder_ / entry.name, entry)) {
      if (!there) fresh_.push_back(entry.name);
      if (auto ok = core::writeFileAtomic(folder_ / entry.name, bytes); !ok) return fail(ok.error());
    }
    kept_.insert(entry.name);
    return entry;
  }
  /// The manifest is in place: what it does not name goes.
  void keep() {
    fresh_.clear();
    std::error_code error;
    std::vector<fs::path> stale;
    for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error)) {
      const std::string name = it->path().filename().string();
      if (isLeftover(name) || (isOurs(name) && !kept_.contains(name))) stale.push_back(it->path());
    }
    for (const fs::path& file : stale) fs::remove(file, error);
  }

 private:
  fs::path folder_;
  std::vector<std::string> fresh_;
  std::set<std::string> kept_;
};

Result<void> putReflections(Payloads& payloads, const ProbeSet& set, Manifest& manifest) {
  for (std::size_t i = 0; i < set.reflections.size(); ++i) {
    const ReflectionProbe& p = set.reflections[i];
    Manifest::Reflection r;
    r.probe = {p.name, p.center, p.axes, p.halfSize, p.capture, p.fade, p.margin, {}, p.irradiance};
    if (!p.radiance.levels.empty()) {
      const EncodedRadiance encoded = encodeRadiance(p.radiance);
      auto file = payloads.put(fmt::format("reflection_{:04}", i), encoded.bytes);
      if (!file) return fail(file.error());
      r.file = std::move(*file);
      r.size = p.radiance.levels[0].size, r.levels = int(p.radiance.levels.size()), r.scale = encoded.scale;
      manifest.lobe = p.radiance.lobe;
    }
    manifest.reflections.push_back(std::move(r));
  }
  return {};
}

Result<void> putGrid(Payloads& payloads, const AmbientGrid& grid, Manifest& manifest) {
  Manifest::Grid& g = manifest.grid.emplace();
  g.grid = {grid.name, grid.origin, grid.axes, grid.spacing, grid.counts, grid.margin, {}};
  for (const AmbientGrid::Point& p : grid.points) g.grid.points.push_back({p.valid, {}, {}});
  if (grid.points.empty()) return {};
  auto irradiance = payloads.put("grid_irradiance", encodeIrradiance(grid));
  if (!irradiance) return fail(irradiance.error());
  g.irradiance = std::move(*irradiance);
  bool any = false;
  for (const AmbientGrid::Point& p : grid.points) any = any || !p.distances.empty();
  if (!any) return {};
  auto distances = payloads.put("grid_distances", encodeDistances(grid));
  if (!distances) return fail(distances.error());
  g.distances = std::move(*distances);
  return {};
}

Result<void> putAll(const fs::path& folder, const ProbeSet& set, const BakeNotes* notes) {
  Payloads payloads(folder);
  Manifest manifest;
  manifest.writer = image::writerName();
  if (auto ok = putReflections(payloads, set, manifest); !ok) return ok;
  if (set.grid)
    if (auto ok = putGrid(payloads, *set.grid, manifest); !ok) return ok;
  if (notes) manifest.bake = *notes;
  const std::string text = manifestText(manifest);
  if (text.size() > kMostManifestBytes) return fail(folder.string(), fmt::format("the manifest would be {} bytes long, at most {} are read", text.size(), kMostManifestBytes), "store fewer probes in a folder");
  if (auto ok = core::writeFileAtomic(folder / kManifestName, std::as_bytes(std::span(text))); !ok) return ok;
  payloads.keep();
  return {};
}

}  // namespace

Result<bool> ensureFolder(const fs::path& folder) {
  std::error_code error;
  const fs::path named = folder.has_filename() ? folder : folder.parent_path();  // "out/" is "out"
  if (named.empty() || folder.native().find('\0') != std::string::npos) return fail(folder.string(), "is no folder name", "name a folder");
  const fs::file_status status = fs::status(named, error);
  if (status.type() == fs::file_type::not_found) {
    if (fs::create_directory(named, error)) return true;
    return fail(folder.string(), fmt::format("cannot be made ({})", error.message()), error == std::errc::no_such_file_or_directory ? "create the folder around it first" : "choose another folder");
  }
  if (!fs::is_directory(status)) return fail(folder.string(), error ? fmt::format("cannot be looked at ({})", error.message()) : "is no folder", "name a new folder");
  if (fs::exists(named / kManifestName, error) || fs::exists(named / kWorkName / kLockName, error)) return false;
  // What was killed in its first moment left nothing but the beginnings of a set.
  bool foreign = false;
  fs::directory_iterator it(named, error);
  for (const fs::directory_iterator end; !error && it != end && !foreign; it.increment(error)) {
    const std::string name = it->path().filename().string();
    foreign = !isOurs(name) && !isLeftover(name) && name != kWorkName;
  }
  if (error) return fail(folder.string(), fmt::format("cannot be listed ({})", error.message()), "check the permissions");
  if (foreign) return fail(folder.string(), "holds other things than probes", "name a new or an empty folder");
  return false;
}

Result<void> writeSet(const fs::path& folder, const ProbeSet& set, const BakeNotes* notes) {
  if (auto ok = checkSet(set, folder.string()); !ok) return ok;
  try {
    return putAll(folder, set, notes);
  } catch (const std::bad_alloc&) {
    return fail(folder.string(), "there is not enough memory to write it", "store fewer or smaller probes");
  }
}

}  // namespace burnish::probe

namespace burnish {

Result<void> writeProbes(const std::filesystem::path& folder, const ProbeSet& probes, Report&) {
  const auto made = probe::ensureFolder(folder);
  if (!made) return fail(made.error());
  auto lock = probe::lockIfWork(folder);
  if (!lock) return fail(lock.error());
  auto written = probe::writeSet(folder, probes, nullptr);
  std::error_code ignored;
  if (!written && *made) std::filesystem::remove(folder.has_filename() ? folder : folder.parent_path(), ignored);  // stays if anything is in it
  return written;
}

}  // namespace burnish
