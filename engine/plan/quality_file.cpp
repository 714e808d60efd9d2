// Quality files: rungs and sizes by name, as JSON.
#include "plan/quality_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "asset/check.h"
#include "core/file.h"
#include "core/near_name.h"

namespace burnish {
namespace plan {
namespace {

using asset::At;
using Names = std::vector<std::string_view>;

constexpr asset::JsonLimits kLimits{8, 4096};
constexpr const char* kRemedy = "correct the file, or write it again with burnish cost --budget";
constexpr std::size_t kLongestComment = 4096;

constexpr QualityNumber kNumbers[] = {
    {"shadow_resolution", &Quality::shadowResolution, nullptr, 16, 8192},
    {"shadow_cascades", &Quality::shadowCascades, nullptr, 1, 4},
    {"shadow_distance", nullptr, &Quality::shadowDistance, 0, 1e9},
    {"shadow_maps", &Quality::shadowMaps, nullptr, 1, 1024},
    {"resolution_scale", nullptr, &Quality::resolutionScale, 0.25, 1},
    {"bloom_share", nullptr, &Quality::bloomShare, 0, 1},
    {"transparent_layers", &Quality::transparentLayers, nullptr, 1, 64},
    {"light_threshold", nullptr, &Quality::lightThreshold, 1e-12, 1e9},
    {"occlusion_radius", nullptr, &Quality::occlusionRadius, 1e-3, 1e3},
};

/// Of a float the shortest text that is this float again: 0.08, not 0.07999999821186066.
double shortest(float value) { return std::strtod(fmt::format("{}", value).c_str(), nullptr); }

bool within(const QualityNumber& n, double value) {
  // Bounds are decimal and floats are not: 1e-3f is a little more than 1e-3, 1e-12f a little less.
  return n.whole ? value >= n.least && value <= n.most : float(value) >= float(n.least) && float(value) <= float(n.most);
}

Names namesOf(std::span<const Rung> rungs) {
  Names names;
  for (const Rung& r : rungs) names.push_back(r.name);
  return names;
}
Names namesOf(std::span<const Term> all) {
  Names names;
  for (const Term& t : all) names.push_back(t.name);
  return names;
}
Names namesOf(std::span<const QualityNumber> all) {
  Names names;
  for (const QualityNumber& n : all) names.push_back(n.name);
  return names;
}

/// The preset that shares most rungs: what terms that later versions add will be as in.
std::string_view nearestPreset(const Quality& quality) {
  std::string_view best = "default";
  std::size_t most = 0;
  for (const std::string_view name : {std::string_view("default"), std::string_view("seed"), std::string_view("exact")}) {
    Quality preset;
    (void)setPreset(preset, name);
    std::size_t same = 0;
    for (std::size_t t = 0; t < terms().size(); ++t) same += rungOf(preset, t) == rungOf(quality, t) ? 1 : 0;
    if (same > most) most = same, best = name;
  }
  return best;
}

/// A name from the file as errors show it.
std::string shown(std::string_view text) {
  std::string out;
  asset::appendPointer(out, text);
  return out.substr(1);
}

/// Reads one file. The first fault is kept; what comes after it is not looked at.
class Reader {
 public:
  explicit Reader(const std::string& place) : place_(place) {}
  std::optional<Error> error;

  void fault(const At& at, std::string what, std::string remedy = kRemedy) {
    if (!error) error = Error{place_ + ": " + at.path(), std::move(what), std::move(remedy)};
  }
  /// The index of a name in the list, or names.size() and a fault.
  std::size_t choose(const At& at, const Names& names, std::string_view kind) {
    if (!at->is_string()) return fault(at, fmt::format("is {} where the name of {} is expected", at->type_name(), kind)), names.size();
    const std::string& text = at->get_ref<const std::string&>();
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) fault(at, fmt::format("'{}' is no {}{}", shown(text), kind, core::didYouMean(text, names)), fmt::format("choose one of: {}", fmt::join(names, ", ")));
    return std::size_t(found - names.begin());
  }
  /// f(At, index) for each member of an object, whose names must be of the list.
  template <class F>
  void members(const At& at, const Names& names, std::string_view kind, F&& f) {
    if (!at->is_object()) return fault(at, fmt::format("is {} where an object is expected", at->type_name()));
    for (const auto& [key, value] : at->items()) {
      const At here(at, key, value);
      const auto found = std::find(names.begin(), names.end(), key);
      if (found == names.end()) return fault(here, fmt::format("is no {}{}", kind, core::didYouMean(key, names)), fmt::format("choose one of: {}", fmt::join(names, ", ")));
      f(here, std::size_t(found - names.begin()));
      if (error) return;
    }
  }
  double number(const At& at, const QualityNumber& n) {
    if (!at->is_number()) return fault(at, fmt::format("is {} where a number is expected", at->type_name())), 0;
    const double value = at->get<double>();
    if (!within(n, value)) fault(at, fmt::format("{} is out of range", value), fmt::format("give {} to {}", n.least, n.most));
    else if (n.whole && value != std::floor(value)) fault(at, fmt::format("{} is not whole", value), "give a whole number");
    return value;
  }

