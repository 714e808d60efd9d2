// Reading probes.json, which nobody vouches for: depth and number of values are bounded before parsing, every member is checked for its type and range.
#include <fmt/format.h>

#include <cmath>

#include "asset/check.h"
#include "probe/manifest.h"

namespace burnish::probe {
namespace {

using asset::At;
using asset::Check;
using asset::Need;
using asset::Range;
using asset::kNotNegative;

constexpr asset::JsonLimits kLimits{12, 2'000'000};
constexpr std::size_t kMostBounces = 10000;
constexpr const char* kRemedy = "restore the file, or bake again";

/// A member that must be there and be a list of numbers of just this length.
template <class T>
void numbersOf(Check& check, const At& at, const char* key, std::span<T> out, const Range& range = {}) {
  std::vector<double> values(out.size());
  if (!check.member(at, key, Need::Required) || !check.numbers(at, key, values, range)) return;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<T>(values[i]);
}
glm::dvec3 vectorOf(Check& check, const At& at, const char* key, const Range& range = {}) {
  glm::dvec3 v{0};
  numbersOf(check, at, key, std::span<double>(&v.x, 3), range);
  return v;
}
glm::dmat3 axesOf(Check& check, const At& at) {
  glm::dmat3 m(1);
  numbersOf(check, at, "axes", std::span<double>(&m[0].x, 9));
  return m;
}
std::string textOf(Check& check, const At& at, const char* key) {
  const std::string* text = check.string(at, key, Need::Required);
  return text ? *text : std::string();
}
std::optional<core::Hash128> hashOf(Check& check, const At& at, const char* key) {
  const auto hash = core::parseHash(textOf(check, at, key));
  if (!hash) check.fail(at, fmt::format("'{}' is no XXH3-128 of 32 hexadecimal digits", key), kRemedy);
  return hash;
}

/// null or missing: none.
bool present(const At& at, const char* key) {
  const auto found = at->find(key);
  return found != at->end() && !found->is_null();
}

/// `most`: bytes that such a file may have.
std::optional<FileEntry> fileOf(Check& check, const At& parent, const char* key, std::uint64_t most) {
  if (!present(parent, key)) return {};
  std::optional<FileEntry> out;
  check.withObject(parent, key, [&](const At& at) {
    check.known(at, {"bytes", "xxh3_128"});
    FileEntry file{textOf(check, at, "name"), check.integer(at, "bytes", 0, 1, most, Need::Required), {}};
    if (check.ok() && !isPayloadName(file.name)) check.fail(at, fmt::format("'{}' is no plain file name ending in .ktx2", file.name.substr(0, 60)), kRemedy);
    file.hash = hashOf(check, at, "xxh3_128").value_or(core::Hash128{});
    out = std::move(file);
  });
  return out;
}

void readIrradiance(Check& check, const At& at, IrradianceSh& out) {
  const asset::Json* list = check.array(at, "irradiance", Need::Required);
  if (!list) return;
  if (list->size() != out.size()) return check.fail(at, fmt::format("'irradiance' has {} coefficients, not {}", list->size(), out.size()), kRemedy);
  const At here(at, "irradiance", *list);
  for (std::size_t i = 0; i < out.size() && check.ok(); ++i) {
    const At row(here, i, (*list)[i]);
    if (!row->is_array() || row->size() != 3) return check.fail(row, "is no list of three numbers", kRemedy);
    for (std::size_t c = 0; c < 3; ++c) out[i][c] = check.numberValue(At(row, c, (*row)[c]), Range{});
  }
}

Manifest::Reflection reflectionOf(Check& check, const At& at) {
  check.known(at, {"center", "axes", "half_size", "capture", "fade", "margin", "irradiance", "size", "levels", "scale", "file"});
  Manifest::Reflection r;
  ReflectionProbe& p = r.probe;
  p.name = textOf(check, at, "name");
  p.center = vectorOf(check, at, "center");
  p.axes = axesOf(check, at);
  p.halfSize = vectorOf(check, at, "half_size", kNotNegative);
  p.capture = vectorOf(check, at, "capture");
  p.fade = vectorOf(check, at, "fade", kNotNegative);
  p.margin = check.number(at, "margin", 0, kNotNegative, Need::Required);
  readIrradiance(check, at, p.irradiance);
  if (check.ok() && present(at, "file")) {
    r.size = static_cast<int>(check.integer(at, "size", 0, 1, kMostSize, Need::Required));
    r.levels = static_cast<int>(check.integer(at, "levels", 0, 1, 12, Need::Required));
    r.scale = check.number(at, "scale", 1, asset::kPositive, Need::Required);
    // Levels together are under 4/3 of the first, half floats of four channels; then room for whatever a writer puts before them.
    r.file = fileOf(check, at, "file", 6ull * 8 * 4 / 3 * static_cast<std::uint64_t>(r.size) * static_cast<std::uint64_t>(r.size) + 65536);
  }
  if (!check.ok()) return r;
  if (auto ok = checkProbe(p, at.path()); !ok) check.fail(at, ok.error().what, kRemedy);
  return r;
}

Manifest::Grid gridOf(Check& check, const At& at) {
  check.known(at, {"origin", "axes", "spacing", "counts", "margin", "distance_size", "valid", "irradiance", "distances"});
  Manifest::Grid out;
  AmbientGrid& g = out.grid;
  g.name = textOf(check, at, "name");
  g.origin = vectorOf(check, at, "origin");
  g.axes = axesOf(check, at);
  g.spacing = vectorOf(check, at, "spacing", asset::kPositive);
  std::array<double, 3> counts{};
  numbersOf(check, at, "counts", std::span<double>(counts), Range{1, double(kMostGridPoints)});
  for (int i = 0; i < 3; ++i) {
    if (check.ok() && counts[std::size_t(i)] != std::floor(counts[std::size_t(i)])) check.fail(at, "'counts' holds a number that is not whole", kRemedy);
    g.counts[i] = static_cast<int>(counts[std::size_t(i)]);
  }
  g.margin = check.number(at, "margin", 0, kNotNegative, Need::Required);
  check.integer(at, "distance_size", 0, AmbientGrid::kDistanceSize, AmbientGrid::kDistanceSize, Need::Required);
  if (!check.ok()) return out;
  if (auto ok = checkGrid(g, at.path()); !ok) return check.fail(at, ok.error().what, kRemedy), out;
  const std::uint64_t points = std::uint64_t(g.counts.x) * std::uint64_t(g.counts.y) * std::uint64_t(g.counts.z), texels = AmbientGrid::kDistanceSize * AmbientGrid::kDistanceSize;
  if (!present(at, "valid")) return out;
  const std::string valid = textOf(check, at, "valid");
  if (valid.size() != points || valid.find_first_not_of("01") != std::string::npos) return check.fail(at, fmt::format("'valid' is no text of {} digits 0 and 1", points), kRemedy), out;
  g.points.resize(points);
  for (std::size_t i = 0; i < points; ++i) g.points[i].valid = valid[i] == '1';
  out.irradiance = fileOf(check, at, "irradiance", points * 9 * 12 + 65536);
  out.distances = fileOf(check, at, "distances", points * texels * 8 + 65536);
  return out;
}

BakeNotes notesOf(Check& check, const At& at) {
  BakeNotes notes;
  notes.id = hashOf(check, at, "id").value_or(core::Hash128{});
  if (const auto options = at->find("options"); options != at->end() && options->is_object()) notes.options = Json(*options);
  const asset::Json* bounces = check.array(at, "bounces", Need::Required);
  if (!bounces) return notes;
  if (bounces->size() > kMostBounces) return check.fail(at, fmt::format("'bounces' has {} entries", bounces->size()), kRemedy), notes;
  check.eachObject(at, "bounces", [&](const At& b, std::size_t i) {
    const auto number = [&](const char* key) { return present(b, key) ? check.number(b, key, 0, Range{}) : std::numeric_limits<double>::infinity(); };
    notes.bounces.push_back({.bounce = static_cast<int>(check.integer(b, "bounce", 0, i + 1, i + 1, Need::Required)), .change = number("change"), .light = number("light"), .ratio = number("ratio"), .rest = number("rest")});
  });
  if (const asset::Json* keys = check.member(at, "keys", Need::Required); keys && keys->is_array())
    for (const asset::Json& key : *keys)
      if (const auto hash = key.is_string() ? core::parseHash(key.get_ref<const std::string&>()) : std::nullopt) notes.keys.push_back(*hash);
  if (present(at, "grid_key")) notes.gridKey = hashOf(check, at, "grid_key");
  return notes;
}

void readHead(Check& check, const At& root, Manifest& out) {
  check.known(root, {"schema_version", "format", "format_version", "writer", "lobe", "reflections", "grid", "bake", kSealName});
  if (textOf(check, root, "format") != "burnish-probes") check.fail(root, "'format' is not burnish-probes", "name a folder that burnish bake wrote");
  for (const auto& [key, version] : {std::pair("schema_version", kSchemaVersion), std::pair("format_version", kFormatVersion)}) {
    const std::uint64_t found = check.integer(root, key, 0, 1, 1000000, Need::Required);
    if (check.ok() && found != std::uint64_t(version)) check.fail(root, fmt::format("'{}' is {}, this program knows {}", key, found, version), "bake again, or use the program that wrote it");
  }
  out.writer = textOf(check, root, "writer");
  if (!present(root, "lobe")) return;
  const std::string lobe = textOf(check, root, "lobe");
  if (check.ok() && lobe != "ggx" && lobe != "blinn-phong") check.fail(root, fmt::format("'lobe' is '{}', neither blinn-phong nor ggx", lobe.substr(0, 40)), kRemedy);
  out.lobe = lobe == "ggx" ? ReflectionLobe::Ggx : ReflectionLobe::BlinnPhong;
}

}  // namespace

Result<Manifest> parseManifest(std::span<const std::byte> text, const std::string& place, Report& report) {
  if (auto ok = checkSeal(text, place); !ok) return fail(ok.error());
  const auto document = asset::parseJson(text, place, kLimits);
  if (!document) return fail(document.error().place, document.error().what, kRemedy);
  Manifest out;
  Check check(place, report);
  const At root(*document);
  if (!document->is_object()) return fail(place, "holds no JSON object", kRemedy);
  readHead(check, root, out);
  const asset::Json* list = check.ok() ? check.member(root, "reflections", Need::Required) : nullptr;
  if (list && !list->is_array()) check.fail(root, "'reflections' is no list", kRemedy);
  if (check.ok() && list->size() > kMostReflections) check.fail(root, fmt::format("'reflections' has {} entries, at most {} are read", list->size(), kMostReflections), kRemedy);
  if (check.ok() && !list->empty()) check.eachObject(root, "reflections", [&](const At& at, std::size_t) { out.reflections.push_back(reflectionOf(check, at)); });
  if (check.ok() && present(root, "grid")) check.withObject(root, "grid", [&](const At& at) { out.grid = gridOf(check, at); });
  if (check.ok() && present(root, "bake")) check.withObject(root, "bake", [&](const At& at) { out.bake = notesOf(check, at); });
  if (!check.ok()) return fail(check.error());
  return out;
}

}  // namespace burnish::probe
