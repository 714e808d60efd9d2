// Places of probes in glTF files: extras, names, transforms, and values that are none.
#include "gltf_fixture.h"
#include "scene/load.h"

using namespace gltf_test;
using burnish::AmbientGrid;
using burnish::ReflectionProbe;
using burnish::Scene;
using glm::dvec3;

namespace {

Json file(Json nodes) {
  Json roots = Json::array();
  std::set<std::size_t> children;
  for (const Json& n : nodes)
    if (n.contains("children"))
      for (const Json& c : n["children"]) children.insert(c.get<std::size_t>());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!children.contains(i)) roots.push_back(i);
  return {{"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", roots}}}}, {"nodes", std::move(nodes)}};
}
Json with(const char* key, Json value, Json node = Json::object()) {
  node["extras"]["burnish"][key] = std::move(value);
  return node;
}
Reading readNodes(Json nodes) {
  const Sandbox box;
  return read(box.put("file.gltf", file(std::move(nodes)).dump()));
}

struct Loaded {
  Scene scene;
  Report report;
  [[nodiscard]] int warned(std::string_view text) const {
    int count = 0;
    for (const auto& w : report.warnings()) count += w.message().find(text) != std::string::npos;
    return count;
  }
};
Loaded load(Json nodes) {
  Reading r = readNodes(std::move(nodes));
  INFO(r.message());
  REQUIRE(r.asset);
  Loaded out;
  out.report = r.report;
  const burnish::scene::Deadline deadline(0);
  auto scene = burnish::scene::importAsset(std::move(*r.asset), deadline, out.report);
  REQUIRE(scene);
  out.scene = std::move(*scene);
  return out;
}
bool near(dvec3 a, dvec3 b, double by = 1e-12) { return glm::length(a - b) <= by; }

/// Whether the probe's box is the box around `center` with these corners' half edges (columns), in any order and direction of axes.
bool sameBox(const ReflectionProbe& p, dvec3 center, glm::dmat3 half, double by = 1e-9) {
  if (!near(p.center, center, by)) return false;
  for (int k = 0; k < 3; ++k) {
    bool found = false;
    for (int j = 0; j < 3; ++j) found = found || near(p.axes[j] * p.halfSize[j], half[k], by) || near(p.axes[j] * p.halfSize[j], -half[k], by);
    if (!found) return false;
  }
  return near(glm::cross(p.axes[0], p.axes[1]), p.axes[2], 1e-9);
}

}  // namespace

TEST_CASE("a node with extras.burnish.probe is a place of a reflection probe", "[gltf][probe]") {
  const Loaded l = load({{{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}}},
                         with("probe", {{"box_half_size", {4, 2.1, 6}}, {"capture", {1, 0.5, -2}}, {"fade", 0.7}, {"margin", 0.1}}, {{"name", "hall"}, {"translation", {0, 2, 1}}, {"scale", {1, 1, 2}}})});
  CHECK(l.report.empty());
  REQUIRE(l.scene.probes.reflections.size() == 1);
  CHECK(l.scene.probes.revision > 0);
  const ReflectionProbe& p = l.scene.probes.reflections[0];
  CHECK(p.name == "hall");
  // A quarter turn about +Y takes z to x and x to -z.
  CHECK(sameBox(p, {11, 2, 0}, glm::dmat3(dvec3(0, 0, -4), dvec3(0, 2.1, 0), dvec3(12, 0, 0))));
  CHECK(near(p.capture, {11 - 4, 2.5, -1}, 1e-9));
  CHECK(p.fade == dvec3(0.7));
  CHECK(p.margin == 0.1);
  CHECK(p.radiance.levels.empty());
}

