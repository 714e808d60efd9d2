#include "probe/manifest.h"

#include <fmt/format.h>

#include <cmath>

#include "image/cube_file.h"

namespace burnish::probe {
namespace {

template <class V>
Json vec(const V& v) {
  Json out = Json::array();
  for (int i = 0; i < V::length(); ++i) out.push_back(v[i]);
  return out;
}
/// Column by column.
Json mat(const glm::dmat3& m) {
  Json out = Json::array();
  for (int i = 0; i < 9; ++i) out.push_back(m[i / 3][i % 3]);
  return out;
}
Json number(double v) { return std::isfinite(v) ? Json(v) : Json(); }

Json fileJson(const std::optional<FileEntry>& file) {
  if (!file) return {};
  return {{"name", file->name}, {"bytes", file->bytes}, {"xxh3_128", file->hash.hex()}};
}

Json reflectionJson(const Manifest::Reflection& r) {
  const ReflectionProbe& p = r.probe;
  Json out = {{"name", p.name},        {"center", vec(p.center)}, {"axes", mat(p.axes)}, {"half_size", vec(p.halfSize)},
              {"capture", vec(p.capture)}, {"fade", vec(p.fade)}, {"margin", p.margin},  {"irradiance", Json::array()}};
  for (const auto& rgb : p.irradiance) out["irradiance"].push_back(rgb);
  if (r.file) out["size"] = r.size, out["levels"] = r.levels, out["scale"] = r.scale;
  out["file"] = fileJson(r.file);
  return out;
}

Json gridJson(const Manifest::Grid& g) {
  const AmbientGrid& a = g.grid;
  std::string valid;
  for (const AmbientGrid::Point& p : a.points) valid += p.valid ? '1' : '0';
  return {{"name", a.name},     {"origin", vec(a.origin)}, {"axes", mat(a.axes)}, {"spacing", vec(a.spacing)},
          {"counts", vec(a.counts)}, {"margin", a.margin}, {"distance_size", AmbientGrid::kDistanceSize},
          {"valid", a.points.empty() ? Json() : Json(valid)}, {"irradiance", fileJson(g.irradiance)}, {"distances", fileJson(g.distances)}};
}

Json notesJson(const BakeNotes& notes) {
  Json out = {{"id", notes.id.hex()}, {"options", notes.options}, {"bounces", Json::array()}, {"keys", Json::array()}, {"grid_key", notes.gridKey ? Json(notes.gridKey->hex()) : Json()}};
  for (const BounceReport& b : notes.bounces) out["bounces"].push_back(bounceJson(b));
  for (const core::Hash128& key : notes.keys) out["keys"].push_back(key.hex());
  return out;
}

bool isFlat(const Json& list) {
  for (const Json& v : list)
    if (v.is_structured()) return false;
  return true;
}

// Documents of ours are as deep as their kinds: nothing here comes from outside.
void print(const Json& v, int indent, std::string& out) {
  const auto leaf = [](const Json& j) { return j.dump(-1, ' ', false, Json::error_handler_t::replace); };
  if (!v.is_structured() || v.empty() || (v.is_array() && isFlat(v))) {
    out += leaf(v);
    return;
  }
  const std::string pad(static_cast<std::size_t>(indent) + 2, ' ');
  out += v.is_array() ? '[' : '{';
  bool first = true;
  for (const auto& item : v.items()) {
    out += first ? "\n" : ",\n";
    out += pad;
    if (v.is_object()) out += leaf(item.key()) + ": ";
    print(item.value(), indent + 2, out);
    first = false;
  }
  out += '\n';
  out.append(static_cast<std::size_t>(indent), ' ');
  out += v.is_array() ? ']' : '}';
}

}  // namespace

Json bounceJson(const BounceReport& b) {
  return {{"bounce", b.bounce}, {"change", number(b.change)}, {"light", number(b.light)}, {"ratio", number(b.ratio)}, {"rest", number(b.rest)}};
}

std::string jsonText(const Json& document) {
  std::string out;
  print(document, 0, out);
  return out + "\n";
}

std::string manifestText(const Manifest& manifest) {
  Json out;
  out["schema_version"] = kSchemaVersion;
  out["format"] = "burnish-probes";
  out["format_version"] = kFormatVersion;
  out["writer"] = manifest.writer;
  out["lobe"] = !manifest.lobe ? Json() : Json(*manifest.lobe == ReflectionLobe::Ggx ? "ggx" : "blinn-phong");
  out["reflections"] = Json::array();
  for (const Manifest::Reflection& r : manifest.reflections) out["reflections"].push_back(reflectionJson(r));
  out["grid"] = manifest.grid ? gridJson(*manifest.grid) : Json();
  out["bake"] = manifest.bake ? notesJson(*manifest.bake) : Json();
  return sealed(jsonText(out));
}

std::string sealed(std::string text) {
  text.resize(text.size() - 3);  // "\n}\n"
  text += ",\n";
  const std::string hash = core::hashOf(std::as_bytes(std::span(text))).hex();
  return text + fmt::format("  \"{}\": \"{}\"\n}}\n", kSealName, hash);
}

Result<void> checkSeal(std::span<const std::byte> bytes, const std::string& place) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string before = fmt::format("  \"{}\": \"", kSealName);
  const std::size_t length = before.size() + 32 + 4;  // and "\n}\n
  const std::string_view last = text.substr(text.size() < length ? 0 : text.size() - length);
  const auto hash = last.starts_with(before) && last.ends_with("\"\n}\n") ? core::parseHash(last.substr(before.size(), 32)) : std::nullopt;
  if (!hash) return fail(place, fmt::format("is cut off or changed: it does not end in its own '{}'", kSealName), "restore the file, or bake again");
  const core::Hash128 found = core::hashOf(bytes.first(text.size() - length));
  if (found != *hash) return fail(place, fmt::format("is damaged: the XXH3-128 of its bytes up to '{}' is {}, it says {}", kSealName, found.hex(), hash->hex()), "restore the file, or bake again");
  return {};
}

bool isPayloadName(std::string_view name) {
  constexpr std::string_view kEnding = ".ktx2";
  if (name.size() > 100 || name.size() <= kEnding.size() || !name.ends_with(kEnding) || name[0] == '.') return false;
  for (const char c : name)
    if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.')) return false;
  return true;
}

}  // namespace burnish::probe
