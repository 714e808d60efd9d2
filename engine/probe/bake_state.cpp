#include "probe/bake_state.h"

#include <fmt/format.h>

#include <algorithm>

#include "asset/check.h"
#include "core/file.h"
#include "image/cube_file.h"

namespace burnish::probe {
namespace {

namespace fs = std::filesystem;
using asset::At;
using asset::Check;
using asset::Need;
using core::Hash128;

constexpr asset::JsonLimits kLimits{8, 4'000'000};
constexpr std::uint64_t kMostCount = 1 << 30;
constexpr const char* kRemedy = "bake again with --resume, which takes what is whole";

Json head(std::string_view format, const Hash128& id) { return {{"schema_version", kSchemaVersion}, {"format", format}, {"id", id.hex()}}; }
Json keysJson(std::span<const Hash128> keys) {
  Json out = Json::array();
  for (const Hash128& key : keys) out.push_back(key.hex());
  return out;
}

/// A document of ours as a checked object. None: there is no such file.
Result<std::optional<asset::Json>> readDocument(const fs::path& file, std::string_view format) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(file, error))) return std::optional<asset::Json>();
  const std::string place = file.string();
  const auto bytes = core::readFile(file, kMostManifestBytes);
  if (!bytes) return fail(bytes.error());
  if (auto ok = checkSeal(*bytes, place); !ok) return fail(place, ok.error().what, kRemedy);
  auto document = asset::parseJson(*bytes, place, kLimits);
  if (!document) return fail(document.error().place, document.error().what, kRemedy);
  const bool good = document->is_object() && document->value("format", asset::Json()) == format && document->value("schema_version", asset::Json()) == kSchemaVersion;
  if (!good) return fail(place, fmt::format("is no {} of version {}", format, kSchemaVersion), "remove the folder around it, and bake again");
  return std::optional(std::move(*document));
}

Hash128 idOf(Check& check, const At& root) {
  const std::string* text = check.string(root, "id", Need::Required);
  const auto id = text ? core::parseHash(*text) : std::nullopt;
  if (!id) check.fail(root, "'id' is no XXH3-128", kRemedy);
  return id.value_or(Hash128{});
}
std::vector<Hash128> keysOf(Check& check, const At& root) {
  std::vector<Hash128> keys;
  const asset::Json* list = check.array(root, "keys", Need::Required);
  for (std::size_t i = 0; list && i < list->size(); ++i) {
    const auto key = (*list)[i].is_string() ? core::parseHash((*list)[i].get_ref<const std::string&>()) : std::nullopt;
    if (!key) return check.fail(root, fmt::format("'keys' {} is no XXH3-128", i), kRemedy), keys;
    keys.push_back(*key);
  }
  return keys;
}
double numberOr(Check& check, const At& at, const char* key, double fallback) {
  const auto found = at->find(key);
  return found == at->end() || found->is_null() ? fallback : check.number(at, key, fallback, {-1.7e308, 1.7e308});
}
int count(Check& check, const At& at, const char* key, std::uint64_t least) { return static_cast<int>(check.integer(at, key, 0, least, kMostCount, Need::Required)); }

std::string bounceName(int bounce) { return fmt::format("bounce_{:04}.json", bounce); }

Result<void> writeDocument(const fs::path& file, const Json& document) {
  const std::string text = sealed(jsonText(document));
  return core::writeFileAtomic(file, std::as_bytes(std::span(text)));
}

/// Names in a folder that start so, sorted.
std::vector<fs::path> startingWith(const fs::path& folder, const std::string& start) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().filename().string().starts_with(start)) files.push_back(it->path());
  std::sort(files.begin(), files.end());
  return files;
}
void removeAll(const std::vector<fs::path>& files) {
  std::error_code ignored;
  for (const fs::path& file : files) fs::remove(file, ignored);
}

}  // namespace

Json optionsJson(const BakeOptions& o, const std::string& renderer) {
  Json rungs = Json::object();
  for (std::size_t t = 0; t < terms().size(); ++t)
    if (!terms()[t].picture || terms()[t].name == "shadow") rungs[std::string(terms()[t].name)] = terms()[t].rungs[rungOf(o.quality, t)].name;
  const Json out = {{"size", o.size}, {"ambient_size", o.ambientSize}, {"lobe", o.lobe == ReflectionLobe::Ggx ? "ggx" : "blinn-phong"}, {"bounces", o.bounces}, {"until", o.until}, {"max_bounces", o.maxBounces},
          {"albedo_limit", o.albedoLimit}, {"renderer", renderer}, {"rungs", std::move(rungs)}};
  return Json(asset::Json(out));  // sorted, as they are when they have been read
}