TEST_CASE("what a probe's extras leave out", "[gltf][probe]") {
  const Loaded l = load({with("probe", Json::object(), {{"scale", {3, 2, 1}}}), with("probe", {{"fade", {0.1, 0.2, 0}}, {"capture", {5, 0, 0}}}, {{"name", "odd"}})});
  REQUIRE(l.scene.probes.reflections.size() == 2);
  const ReflectionProbe& p = l.scene.probes.reflections[0];
  CHECK(sameBox(p, dvec3(0), glm::dmat3(dvec3(3, 0, 0), dvec3(0, 2, 0), dvec3(0, 0, 1))));
  CHECK(p.capture == dvec3(0));
  CHECK(p.fade == ReflectionProbe{}.fade);
  CHECK(p.margin == ReflectionProbe{}.margin);
  CHECK(l.scene.probes.reflections[1].fade == dvec3(0.1, 0.2, 0));
  CHECK(l.scene.probes.reflections[1].capture == dvec3(0));
  CHECK(l.warned("file.gltf: node 'odd': the point of its capture lies outside its box") == 1);
}

TEST_CASE("a lattice by its spacing and by its counts", "[gltf][probe]") {
  const Loaded l = load({with("probe_grid", {{"half_size", {3, 1, 2}}, {"spacing", {1.5, 0.8, 4}}, {"margin", 0.5}}, {{"translation", {1, 2, 3}}, {"name", "a"}})});
  CHECK(l.report.empty());
  REQUIRE(l.scene.probes.grid);
  const AmbientGrid& g = *l.scene.probes.grid;
  CHECK(g.name == "a");
  CHECK(g.counts == glm::ivec3(5, 4, 2));
  CHECK(near(g.spacing, {1.5, 2.0 / 3, 4}));
  CHECK(near(g.position({0, 0, 0}), {-2, 1, 1}, 1e-9));
  CHECK(near(g.position({4, 3, 1}), {4, 3, 5}, 1e-9));
  CHECK(g.margin == 0.5);
  CHECK(g.points.empty());
  const Loaded c = load({with("probe_grid", {{"half_size", {1, 1, 1}}, {"counts", {3, 1, 2}}}, {{"scale", {2, 5, 4}}})});
  REQUIRE(c.scene.probes.grid);
  CHECK(c.scene.probes.grid->counts == glm::ivec3(3, 1, 2));
  CHECK(near(c.scene.probes.grid->position({0, 0, 0}), {-2, 0, -4}, 1e-9));
  CHECK(near(c.scene.probes.grid->position({2, 0, 1}), {2, 0, 4}, 1e-9));
  CHECK(c.scene.probes.grid->margin == AmbientGrid{}.margin);
}

TEST_CASE("a scene has one lattice", "[gltf][probe]") {
  const Loaded l = load({with("probe_grid", Json::object(), {{"name", "first"}}), with("probe_grid", Json::object(), {{"name", "second"}})});
  REQUIRE(l.scene.probes.grid);
  CHECK(l.scene.probes.grid->name == "first");
  CHECK(l.warned("2 nodes ask for a lattice") == 1);
}

TEST_CASE("a spacing that makes too many points is enlarged", "[gltf][probe]") {
  const Loaded l = load({with("probe_grid", {{"half_size", {1000, 1000, 1000}}, {"spacing", 0.001}}, {{"name", "fine"}})});
  REQUIRE(l.scene.probes.grid);
  const glm::dvec3 n(l.scene.probes.grid->counts);
  CHECK(n.x * n.y * n.z <= 1 << 20);
  CHECK(n.x * n.y * n.z > (1 << 20) * 0.8);
  CHECK(l.warned("node 'fine': its spacing makes more than 1048576 points") == 1);
}

