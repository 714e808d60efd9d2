// Meshes and their primitives: structure, semantics' names and references. Formats and counts are
// validate_meshes.cpp's.
#include <fmt/format.h>

#include <algorithm>

#include "asset/document.h"

namespace burnish::asset {
namespace {

// Names of attributes: glTF 2.0, section 3.7.2.1. Custom ones start with an underscore.
bool isIndexed(std::string_view name) {
  return name == "TEXCOORD" || name == "COLOR" || name == "JOINTS" || name == "WEIGHTS";
}

bool knownSemantic(std::string_view name, bool target) {
  if (name.starts_with('_') || name == "POSITION" || name == "NORMAL" || name == "TANGENT") return true;
  const std::size_t dash = name.find('_');
  if (dash == name.npos || !isIndexed(name.substr(0, dash))) return false;
  if (target && (name.starts_with("JOINTS") || name.starts_with("WEIGHTS"))) return false;
  const std::string_view digits = name.substr(dash + 1);
  return !digits.empty() && digits.size() <= 3 && digits.find_first_not_of("0123456789") == digits.npos &&
         (digits.size() == 1 || digits[0] != '0');
}

std::vector<Attribute> parseAttributes(const At& at, Check& check, bool target) {
  std::vector<Attribute> out;
  constexpr std::size_t kMost = 256;
  if (at->empty() || at->size() > kMost)
    check.fail(at, fmt::format("{} attributes (1 to {} are allowed)", at->size(), kMost));
  for (auto m = at->begin(); check.ok() && m != at->end(); ++m) {
    const At here(at, m.key(), m.value());
    if (!knownSemantic(m.key(), target))
      check.fail(here, "not an attribute's name", "prefix names of your own with an underscore");
    const int accessor = check.referenceValue(here, Table::Accessors);
    if (check.ok()) out.push_back({m.key(), accessor});
  }
  return out;
}

// TEXCOORD_0, TEXCOORD_1, ...: without gaps.
void checkContinuity(const At& at, Check& check, const PrimitiveSource& p) {
  for (const std::string_view family : {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"}) {
    const auto count = std::count_if(p.attributes.begin(), p.attributes.end(),
                                     [&](const Attribute& a) { return a.semantic.starts_with(family); });
    for (int i = 0; i < count; ++i)
      if (p.find(fmt::format("{}{}", family, i)) < 0)
        check.fail(at, fmt::format("there are {} {} attributes but no {}{}", count, family.substr(0, family.size() - 1),
                                   family, i));
  }
  const auto has = [&](const char* name) { return p.find(name) >= 0; };
  for (int i = 0; check.ok() && (has(fmt::format("JOINTS_{}", i).c_str()) || has(fmt::format("WEIGHTS_{}", i).c_str()));
       ++i)
    if (has(fmt::format("JOINTS_{}", i).c_str()) != has(fmt::format("WEIGHTS_{}", i).c_str()))
      check.fail(at, "the numbers of JOINTS and WEIGHTS attributes differ");
}

void parsePrimitive(const At& at, Check& check, MeshSource& mesh) {
  PrimitiveSource& p = mesh.primitives.emplace_back();
  check.known(at, {"attributes", "indices", "material", "mode", "targets"});
  const Json* attributes = check.object(at, "attributes", Need::Required);
  if (!attributes) return;
  const At here(at, "attributes", *attributes);
  p.attributes = parseAttributes(here, check, false);
  if (check.ok()) checkContinuity(here, check, p);
  p.indices = check.reference(at, "indices", Table::Accessors);
  p.material = check.reference(at, "material", Table::Materials);
  p.mode = int(check.integer(at, "mode", 4, 0, 6));
  const Json* targets = check.array(at, "targets");
  if (!targets) return;
  const At list(at, "targets", *targets);
  for (std::size_t i = 0; check.ok() && i < targets->size(); ++i) {
    const At target(list, i, (*targets)[i]);
    if (target->is_object())
      p.targets.push_back(parseAttributes(target, check, true));
    else
      check.fail(target, "a morph target is no object");
  }
}

// extras.targetNames, a convention of many writers: extras are free-form, so what is no list of that many strings is not
// one.
std::vector<std::string> targetNames(const At& mesh, std::size_t targets) {
  std::vector<std::string> names;
  const auto extras = mesh->find("extras");
  if (extras == mesh->end() || !extras->is_object()) return names;
  const auto list = extras->find("targetNames");
  if (list == extras->end() || !list->is_array() || list->size() != targets) return names;
  for (const Json& name : *list) names.push_back(name.is_string() ? name.get<std::string>() : std::string());
  return names;
}

void parseMesh(const At& at, Check& check, Document& doc) {
  MeshSource& mesh = doc.meshes.emplace_back();
  check.known(at, {"primitives", "weights"});
  if (const std::string* name = check.string(at, "name")) mesh.name = *name;
  check.eachObject(
      at, "primitives", [&](const At& p, std::size_t) { parsePrimitive(p, check, mesh); }, Need::Required);
  mesh.weights = check.numberList(at, "weights", 0);
  if (!check.ok()) return;
  const std::size_t targets = mesh.primitives[0].targets.size();
  for (std::size_t i = 1; i < mesh.primitives.size(); ++i)
    if (mesh.primitives[i].targets.size() != targets)
      check.fail(
          fmt::format("{}/primitives/{}", at.path(), i),
          fmt::format("{} morph targets where the first primitive has {}", mesh.primitives[i].targets.size(), targets));
  if (!mesh.weights.empty() && mesh.weights.size() != targets)
    check.fail(at.path() + "/weights", fmt::format("{} weights for {} morph targets", mesh.weights.size(), targets));
  mesh.targetNames = targetNames(at, targets);
}

}  // namespace

void parseMeshes(const At& root, Check& check, Document& doc) {
  check.eachObject(root, "meshes", [&](const At& at, std::size_t) { parseMesh(at, check, doc); });
}

}  // namespace burnish::asset