Result<std::optional<BakeState>> StateFolder::state() const {
  const fs::path file = work_ / "bake.json";
  const auto document = readDocument(file, "burnish-bake");
  if (!document) return fail(document.error());
  if (!*document) return std::optional<BakeState>();
  Report ignored;
  Check check(file.string(), ignored);
  const At root(**document);
  BakeState out;
  out.id = idOf(check, root);
  check.withObject(root, "options", [&](const At& at) {
    out.options = Json(*at);
    out.stop.bounces = count(check, at, "bounces", 0);
    out.stop.maxBounces = count(check, at, "max_bounces", 1);
    out.stop.until = check.number(at, "until", 0, asset::kNotNegative, Need::Required);
  }, Need::Required);
  if (!check.ok()) return fail(check.error());
  return std::optional(std::move(out));
}

Result<void> StateFolder::write(const BakeState& state) const {
  Json document = head("burnish-bake", state.id);
  document["writer"] = image::writerName();
  document["options"] = state.options;
  return writeDocument(work_ / "bake.json", document);
}

Result<std::optional<BounceRecord>> StateFolder::bounce(const Hash128& id, int bounce) const {
  const fs::path file = work_ / bounceName(bounce);
  const auto document = readDocument(file, "burnish-bounce");
  if (!document) return fail(document.error());
  if (!*document) return std::optional<BounceRecord>();
  Report ignored;
  Check check(file.string(), ignored);
  const At root(**document);
  if (idOf(check, root) != id) check.fail(root, "is of another bake", kRemedy);
  BounceRecord out;
  out.keys = keysOf(check, root);
  check.withObject(root, "log", [&](const At& log) {
    out.report.bounce = count(check, log, "bounce", 1);
    if (check.ok() && out.report.bounce != bounce) check.fail(log, fmt::format("is of bounce {}", out.report.bounce), kRemedy);
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    out.report.change = numberOr(check, log, "change", kInfinite), out.report.light = numberOr(check, log, "light", kInfinite);
    out.report.ratio = numberOr(check, log, "ratio", kInfinite), out.report.rest = numberOr(check, log, "rest", kInfinite);
  }, Need::Required);
  if (!check.ok()) return fail(check.error());
  return std::optional(std::move(out));
}

Result<void> StateFolder::write(const Hash128& id, const BounceRecord& record) const {
  Json document = head("burnish-bounce", id);
  document["log"] = bounceJson(record.report);
  document["keys"] = keysJson(record.keys);
  return writeDocument(work_ / bounceName(record.report.bounce), document);
}

Result<std::vector<BounceRecord>> StateFolder::bounces(const Hash128& id) const {
  std::vector<BounceRecord> out;
  for (;;) {
    auto next = bounce(id, int(out.size()) + 1);
    if (!next) return fail(next.error());
    if (!*next) return out;
    out.push_back(std::move(**next));
  }
}

Result<std::vector<PartRecord>> StateFolder::parts(const Hash128& id, int bounce) const {
  std::vector<PartRecord> out;
  for (const fs::path& file : startingWith(work_, fmt::format("part_{:04}_", bounce))) {
    const auto document = readDocument(file, "burnish-part");
    if (!document) return fail(document.error());
    if (!*document) continue;
    Report ignored;
    Check check(file.string(), ignored);
    const At root(**document);
    if (idOf(check, root) != id) check.fail(root, "is of another bake", "remove it, or bake again with --resume");
    PartRecord part;
    part.bounce = count(check, root, "bounce", 1), part.shards = count(check, root, "shards", 1), part.shard = count(check, root, "shard", 1) - 1;
    part.captured = count(check, root, "captured", 0), part.reused = count(check, root, "reused", 0);
    part.keys = keysOf(check, root);
    if (check.ok() && (part.bounce != bounce || part.shard >= part.shards)) check.fail(root, "is of another bounce or of a shard that cannot be", "remove it, and bake that shard again");
    if (!check.ok()) return fail(check.error());
    out.push_back(std::move(part));
  }
  std::stable_sort(out.begin(), out.end(), [](const PartRecord& a, const PartRecord& b) { return a.shard < b.shard; });
  return out;
}

Result<void> StateFolder::write(const Hash128& id, const PartRecord& record) const {
  Json document = head("burnish-part", id);
  document["bounce"] = record.bounce, document["shard"] = record.shard + 1, document["shards"] = record.shards;
  document["captured"] = record.captured, document["reused"] = record.reused;
  document["keys"] = keysJson(record.keys);
  return writeDocument(work_ / fmt::format("part_{:04}_{}of{}.json", record.bounce, record.shard + 1, record.shards), document);
}

void StateFolder::forget() const {
  removeAll(startingWith(work_, "bounce_"));
  removeAll(startingWith(work_, "part_"));
  removeAll(startingWith(work_, ".burnish-"));
}
void StateFolder::forgetParts(int bounce) const { removeAll(startingWith(work_, fmt::format("part_{:04}_", bounce))); }

}  // namespace burnish::probe