TEST_CASE("empty nodes by the names that artists give probes", "[gltf][probe]") {
  for (const char* name : {"probe_hall", "Probe.001", "Probe_kitchen", "ReflectionProbe", "ReflectionProbe.002", "Reflection_Probe 3", "ReflectionCubemap", "LightProbe", "light_probe_7"}) {
    INFO(name);
    const Loaded l = load({{{"name", name}, {"scale", {2, 3, 4}}, {"translation", {0, 1, 0}}}});
    REQUIRE(l.scene.probes.reflections.size() == 1);
    CHECK(sameBox(l.scene.probes.reflections[0], {0, 1, 0}, glm::dmat3(dvec3(2, 0, 0), dvec3(0, 3, 0), dvec3(0, 0, 4))));
    CHECK(!l.scene.probes.grid);
  }
  for (const char* name : {"IrradianceVolume", "IrradianceVolume.001", "irradiance_volume"}) {
    INFO(name);
    const Loaded l = load({{{"name", name}, {"scale", {2, 3, 4}}}});
    CHECK(l.scene.probes.reflections.empty());
    REQUIRE(l.scene.probes.grid);
    CHECK(l.scene.probes.grid->counts == glm::ivec3(5, 7, 9));  // every metre
  }
  for (const char* name : {"probe", "prober", "my_probe_hall", "Problem.001", "Reflection", "Irradiance", ""}) {
    INFO(name);
    const Loaded l = load({{{"name", name}}});
    CHECK(l.scene.probes.reflections.empty());
    CHECK(!l.scene.probes.grid);
    CHECK(l.scene.probes.revision == 0);
  }
}

TEST_CASE("a name counts only on an empty node, and extras have the last word", "[gltf][probe]") {
  MeshFile f;
  f.positions(3);
  f.json["nodes"] = {{{"name", "probe_thermometer"}, {"mesh", 0}}, {{"name", "probe_arm"}}};
  const Sandbox box;
  f.json["scenes"] = {{{"nodes", {0, 1}}}};
  const Reading r = f.readIn(box);
  INFO(r.message());
  REQUIRE(r.asset);
  CHECK(!r.asset->nodes[0].probe);
  CHECK(r.asset->nodes[1].probe);
  const Loaded l = load({with("probe", false, {{"name", "probe_no"}}), with("probe_grid", Json::object(), {{"name", "LightProbe"}}), with("probe", Json::object(), {{"name", "IrradianceVolume"}})});
  CHECK(l.scene.probes.reflections.size() == 1);
  CHECK(l.scene.probes.reflections[0].name == "IrradianceVolume");
  REQUIRE(l.scene.probes.grid);
  CHECK(l.scene.probes.grid->name == "LightProbe");
}

