#include "probe/light_store.h"

#include <fmt/format.h>

#include <bit>

#include "core/file.h"
#include "image/bytes.h"
#include "probe/keys.h"

namespace burnish::probe {
namespace {

namespace fs = std::filesystem;
using core::Hash128;

constexpr std::string_view kMagic = "BRNLIGHT", kReflection = ".probe", kPoints = ".points";
constexpr std::uint32_t kVersion = 1;
constexpr std::uint64_t kMostBytes = 1ull << 30;
constexpr std::size_t kHeaderBytes = 32;

/// magic, version, number of points, hash of all that follows; for each point its key and 27 doubles; the radiance of a single one.
struct Record {
  Hash128 key;
  IrradianceSh irradiance{};
};

std::vector<std::byte> encode(std::span<const Record> records, std::span<const std::byte> radiance) {
  image::ByteWriter body;
  for (const Record& r : records) {
    body.u64(r.key.high), body.u64(r.key.low);
    for (const auto& rgb : r.irradiance)
      for (const double v : rgb) body.u64(std::bit_cast<std::uint64_t>(v));
  }
  body.bytes(radiance);
  const std::vector<std::byte> bytes = body.take();
  const Hash128 hash = core::hashOf(bytes);
  image::ByteWriter out;
  out.text(kMagic);
  out.u32(kVersion), out.u32(static_cast<std::uint32_t>(records.size()));
  out.u64(hash.high), out.u64(hash.low);
  out.bytes(bytes);
  return out.take();
}

struct Decoded {
  std::vector<Record> records;
  std::vector<std::byte> radiance;
};
std::optional<Decoded> decode(std::span<const std::byte> file) {
  if (file.size() < kHeaderBytes) return {};
  image::Bytes in(file);
  const std::span<const std::byte> magic = in.take(kMagic.size());
  const std::uint32_t version = in.leU32(), count = in.leU32();
  Hash128 hash;
  hash.high = in.leU64(), hash.low = in.leU64();
  if (std::memcmp(magic.data(), kMagic.data(), kMagic.size()) != 0 || version != kVersion || core::hashOf(file.subspan(kHeaderBytes)) != hash) return {};
  if (count < 1 || count > kRun) return {};
  Decoded out;
  for (std::uint32_t i = 0; i < count; ++i) {
    Record& r = out.records.emplace_back();
    r.key.high = in.leU64(), r.key.low = in.leU64();
    for (auto& rgb : r.irradiance)
      for (double& v : rgb) v = std::bit_cast<double>(in.leU64());
  }
  const std::span<const std::byte> rest = in.take(in.left());
  if (in.bad()) return {};
  out.radiance.assign(rest.begin(), rest.end());
  return out;
}

/// Missing: none, and `there` is false.
std::optional<Decoded> readLight(const fs::path& file, bool& there) {
  std::error_code error;
  there = fs::exists(fs::symlink_status(file, error));
  if (!there) return {};
  const auto bytes = core::readFile(file, kMostBytes);
  return bytes ? decode(*bytes) : std::nullopt;
}

void warnDamaged(const fs::path& file, Report& report) { report.warn(file.string(), "is damaged: what it held is baked again"); }

std::string withEnding(const Hash128& key, bool reflection) { return key.hex() + std::string(reflection ? kReflection : kPoints); }

template <class F>
void eachFile(const fs::path& folder, F&& f) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) files.push_back(it->path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) f(file);
}

}  // namespace

std::vector<Unit> unitsOf(const ProbeSet& places) {
  std::vector<Unit> units;
  const int reflections = int(places.reflections.size()), all = captureCount(places);
  for (int i = 0; i < reflections; ++i) units.push_back({i, 1, true});
  for (int i = reflections; i < all; i += kRun) units.push_back({i, std::min(kRun, all - i), false});
  return units;
}

std::string unitName(const Unit& unit, std::span<const Hash128> keys) {
  if (unit.reflection) return withEnding(keys[std::size_t(unit.first)], true);
  core::Hasher h;
  for (int i = 0; i < unit.count; ++i) h.hash(keys[std::size_t(unit.first + i)]);
  return withEnding(h.finish(), false);
}

StoredLight storedLight(const IrradianceSh& irradiance, std::vector<std::byte> radiance) {
  const Hash128 content = contentOf(irradiance, radiance.empty() ? Hash128{} : core::hashOf(radiance));
  return {irradiance, std::move(radiance), content};
}

Result<void> LightStore::make() const {
  std::error_code error;
  fs::create_directory(folder_, error);
  if (error) return fail(folder_.string(), fmt::format("cannot be made ({})", error.message()), "check the permissions, or choose another folder");
  return {};
}

void LightStore::index(Report& report) {
  eachFile(folder_, [&](const fs::path& file) {
    if (file.extension() != kPoints) return;
    bool there = false;
    const auto light = readLight(file, there);
    if (!light) return warnDamaged(file, report);
    for (const Record& r : light->records) points_[r.key] = r.irradiance;
  });
}

std::optional<StoredLight> LightStore::reflection(const Hash128& key, Report& report) const {
  const fs::path file = folder_ / withEnding(key, true);
  bool there = false;
  auto light = readLight(file, there);
  if (!there) return {};
  if (!light || light->records.size() != 1 || light->records[0].key != key) return warnDamaged(file, report), std::nullopt;
  return storedLight(light->records[0].irradiance, std::move(light->radiance));
}

std::optional<StoredLight> LightStore::point(const Hash128& key) const {
  const auto found = points_.find(key);
  if (found == points_.end()) return {};
  return storedLight(found->second, {});
}

std::optional<std::vector<StoredLight>> LightStore::unit(const Unit& unit, std::span<const Hash128> keys, Report& report) const {
  std::vector<StoredLight> out;
  if (unit.reflection) {
    auto light = reflection(keys[std::size_t(unit.first)], report);
    if (!light) return {};
    out.push_back(std::move(*light));
    return out;
  }
  const fs::path file = folder_ / unitName(unit, keys);
  bool there = false;
  const auto light = readLight(file, there);
  if (!there) return {};
  bool good = light && int(light->records.size()) == unit.count;
  for (int i = 0; good && i < unit.count; ++i) {
    const Record& r = light->records[std::size_t(i)];
    good = r.key == keys[std::size_t(unit.first + i)];
    out.push_back(storedLight(r.irradiance, {}));
  }
  if (!good) return warnDamaged(file, report), std::nullopt;
  return out;
}

Result<void> LightStore::put(const Unit& unit, std::span<const Hash128> keys, std::span<const StoredLight> lights) {
  std::vector<Record> records;
  for (int i = 0; i < unit.count; ++i) {
    records.push_back({keys[std::size_t(unit.first + i)], lights[std::size_t(i)].irradiance});
    if (!unit.reflection) points_[records.back().key] = records.back().irradiance;
  }
  return core::writeFileAtomic(folder_ / unitName(unit, keys), encode(records, lights[0].radiance));
}

void LightStore::keepOnly(const std::set<std::string>& names) const {
  std::error_code ignored;
  eachFile(folder_, [&](const fs::path& file) {
    if (!names.contains(file.filename().string()) && fs::is_regular_file(fs::symlink_status(file, ignored))) fs::remove(file, ignored);
  });
}

std::vector<std::string> LightStore::damaged() const {
  std::vector<std::string> out;
  eachFile(folder_, [&](const fs::path& file) {
    bool there = false;
    if ((file.extension() == kReflection || file.extension() == kPoints) && !readLight(file, there)) out.push_back(file.filename().string());
  });
  return out;
}

}  // namespace burnish::probe