 private:
  const std::string& place_;
};

constexpr std::string_view kSections[] = {"schema_version", "comment", "base", "terms", "numbers", "tone_map"};

void readTerms(Reader& reader, const At& at, Quality& q) {
  reader.members(at, namesOf(terms()), "term", [&](const At& here, std::size_t t) {
    if (const std::size_t r = reader.choose(here, namesOf(terms()[t].rungs), fmt::format("rung of {}", terms()[t].name)); !reader.error) setRung(q, t, r);
  });
}
void readNumbers(Reader& reader, const At& at, Quality& q) {
  reader.members(at, namesOf(qualityNumbers()), "number", [&](const At& here, std::size_t i) {
    const QualityNumber& n = kNumbers[i];
    const double value = reader.number(here, n);
    if (reader.error) return;
    if (n.whole) q.*n.whole = int(value);
    else q.*n.number = float(value);
  });
}

/// f(At) for a member of the root, if it is there.
template <class F>
void section(Reader& reader, const At& root, const char* key, F&& f) {
  if (const auto found = root->find(key); !reader.error && found != root->end()) f(At(root, key, *found));
}

}  // namespace

std::span<const QualityNumber> qualityNumbers() { return kNumbers; }

Result<std::string> qualityText(const Quality& quality, std::string_view comment, const std::string& place) {
  nlohmann::ordered_json out;
  out["schema_version"] = kQualityVersion;
  if (!comment.empty()) out["comment"] = comment.substr(0, kLongestComment);
  out["base"] = nearestPreset(quality);
  for (std::size_t t = 0; t < terms().size(); ++t) out["terms"][std::string(terms()[t].name)] = terms()[t].rungs[rungOf(quality, t)].name;
  for (const QualityNumber& n : kNumbers) {
    if (!within(n, n.of(quality))) return fail(place, fmt::format("{} is {}, out of range", n.name, n.of(quality)), fmt::format("give {} to {}", n.least, n.most));
    auto& number = out["numbers"][std::string(n.name)];
    if (n.whole) number = quality.*n.whole;
    else number = shortest(quality.*n.number);
  }
  out["tone_map"] = toneMapNames()[std::size_t(quality.toneMap)];
  return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<Quality> parseQuality(std::span<const std::byte> text, const std::string& place) {
  const auto document = asset::parseJson(text, place, kLimits);
  if (!document) return fail(document.error().place, document.error().what, kRemedy);
  Reader reader(place);
  const At root(*document);
  reader.members(root, {std::begin(kSections), std::end(kSections)}, "part of a quality file", [](const At&, std::size_t) {});
  if (!reader.error && !root->contains("schema_version")) reader.fault(root, "'schema_version' is missing: this is no quality file", "name a file that burnish cost --budget wrote");
  section(reader, root, "schema_version", [&](const At& at) {
    if (!at->is_number_integer() || *at != kQualityVersion)
      reader.fault(at, fmt::format("{} is no version that this program knows ({})", at->is_number() ? at->dump() : at->type_name(), kQualityVersion), "use the program that wrote it");
  });
  section(reader, root, "comment", [&](const At& at) {
    if (!at->is_string()) reader.fault(at, fmt::format("is {} where a text is expected", at->type_name()));
  });
  Quality q;
  section(reader, root, "base", [&](const At& at) {
    const std::span<const std::string_view> presets = presetNames();
    if (const std::size_t i = reader.choose(at, {presets.begin(), presets.end()}, "preset"); !reader.error) (void)setPreset(q, presets[i]);
  });
  section(reader, root, "terms", [&](const At& at) { readTerms(reader, at, q); });
  section(reader, root, "numbers", [&](const At& at) { readNumbers(reader, at, q); });
  section(reader, root, "tone_map", [&](const At& at) {
    const std::span<const std::string_view> names = toneMapNames();
    if (const std::size_t i = reader.choose(at, {names.begin(), names.end()}, "tone map"); !reader.error) q.toneMap = ToneMap(i);
  });
  if (reader.error) return fail(std::move(*reader.error));
  return q;
}

}  // namespace plan

Result<void> writeQuality(const std::filesystem::path& file, const Quality& quality, std::string_view comment) {
  const auto text = plan::qualityText(quality, comment, file.string());
  if (!text) return fail(text.error());
  return core::writeFileAtomic(file, std::as_bytes(std::span(text->data(), text->size())));
}

Result<Quality> readQuality(const std::filesystem::path& file) {
  const auto bytes = core::readFile(file, plan::kMostQualityBytes);
  if (!bytes) return fail(bytes.error());
  return plan::parseQuality(*bytes, file.string());
}

}  // namespace burnish
