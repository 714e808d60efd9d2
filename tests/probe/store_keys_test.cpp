// Keys change with what a capture's bytes depend on, and with nothing else.
#include "probe/bounce.h"
#include "probe/geometry.h"
#include "probe/keys.h"
#include "probe/visibility.h"
#include "store_scene.h"

using namespace store_test;

namespace {

struct Setup {
  Rooms rooms = twoRooms();
  BakeOptions options = smallBake();
  Capabilities capabilities;
  std::vector<core::Hash128> before;

  std::vector<core::Hash128> keys() {
    Report report;
    const auto geometry = probe::Geometry::create(rooms.scene, &report);
    REQUIRE(geometry);
    ProbeSet places = rooms.scene.probes;
    if (places.grid->points.empty()) REQUIRE(probe::fillPoints(*geometry, *places.grid, 1));
    return probe::Keys::make(rooms.scene, *geometry, places, options, capabilities).ofBounce(before);
  }
};

/// Capture points: reflection probes 0, 1 in the red room and 2, 3 in the blue one; points of the lattice have x fastest, so that rooms alternate from row to row.
bool inRoom(std::size_t point, int room) {
  if (point < 4) return int(point / 2) == room;
  return int((point - 4) % 5 >= 2) == room;  // of each row two in the red room, three in the blue one
}

enum class Touches { Nothing, Red, Blue, All };

void check(const std::string& what, Touches touches, const std::function<void(Setup&)>& change, const std::function<void(Setup&)>& prepare = {}) {
  Setup a, b;
  if (prepare) prepare(a), prepare(b);
  change(b);
  const auto before = a.keys(), after = b.keys();
  REQUIRE(before.size() == 14);
  REQUIRE(after.size() == 14);
  for (std::size_t i = 0; i < before.size(); ++i) {
    INFO(what << ", point " << i);
    const bool expected = touches == Touches::All || (touches == Touches::Red && inRoom(i, 0)) || (touches == Touches::Blue && inRoom(i, 1));
    CHECK((before[i] != after[i]) == expected);
  }
}

void fillContents(Setup& s) {
  for (std::uint64_t i = 0; i < 14; ++i) s.before.push_back({1, i});
}
Id<Node> nodeAt(Scene& scene, glm::dvec3 at) {
  glm::dmat4 local(1);
  local[3] = glm::dvec4(at, 1);
  return scene.nodes.add({"", {}, local});
}

}  // namespace

TEST_CASE("Keys of all points are different, and the same from run to run", "[probe][store]") {
  Setup a, b;
  auto keys = a.keys();
  CHECK(keys == b.keys());
  std::sort(keys.begin(), keys.end());
  CHECK(std::adjacent_find(keys.begin(), keys.end()) == keys.end());
}

TEST_CASE("Changes in a room touch its points", "[probe][store]") {
  check("lamp", Touches::Red, [](Setup& s) { s.rooms.scene.lights.edit(s.rooms.lamps[0])->intensity *= 1.01f; });
  check("lamp's place", Touches::Blue, [](Setup& s) { s.rooms.scene.nodes.edit(s.rooms.scene.lights.get(s.rooms.lamps[1])->node)->local[3].y += 0.01; });
  check("lamp off", Touches::Blue, [](Setup& s) { s.rooms.scene.lights.edit(s.rooms.lamps[1])->enabled = false; });
  check("lamp that reaches both", Touches::All, [](Setup& s) { s.rooms.scene.lights.edit(s.rooms.lamps[0])->range = 30; });
  check("albedo", Touches::Red, [](Setup& s) { s.rooms.scene.materials.edit(s.rooms.walls[0])->albedo.x = 0.1f; });
  check("roughness", Touches::Blue, [](Setup& s) { s.rooms.scene.materials.edit(s.rooms.table[1])->roughness = 0.41f; });
  check("emission", Touches::Blue, [](Setup& s) { s.rooms.scene.materials.edit(s.rooms.table[1])->emission = glm::vec3(1); });
  check("map", Touches::Red, [](Setup& s) { s.rooms.scene.materials.edit(s.rooms.table[0])->mapA = s.rooms.scene.textures.add({.image = makeImage(1, 1, 4, PixelType::U8)}); });
  check("table", Touches::Red, [](Setup& s) { s.rooms.scene.nodes.edit(s.rooms.tables[0])->local[3].x -= 0.1; });
  check("mesh of both tables", Touches::All, [](Setup& s) {
    s.rooms.scene.instances.each([&](Id<Instance>, const Instance& i) {
      if (i.node == s.rooms.tables[0]) s.rooms.scene.meshes.edit(i.mesh)->positions[3].x += 0.01f;
    });
  });
  check("box of a probe", Touches::Blue, [](Setup& s) { s.rooms.scene.probes.reflections[3].halfSize.y = 1.6; });
  // Under a lamp that another thing hides a caster counts, seen or not.
  check("shadows", Touches::Red, [](Setup& s) { s.rooms.scene.lights.edit(s.rooms.lamps[0])->castsShadow = false; });
}