TEST_CASE("mirrored transforms keep the box, skewed ones come near it, flat ones have none", "[gltf][probe]") {
  const Json half = {{"box_half_size", {1, 2, 3}}, {"capture", {0.5, 0, 0}}};
  const Loaded mirrored = load({with("probe", half, {{"scale", {-2, 1, 1}}})});
  CHECK(mirrored.report.empty());
  REQUIRE(mirrored.scene.probes.reflections.size() == 1);
  CHECK(sameBox(mirrored.scene.probes.reflections[0], dvec3(0), glm::dmat3(dvec3(2, 0, 0), dvec3(0, 2, 0), dvec3(0, 0, 3))));
  CHECK(near(mirrored.scene.probes.reflections[0].capture, {-1, 0, 0}));
  // Turned by 45 degrees in a parent that is twice as long along x: axes of 63.4 degrees.
  const Json parent = {{"children", {1}}, {"scale", {2, 1, 1}}};
  Json child = with("probe", half, {{"name", "skew"}, {"rotation", {0, 0, std::sin(M_PI / 8), std::cos(M_PI / 8)}}});
  const Loaded skewed = load({parent, child, child});
  CHECK(skewed.warned("node 'skew': its transform skews the probe's box") == 1);
  CHECK(skewed.warned("skew") == 1);
  REQUIRE(skewed.scene.probes.reflections.size() == 2);
  const ReflectionProbe& p = skewed.scene.probes.reflections[0];
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) CHECK(glm::dot(p.axes[a], p.axes[b]) == Approx(a == b ? 1 : 0).margin(1e-12));
  CHECK(glm::determinant(p.axes) == Approx(1));
  // The two axes lean by the same angle to either side of the true ones.
  const dvec3 x = glm::normalize(dvec3(2, 1, 0)), y = glm::normalize(dvec3(-2, 1, 0));
  CHECK(glm::dot(p.axes[0], x) == Approx(glm::dot(p.axes[1], y)));
  const Loaded flat = load({with("probe", half, {{"name", "flat"}, {"scale", {1, 0, 1}}}), with("probe_grid", Json::object(), {{"name", "flat grid"}, {"scale", {0, 0, 0}}}),
                            with("probe", half, {{"name", "shear"}, {"matrix", {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}),
                            with("probe", half, {{"name", "huge"}, {"scale", {1e20, 1, 1}}})});
  CHECK(flat.scene.probes.reflections.empty());
  CHECK(!flat.scene.probes.grid);
  CHECK(flat.warned("node 'flat': its transform makes the probe's box flat or endless: the probe is left out (and 3 more like it)") == 1);
}

TEST_CASE("values that are none are errors that name their place", "[gltf][probe]") {
  const auto refused = [](const char* key, const Json& value, const std::string& where) {
    const Reading r = readNodes({with(key, value)});
    INFO(value.dump());
    CHECK_FALSE(r.asset);
    INFO(r.message());
    CHECK(r.message().find("/nodes/0/extras/burnish/" + std::string(key) + where) != std::string::npos);
  };
  refused("probe", 3, "");
  refused("probe", true, "");
  refused("probe", Json::array({1, 2, 3}), "");
  refused("probe", {{"box_half_size", 3}}, "/box_half_size");
  refused("probe", {{"box_half_size", {1, 2}}}, "/box_half_size");
  refused("probe", {{"box_half_size", {1, 2, 0}}}, "/box_half_size");
  refused("probe", {{"box_half_size", {1, -2, 3}}}, "/box_half_size");
  refused("probe", {{"box_half_size", {1, 1e300, 3}}}, "/box_half_size");
  refused("probe", {{"box_half_size", {1, nullptr, 3}}}, "/box_half_size");
  refused("probe", {{"box_half_size", "large"}}, "/box_half_size");
  refused("probe", {{"capture", {1, 2}}}, "/capture");
  refused("probe", {{"capture", {1, 2, 1e40}}}, "/capture");
  refused("probe", {{"fade", -1}}, "/fade");
  refused("probe", {{"fade", {1, 1, "x"}}}, "/fade");
  refused("probe", {{"fade", "soft"}}, "/fade");
  refused("probe", {{"margin", -0.1}}, "/margin");
  refused("probe", {{"margin", {1}}}, "/margin");
  refused("probe_grid", 1, "");
  refused("probe_grid", {{"half_size", {0, 1, 1}}}, "/half_size");
  refused("probe_grid", {{"spacing", 0}}, "/spacing");
  refused("probe_grid", {{"spacing", {1, 1, -1}}}, "/spacing");
  refused("probe_grid", {{"counts", {0, 1, 1}}}, "/counts");
  refused("probe_grid", {{"counts", {1.5, 1, 1}}}, "/counts");
  refused("probe_grid", {{"counts", {1024, 1024, 2}}}, "/counts");
  refused("probe_grid", {{"counts", {1e300, 1, 1}}}, "/counts");
  refused("probe_grid", {{"counts", 4}}, "/counts");
  refused("probe_grid", {{"counts", {2, 2, 2}}, {"spacing", 1}}, "");
  // What nobody knows is a warning; extras of others are theirs.
  const Reading odd = readNodes({with("probe", {{"boxHalfSize", {1, 1, 1}}})});
  REQUIRE(odd.asset);
  CHECK(odd.warned("/nodes/0/extras/burnish/probe/boxHalfSize"));
  CHECK(readNodes({{{"extras", {{"probe", 3}, {"other", {{"probe", 4}}}}}}}).asset);
}
