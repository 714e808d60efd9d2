// Hierarchies, bounds and the validation of meshes.
#include <burnish/scene.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/transforms.h"
#include "scene/visibility.h"

using namespace burnish;

namespace {

Mesh triangle() {
  Mesh m;
  m.name = "triangle";
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  m.normals.assign(3, {0, 0, 1});
  m.indices = {0, 1, 2};
  return m;
}

glm::dmat4 moved(double x) { return glm::translate(glm::dmat4(1), glm::dvec3(x, 0, 0)); }

bool mentions(const Report& report, std::string_view text) {
  for (const Warning& w : report.warnings())
    if (w.message().find(text) != std::string::npos) return true;
  return false;
}

const float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

}  // namespace

TEST_CASE("World matrices multiply from the root down", "[scene]") {
  Scene s;
  const auto root = s.nodes.add({"root", {}, glm::rotate(glm::dmat4(1), M_PI / 2, glm::dvec3(0, 0, 1))});
  const auto child = s.nodes.add({"child", root, moved(2)});
  const glm::dvec4 p = s.world(child) * glm::dvec4(0, 0, 0, 1);
  CHECK(p.x == Approx(0).margin(1e-12));
  CHECK(p.y == Approx(2));
  CHECK(scene::worldMatrices(s)[child.index] == s.world(child));
  CHECK(s.world({}) == glm::dmat4(1));
}

TEST_CASE("Far from the origin a world matrix keeps millimetres", "[scene]") {
  Scene s;
  const auto a = s.nodes.add({"a", {}, moved(1e6)});
  const auto b = s.nodes.add({"b", a, moved(0.001)});
  CHECK(s.world(b)[3][0] - 1e6 == Approx(0.001).margin(1e-9));
}

TEST_CASE("Hierarchies 100,000 nodes deep neither overflow nor crawl", "[scene]") {
  constexpr int kDepth = 100000;
  Scene s;
  Id<Node> last;
  for (int i = 0; i < kDepth; ++i) last = s.nodes.add({"", last, moved(1)});
  CHECK(s.world(last)[3][0] == kDepth);
  const auto all = scene::worldMatrices(s);
  CHECK(all[last.index][3][0] == kDepth);
  s.instances.add({"", last, s.meshes.add(triangle()), {}});
  CHECK(s.bounds().max.x == Approx(kDepth + 1));
}

TEST_CASE("The same depth with the leaves first", "[scene]") {
  constexpr int kDepth = 100000;
  Scene s;
  for (int i = 0; i < kDepth; ++i) s.nodes.add({"", {}, moved(1)});
  for (int i = 0; i + 1 < kDepth; ++i) s.nodes.edit({std::uint32_t(i), 0})->parent = {std::uint32_t(i + 1), 0};
  CHECK(scene::worldMatrices(s)[0][3][0] == kDepth);
}

TEST_CASE("Cycles are cut", "[scene]") {
  Scene s;
  const auto a = s.nodes.add({"a", {}, moved(1)});
  const auto b = s.nodes.add({"b", a, moved(10)});
  const auto tail = s.nodes.add({"tail", b, moved(100)});
  s.nodes.edit(a)->parent = b;
  CHECK(s.world(a)[3][0] == 11);
  CHECK(s.world(b)[3][0] == 11);
  CHECK(s.world(tail)[3][0] == 111);
  for (const glm::dmat4& m : scene::worldMatrices(s)) CHECK(scene::finite(m));
  const auto self = s.nodes.add({"self", {}, moved(1)});
  s.nodes.edit(self)->parent = self;
  CHECK(s.world(self)[3][0] == 1);
  CHECK(scene::worldMatrices(s)[self.index][3][0] == 1);
}

TEST_CASE("Stale parents and non-finite transforms count for nothing", "[scene]") {
  Scene s;
  const auto gone = s.nodes.add({"gone", {}, moved(5)});
  const auto child = s.nodes.add({"child", gone, moved(1)});
  s.nodes.remove(gone);
  CHECK(s.world(child)[3][0] == 1);
  glm::dmat4 bad(1);
  bad[1][2] = std::numeric_limits<double>::quiet_NaN();
  const auto nan = s.nodes.add({"nan", child, bad});
  CHECK(s.world(nan)[3][0] == 1);
  CHECK(scene::finite(s.world(nan)));
}

TEST_CASE("Bounds follow negative and singular scale", "[scene]") {
  Scene s;
  CHECK(s.bounds().empty());
  const auto mesh = s.meshes.add(triangle());
  const auto mirrored = s.nodes.add({"", {}, glm::scale(glm::dmat4(1), glm::dvec3(-2, 1, 1))});
  const auto id = s.instances.add({"", mirrored, mesh, {}});
  CHECK(s.bounds().min.x == Approx(-2));
  CHECK(s.bounds().max.x == Approx(0));
  s.nodes.edit(mirrored)->local = glm::scale(glm::dmat4(1), glm::dvec3(0, 0, 0));
  CHECK(!s.bounds().empty());
  CHECK(s.bounds().max.x == 0);
  s.instances.edit(id)->visible = false;
  CHECK(s.bounds().empty());
}

