// Cameras, lights, skins and nodes of a glTF file.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "asset/document.h"

namespace burnish::asset {
namespace {

void parsePerspective(const At& at, Check& check, Camera& c) {
  check.known(at, {"aspectRatio", "yfov", "zfar", "znear"});
  c.aspect = check.number(at, "aspectRatio", 0, kPositive);
  c.fovY = check.number(at, "yfov", 1, kPositive, Need::Required);
  c.near = check.number(at, "znear", 1, kPositive, Need::Required);
  c.far = check.number(at, "zfar", 0, kPositive);
  if (!check.ok()) return;
  if (c.far != 0 && c.far <= c.near) check.fail(at, fmt::format("zfar {} is not beyond znear {}", c.far, c.near));
  constexpr double kWidest = 3.1;  // radians; half of pi is where the tangent ends
  if (c.fovY > kWidest) {
    check.warn(at.path() + "/yfov", fmt::format("field of view {} is too wide, {} radians are used", c.fovY, kWidest));
    c.fovY = kWidest;
  }
}

void parseOrthographic(const At& at, Check& check, Camera& c) {
  check.known(at, {"xmag", "ymag", "zfar", "znear"});
  c.orthographic = true;
  const double xmag = check.number(at, "xmag", 1, {}, Need::Required);
  c.ymag = check.number(at, "ymag", 1, {}, Need::Required);
  c.near = check.number(at, "znear", 0, kNotNegative, Need::Required);
  c.far = check.number(at, "zfar", 1, kPositive, Need::Required);
  if (!check.ok()) return;
  for (const auto& [key, value] : {std::pair("xmag", xmag), std::pair("ymag", c.ymag)}) {
    if (value == 0) check.fail(at.path() + "/" + key, "the magnification is zero");
    if (value < 0) check.warn(at.path() + "/" + key, "the magnification is negative: its absolute value is used");
  }
  if (c.far <= c.near) check.fail(at, fmt::format("zfar {} is not beyond znear {}", c.far, c.near));
  c.aspect = std::min(std::abs(xmag / c.ymag), double(std::numeric_limits<float>::max()));
  c.ymag = std::abs(c.ymag);
}

void parseCamera(const At& at, Check& check, Document& doc) {
  Camera& c = doc.cameras.emplace_back();
  check.known(at, {"type", "perspective", "orthographic"});
  if (const std::string* name = check.string(at, "name")) c.name = *name;
  const std::string* type = check.string(at, "type", Need::Required);
  if (!type) return;
  const bool perspective = at->contains("perspective"), orthographic = at->contains("orthographic");
  if (perspective == orthographic) return check.fail(at, "exactly one of perspective and orthographic must be given");
  if (*type != (perspective ? "perspective" : "orthographic"))
    return check.fail(at.path() + "/type", fmt::format("type '{}' does not match the camera", type->substr(0, 40)));
  check.withObject(at, "perspective", [&](const At& p) { parsePerspective(p, check, c); });
  check.withObject(at, "orthographic", [&](const At& o) { parseOrthographic(o, check, c); });
}

/// `extras.burnish` of a light: shadow (true or false), sourceRadius (m), angularDiameter (rad). A fault in it is a warning, for extras are free-form.
void parseLightExtras(const At& at, Check& check, Light& l) {
  check.withOwnExtras(at, [&](const At& ours) {
    if (const auto shadow = ours->find("shadow"); shadow != ours->end()) {
      if (shadow->is_boolean())
        l.shadow = shadow->get<bool>();
      else
        check.warn(At(ours, "shadow", *shadow).path(), fmt::format("{} where true or false is expected: it is left out", shadow->type_name()));
    }
    for (const auto& [key, into] : {std::pair("sourceRadius", &l.sourceRadius), std::pair("angularDiameter", &l.angularDiameter)}) {
      const auto found = ours->find(key);
      if (found == ours->end()) continue;
      const double value = found->is_number() ? found->get<double>() : -1;
      if (value >= 0 && value <= 1e6)
        *into = float(value);
      else
        check.warn(At(ours, key, *found).path(), "no number from 0 to 1e6: it is left out");
    }
  });
}

// KHR_lights_punctual
void parseLight(const At& at, Check& check, Document& doc) {
  Light& l = doc.lights.emplace_back();
  check.known(at, {"color", "intensity", "type", "range", "spot"});
  if (const std::string* name = check.string(at, "name")) l.name = *name;
  std::array<double, 3> color{1, 1, 1};
  check.numbers(at, "color", color, kNotNegative);
  l.color = {float(color[0]), float(color[1]), float(color[2])};
  l.intensity = float(check.number(at, "intensity", 1, kNotNegative));
  l.range = float(check.number(at, "range", 0, kPositive));
  parseLightExtras(at, check, l);
  const std::string* type = check.string(at, "type", Need::Required);
  if (!type) return;
  if (*type == "directional" || *type == "point") {
    l.kind = *type == "point" ? Light::Kind::Point : Light::Kind::Directional;
  } else if (*type == "spot") {
    l.kind = Light::Kind::Spot;
    constexpr double kHalfPi = std::numbers::pi / 2;
    check.withObject(
        at, "spot",
        [&](const At& s) {
          check.known(s, {"innerConeAngle", "outerConeAngle"});
          const double inner = check.number(s, "innerConeAngle", 0, Range{0, kHalfPi + 1e-6});
          const double outer = check.number(s, "outerConeAngle", std::numbers::pi / 4, Range{0, kHalfPi + 1e-6, true});
          if (check.ok() && inner >= outer)
            check.fail(s, fmt::format("inner cone {} is not inside outer cone {}", inner, outer));
          l.innerCone = float(inner);
          l.outerCone = float(std::min(outer, kHalfPi));
        },
        Need::Required);
  } else {
    check.fail(at.path() + "/type", fmt::format("unknown kind of light '{}'", type->substr(0, 40)));
  }
}

// Unit quaternion, translation and scale to a matrix: glTF 2.0, section 3.5.3.
void parseTrs(const At& at, Check& check, NodeSource& n) {
  std::array<double, 3> t{0, 0, 0}, s{1, 1, 1};
  std::array<double, 4> q{0, 0, 0, 1};
  check.numbers(at, "translation", t);
  check.numbers(at, "scale", s);
  check.numbers(at, "rotation", q, Range{-1, 1});
  if (!check.ok()) return;
  const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  if (length < 1e-6) return check.fail(at.path() + "/rotation", "the quaternion is zero");
  if (std::abs(length - 1) > 1e-3)
    check.warn(at.path() + "/rotation", "the quaternion is not of unit length: it is normalized");
  n.translation = {t[0], t[1], t[2]};
  n.rotation = glm::dquat(q[3] / length, q[0] / length, q[1] / length, q[2] / length);
  n.scale = {s[0], s[1], s[2]};
  const glm::dmat3 rotation = glm::mat3_cast(n.rotation);
  for (int c = 0; c < 3; ++c) n.local[c] = glm::dvec4(rotation[c] * s[std::size_t(c)], 0);
  n.local[3] = glm::dvec4(t[0], t[1], t[2], 1);
}

void parseMatrix(const At& at, Check& check, NodeSource& n) {
  std::array<double, 16> m{};
  if (!check.numbers(at, "matrix", m)) return;
  for (const char* key : {"translation", "rotation", "scale"})
    if (at->contains(key)) check.fail(at.path() + "/matrix", fmt::format("a node has either a matrix or a {}", key));
  n.hasMatrix = true;
  for (std::size_t i = 0; i < 16; ++i) n.local[int(i / 4)][int(i % 4)] = m[i];
  for (int c = 0; c < 4; ++c)
    if (std::abs(n.local[c][3] - (c == 3)) > 1e-6)
      check.fail(at.path() + "/matrix", "the matrix is not affine (its last row is not 0, 0, 0, 1)");
  for (int c = 0; c < 4; ++c) n.local[c][3] = c == 3;
}

void parseNode(const At& at, Check& check, Document& doc) {
  NodeSource& n = doc.nodes.emplace_back();
  check.known(at, {"camera", "children", "skin", "matrix", "mesh", "rotation", "scale", "translation", "weights"});
  if (const std::string* name = check.string(at, "name")) n.name = *name;
  n.camera = check.reference(at, "camera", Table::Cameras);
  n.mesh = check.reference(at, "mesh", Table::Meshes);
  n.skin = check.reference(at, "skin", Table::Skins);
  n.children = check.references(at, "children", Table::Nodes);
  n.weights = check.numberList(at, "weights", 0);
  if (check.ok() && n.mesh < 0)
    for (const char* key : {"skin", "weights"})
      if (at->contains(key)) check.fail(at.path() + "/" + key, fmt::format("a node with {} needs a mesh", key));
  if (at->contains("matrix"))
    parseMatrix(at, check, n);
  else
    parseTrs(at, check, n);
  check.withExtension(at, "KHR_lights_punctual", [&](const At& e) {
    check.known(e, {"light"});
    n.light = check.reference(e, "light", Table::Lights, Need::Required);
  });
  parseProbes(at, check, n);
}

void parseSkin(const At& at, Check& check, Document& doc) {
  SkinSource& s = doc.skins.emplace_back();
  check.known(at, {"inverseBindMatrices", "skeleton", "joints"});
  if (const std::string* name = check.string(at, "name")) s.name = *name;
  s.joints = check.references(at, "joints", Table::Nodes, Need::Required);
  s.skeleton = check.reference(at, "skeleton", Table::Nodes);
  s.inverseBindMatrices = check.reference(at, "inverseBindMatrices", Table::Accessors);
}

}  // namespace

void parseNodes(const At& root, Check& check, Document& doc) {
  check.withExtension(root, "KHR_lights_punctual", [&](const At& e) {
    check.known(e, {"lights"});
    if (const Json* list = check.array(e, "lights", Need::Required)) check.setTableSize(Table::Lights, list->size());
    check.eachObject(e, "lights", [&](const At& at, std::size_t) { parseLight(at, check, doc); });
  });
  check.eachObject(root, "cameras", [&](const At& at, std::size_t) { parseCamera(at, check, doc); });
  check.eachObject(root, "skins", [&](const At& at, std::size_t) { parseSkin(at, check, doc); });
  check.eachObject(root, "nodes", [&](const At& at, std::size_t) { parseNode(at, check, doc); });
}

}  // namespace burnish::asset