TEST_CASE("What lights a room in the bounce before touches its points", "[probe][store]") {
  check("first bounce or a later one", Touches::All, fillContents);
  check("a probe's light", Touches::Red, [](Setup& s) { s.before[1].low = 77; }, fillContents);
  check("a probe's light", Touches::Blue, [](Setup& s) { s.before[2].low = 77; }, fillContents);
  check("light of the lattice", Touches::Red, [](Setup& s) { s.before[5].low = 77; }, fillContents);
  check("light of the lattice", Touches::Blue, [](Setup& s) { s.before[13].low = 77; }, fillContents);
  const auto foggy = [](Setup& s) { fillContents(s), s.rooms.scene.fog.density = 0.01f; };
  check("a probe's light in fog", Touches::All, [](Setup& s) { s.before[1].low = 77; }, foggy);
}

TEST_CASE("Some changes touch everything", "[probe][store]") {
  check("environment", Touches::All, [](Setup& s) { s.rooms.scene.environment.color.z = 0.5f; });
  check("fog", Touches::All, [](Setup& s) { s.rooms.scene.fog.density = 0.01f; });
  check("rung", Touches::All, [](Setup& s) { s.options.quality.diffuse = Diffuse::Lambert; });
  check("shadows' resolution", Touches::All, [](Setup& s) { s.options.quality.shadowResolution = 512; });
  check("lobe", Touches::All, [](Setup& s) { s.options.lobe = ReflectionLobe::Ggx; });
  check("size", Touches::All, [](Setup& s) { s.options.size = 32; });
  check("albedo limit", Touches::All, [](Setup& s) { s.options.albedoLimit = 0.9; });
  check("renderer", Touches::All, [](Setup& s) { s.capabilities.renderer = "another"; });
  check("spacing", Touches::All, [](Setup& s) { s.rooms.scene.probes.grid->margin = 0.3; });
  const auto sunny = [](Setup& s) { s.rooms.scene.lights.add({.kind = LightKind::Directional, .node = nodeAt(s.rooms.scene, {}), .castsShadow = true}); };
  check("sun", Touches::All, sunny);
  check("a thing that moves under a sun", Touches::All, [](Setup& s) { s.rooms.scene.nodes.edit(s.rooms.tables[0])->local[3].x -= 0.1; }, sunny);
  const auto crowded = [](Setup& s) { s.options.quality.shadowMaps = 4; };
  check("a lamp among too many", Touches::All, [](Setup& s) { s.rooms.scene.lights.edit(s.rooms.lamps[0])->intensity = 3; }, crowded);
}

TEST_CASE("Names, the picture's settings and what nobody sees touch nothing", "[probe][store]") {
  check("names", Touches::Nothing, [](Setup& s) {
    Scene& scene = s.rooms.scene;
    scene.name = "x";
    scene.materials.edit(s.rooms.walls[0])->name = scene.lights.edit(s.rooms.lamps[1])->name = scene.probes.reflections[0].name = scene.probes.grid->name = "x";
  });
  check("revisions", Touches::Nothing, [](Setup& s) { s.rooms.scene.meshes.edit(s.rooms.scene.meshes.at(0)), ++s.rooms.scene.environment.revision, ++s.rooms.scene.probes.revision; });
  check("picture", Touches::Nothing, [](Setup& s) {
    s.options.quality.toneMap = ToneMap::AgX, s.options.quality.exposureEv = 4, s.options.quality.bloom = Bloom::Scatter, s.options.quality.antialiasing = Antialiasing::Edge, s.options.quality.occlusion = Occlusion::Screen16;
  });
  check("stopping and threads", Touches::Nothing, [](Setup& s) { s.options.bounces = 9, s.options.until = 0.5, s.options.threads = 3; });
  check("cameras", Touches::Nothing, [](Setup& s) { s.rooms.scene.cameras.add({}); });
  check("a thing in the dark between the rooms", Touches::Nothing, [](Setup& s) {
    const Id<Node> node = nodeAt(s.rooms.scene, {10, 1, 1.5});
    for (int i = 0; i < 3; ++i) s.rooms.scene.nodes.edit(node)->local[i] *= 0.05;
    s.rooms.scene.instances.add({.node = node, .mesh = s.rooms.scene.instances.get(s.rooms.scene.instances.at(1))->mesh, .material = s.rooms.table[0]});
  });
  check("what is not shown", Touches::Nothing, [](Setup& s) {
    s.rooms.scene.instances.add({.node = nodeAt(s.rooms.scene, {0.2, 0, 0}), .mesh = s.rooms.scene.instances.get(s.rooms.scene.instances.at(1))->mesh, .material = s.rooms.table[0], .visible = false});
  });
  check("materials that nothing has", Touches::Nothing, [](Setup& s) { s.rooms.scene.materials.add({}); });
}

TEST_CASE("The size of the lattice's captures touches the lattice alone", "[probe][store]") {
  Setup a, b;
  b.options.ambientSize = 32;
  const auto before = a.keys(), after = b.keys();
  for (std::size_t i = 0; i < before.size(); ++i) CHECK((before[i] != after[i]) == (i >= 4));
}
