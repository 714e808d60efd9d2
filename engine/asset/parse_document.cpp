// The root of a glTF file: version, extensions, and the order in which the tables are read.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "asset/document.h"

namespace burnish::asset {
namespace {

constexpr std::string_view kSupported[] = {"KHR_texture_transform",
                                           "KHR_lights_punctual",
                                           "KHR_materials_ior",
                                           "KHR_materials_specular",
                                           "KHR_materials_emissive_strength",
                                           "KHR_materials_transmission",
                                           "KHR_materials_unlit",
                                           "KHR_materials_volume",
                                           "KHR_materials_anisotropy",
                                           "KHR_materials_pbrSpecularGlossiness",
                                           "KHR_mesh_quantization"};

struct Version {
  int major = 0, minor = 0;
  auto operator<=>(const Version&) const = default;
};

std::optional<Version> parseVersion(std::string_view text) {
  Version v;
  const std::size_t dot = text.find('.');
  if (dot == text.npos) return {};
  const auto digits = [](std::string_view part, int& out) {
    if (part.empty() || part.size() > 6 || part.find_first_not_of("0123456789") != part.npos) return false;
    for (const char c : part) out = out * 10 + (c - '0');
    return true;
  };
  if (!digits(text.substr(0, dot), v.major) || !digits(text.substr(dot + 1), v.minor)) return {};
  return v;
}

std::optional<Version> readVersion(const At& asset, const char* key, Check& check, Need need) {
  const std::string* text = check.string(asset, key, need);
  if (!text) return {};
  const auto version = parseVersion(*text);
  if (!version) check.fail(At(asset, key, asset->at(key)), fmt::format("'{}' is not a version", text->substr(0, 40)));
  return version;
}

void parseAssetObject(const At& root, Check& check) {
  check.withObject(
      root, "asset",
      [&](const At& at) {
        check.known(at, {"version", "minVersion", "copyright", "generator"});
        check.string(at, "copyright");
        check.string(at, "generator");
        const auto version = readVersion(at, "version", check, Need::Required);
        const auto least = readVersion(at, "minVersion", check, Need::Optional);
        if (!check.ok()) return;
        if (version->major != 2)
          check.fail(At(at, "version", at->at("version")),
                     fmt::format("glTF {}.{} is not supported", version->major, version->minor),
                     "convert the file to glTF 2.0");
        else if (least && *least > *version)
          check.fail(At(at, "minVersion", at->at("minVersion")), "minVersion is greater than version");
        else if (version->minor > 0)
          check.warn("/asset/version", fmt::format("glTF 2.{} is read as glTF 2.0", version->minor));
      },
      Need::Required);
}

std::vector<std::string> extensionNames(const At& root, const char* key, Check& check) {
  std::vector<std::string> names;
  const Json* list = check.array(root, key);
  if (!list) return names;
  const At here(root, key, *list);
  std::set<std::string> seen;
  for (std::size_t i = 0; check.ok() && i < list->size(); ++i) {
    const At at(here, i, (*list)[i]);
    if (!at->is_string())
      check.fail(at, "not a string where an extension's name is expected");
    else if (!seen.insert(at->get<std::string>()).second)
      check.fail(at, fmt::format("extension '{}' is listed twice", at->get<std::string>().substr(0, 80)));
    else
      names.push_back(at->get<std::string>());
  }
  return names;
}

void parseExtensions(const At& root, Check& check) {
  const auto used = extensionNames(root, "extensionsUsed", check);
  const auto required = extensionNames(root, "extensionsRequired", check);
  check.extensionsUsed.insert(used.begin(), used.end());
  const auto supported = [](const std::string& name) {
    return std::find(std::begin(kSupported), std::end(kSupported), name) != std::end(kSupported);
  };
  for (std::size_t i = 0; check.ok() && i < required.size(); ++i) {
    const std::string path = fmt::format("/extensionsRequired/{}", i), name = required[i].substr(0, 80);
    if (!check.extensionsUsed.contains(required[i]))
      check.fail(path, fmt::format("extension '{}' is required but not listed as used", name),
                 "list it in /extensionsUsed");
    else if (!supported(required[i]))
      check.fail(path, fmt::format("the file requires extension '{}', which is not supported", name),
                 "export the file without it");
  }
  for (std::size_t i = 0; check.ok() && i < used.size(); ++i)
    if (!supported(used[i]))
      check.warn(fmt::format("/extensionsUsed/{}", i),
                 fmt::format("extension '{}' is not supported and ignored", used[i].substr(0, 80)));
}

// References are checked where they stand, so the sizes of all tables come first.
void countTables(const At& root, Check& check) {
  constexpr std::pair<Table, const char*> kTables[] = {
      {Table::Accessors, "accessors"}, {Table::Buffers, "buffers"}, {Table::BufferViews, "bufferViews"},
      {Table::Cameras, "cameras"},     {Table::Images, "images"},   {Table::Materials, "materials"},
      {Table::Meshes, "meshes"},       {Table::Nodes, "nodes"},     {Table::Samplers, "samplers"},
      {Table::Scenes, "scenes"},       {Table::Skins, "skins"},     {Table::Textures, "textures"}};
  for (const auto& [table, key] : kTables)
    if (const Json* list = check.array(root, key)) check.setTableSize(table, list->size());
}

/// `extras.burnish.fog`. Its numbers must be numbers in range: a scene without the fog that it asks for is another scene.
void parseFog(const At& at, Check& check, SceneSource& scene) {
  check.known(at, {"density", "falloff", "height", "albedo", "anisotropy", "start"});
  Fog& fog = scene.fog.emplace();
  fog.density = float(check.number(at, "density", 0, kNotNegative, Need::Required));
  fog.falloff = float(check.number(at, "falloff", 0, kNotNegative));
  fog.height = float(check.number(at, "height", 0));
  double albedo[3] = {1, 1, 1};
  if (check.numbers(at, "albedo", albedo, kUnit)) fog.albedo = {albedo[0], albedo[1], albedo[2]};
  fog.anisotropy = float(check.number(at, "anisotropy", 0, {-0.95, 0.95}));
  fog.start = float(check.number(at, "start", 0, kNotNegative));
}

/// `extras.burnish.sky`.
void parseSky(const At& at, Check& check, SceneSource& scene) {
  check.known(at, {"sun", "turbidity", "ground", "altitude"});
  if (!scene.environment.empty())
    check.fail(at, "the scene has an environment too", "keep one of sky and environment");
  Sky& sky = scene.sky.emplace();
  double sun[3] = {0, 0, 0}, ground[3] = {0.2, 0.2, 0.2};
  check.member(at, "sun", Need::Required);
  check.numbers(at, "sun", sun);
  if (check.ok() && sun[0] == 0 && sun[1] == 0 && sun[2] == 0)
    check.fail(at, "sun is no direction", "give a vector that points to the sun");
  check.numbers(at, "ground", ground, kUnit);
  sky.sun = {sun[0], sun[1], sun[2]};
  sky.ground = {ground[0], ground[1], ground[2]};
  sky.turbidity = float(check.number(at, "turbidity", 2.5, {1, 10}));
  sky.altitude = float(check.number(at, "altitude", 2, {1, 50000}));
}

void parseScenes(const At& root, Check& check, Document& doc) {
  check.eachObject(root, "scenes", [&](const At& at, std::size_t) {
    SceneSource& scene = doc.scenes.emplace_back();
    check.known(at, {"nodes"});
    if (const std::string* name = check.string(at, "name")) scene.name = *name;
    scene.nodes = check.references(at, "nodes", Table::Nodes);
    check.withOwnExtras(at, [&](const At& ours) {
      if (const std::string* file = check.string(ours, "environment")) scene.environment = *file;
      check.withObject(ours, "fog", [&](const At& fog) { parseFog(fog, check, scene); });
      check.withObject(ours, "sky", [&](const At& sky) { parseSky(sky, check, scene); });
    });
  });
  doc.scene = check.reference(root, "scene", Table::Scenes);
  if (doc.scene < 0 && !doc.scenes.empty()) doc.scene = 0;
}

}  // namespace

Document parseDocument(const Json& json, Check& check) {
  Document doc;
  const At root(json);
  if (!json.is_object()) {
    check.fail(root, "the file holds no JSON object");
    return doc;
  }
  parseExtensions(root, check);
  check.enter(root);
  parseAssetObject(root, check);
  countTables(root, check);
  doc.quantized = check.extensionsUsed.contains("KHR_mesh_quantization");
  for (const auto parse : {parseBuffers, parseMaterials, parseMeshes, parseNodes, parseScenes, parseAnimations})
    if (check.ok()) parse(root, check, doc);
  check.known(
      root, {"asset", "extensionsUsed", "extensionsRequired", "accessors", "animations", "buffers", "bufferViews",
             "cameras", "images", "materials", "meshes", "nodes", "samplers", "scene", "scenes", "skins", "textures"});
  return doc;
}

}  // namespace burnish::asset