TEST_CASE("Bounds leave out what no triangle uses and what is not finite", "[scene]") {
  Mesh m = triangle();
  m.positions.push_back({1000, 0, 0});
  CHECK(boundsOf(m).max.x == 1);
  m.positions[1] = {kInf, 0, 0};
  CHECK(boundsOf(m).max.x == 0);
  CHECK(boundsOf(Mesh{}).empty());
}

TEST_CASE("Validation names the stream that does not fit", "[scene]") {
  Report report;
  Mesh m = triangle();
  m.uv0 = {{0, 0}};
  auto r = validated(m, report);
  REQUIRE(!r);
  CHECK(r.error().message().find("uv0 has 1 elements, positions has 3") != std::string::npos);
  m = triangle();
  m.indices[2] = 3;
  r = validated(m, report);
  REQUIRE(!r);
  CHECK(r.error().message().find("indices[2] is 3") != std::string::npos);
  m = triangle();
  m.indices.push_back(0);
  CHECK(!validated(m, report));
}

TEST_CASE("Validation drops what cannot be drawn and says so", "[scene]") {
  Report report;
  Mesh m = triangle();
  m.positions.push_back({kNan, 0, 0});
  m.normals.push_back({0, 0, 1});
  for (const std::uint32_t i : {0u, 1u, 3u, 0u, 0u, 1u})
    m.indices.push_back(i);  // one with a NaN corner, one without area
  const auto r = validated(m, report);
  REQUIRE(r);
  CHECK(r->indices == std::vector<std::uint32_t>{0, 1, 2});
  CHECK(r->positions[3] == glm::vec3(0));
  CHECK(mentions(report, "1 triangles with a non-finite position"));
  CHECK(mentions(report, "1 triangles without area"));
}

TEST_CASE("Validation mends normals, tangents, coordinates and colours", "[scene]") {
  Report report;
  Mesh m = triangle();
  m.normals = {{0, 0, 0}, {kNan, 0, 1}, {0, 3, 4}};
  m.tangents = {{0, 0, 0, 1}, {2, 0, 0, -0.5f}, {1, kInf, 0, 1}};
  m.uv0 = {{kNan, 0}, {1, 1}, {0, 1}};
  m.colors = {{-1, 0, 0, 1}, {1, 1, 1, 1}, {1, kInf, 1, 1}};
  const auto r = validated(m, report);
  REQUIRE(r);
  CHECK(r->normals[0] == glm::vec3(0, 0, 1));  // the geometric normal
  CHECK(r->normals[1] == glm::vec3(0, 0, 1));
  CHECK(r->normals[2].y == Approx(0.6));
  CHECK(r->tangents[1] == glm::vec4(1, 0, 0, -1));
  for (int i : {0, 2}) {
    CHECK(glm::length(glm::vec3(r->tangents[std::size_t(i)])) == Approx(1));
    CHECK(glm::dot(glm::vec3(r->tangents[std::size_t(i)]), r->normals[std::size_t(i)]) == Approx(0).margin(1e-6));
  }
  CHECK(r->uv0[0] == glm::vec2(0));
  CHECK(r->colors[0] == glm::vec4(1));
  CHECK(r->colors[2] == glm::vec4(1));
  CHECK(report.warnings().size() == 4);
}

TEST_CASE("Missing normals become flat ones", "[scene]") {
  Report report;
  Mesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  m.uv0 = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  m.indices = {0, 1, 2, 0, 2, 3};
  const auto r = validated(m, report);
  REQUIRE(r);
  REQUIRE(r->positions.size() == 6);
  CHECK(r->normals[0] == glm::vec3(0, 0, 1));
  CHECK(r->normals[3] == glm::vec3(1, 0, 0));
  CHECK(r->uv0[5] == glm::vec2(1, 1));
  CHECK(report.empty());
}

TEST_CASE("Tiny and huge meshes validate alike", "[scene]") {
  Report report;
  for (const float scale : {1e-18f, 1e-6f, 1.0f, 1e6f, 1e30f}) {
    Mesh m = triangle();
    m.normals.clear();
    for (glm::vec3& p : m.positions) p *= scale;
    const auto r = validated(m, report);
    REQUIRE(r);
    REQUIRE(r->indices.size() == 3);
    CHECK(r->normals[0] == glm::vec3(0, 0, 1));
  }
}

TEST_CASE("Lights that stand in for baked light are off while there is any", "[scene]") {
  Scene s;
  Light lamp;
  lamp.range = 5;
  s.lights.add(lamp);
  lamp.standIn = true;
  s.lights.add(lamp);
  const auto lit = [&s] {
    scene::Derived derived;
    derived.update(s);
    Report report;
    return scene::gatherLights(s, derived, scene::frameOf(lookAt({0, 0, 3}, {0, 0, 0}), {16, 16}), {}, report).local.size();
  };
  CHECK(lit() == 2);
  s.probes.reflections.emplace_back();
  CHECK(lit() == 2);  // a place without light
  s.probes.reflections[0].radiance.levels.emplace_back();
  CHECK(lit() == 1);
  s.probes.reflections.clear();
  s.probes.grid.emplace();
  CHECK(lit() == 2);
  s.probes.grid->points.emplace_back();
  CHECK(lit() == 1);
}
