// Curves against closed forms, what animate() moves and what it leaves alone, and what is mended in what moves.
#include <burnish/scene.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/load.h"
#include "scene/tangents.h"

using namespace burnish;

namespace {

double at(const Curve& c, double time) {
  double out[3] = {NAN, NAN, NAN};
  REQUIRE(evaluate(c, time, 1, false, out));
  return out[0];
}
glm::dquat rotationAt(const Curve& c, double time) {
  double q[4];
  REQUIRE(evaluate(c, time, 4, true, q));
  return {q[3], q[0], q[1], q[2]};
}
/// Degrees between two rotations.
double apart(glm::dquat a, glm::dquat b) {
  return 2 * std::acos(std::min(1.0, std::abs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z))) * 180 / M_PI;
}
glm::dquat turn(double angle, glm::dvec3 axis) { return glm::angleAxis(angle, glm::normalize(axis)); }
void push(Curve& c, glm::dquat q) {
  for (const double v : {q.x, q.y, q.z, q.w}) c.values.push_back(float(v));
}

struct World {
  Scene scene;
  Id<Node> node = scene.nodes.add({"node"});
  Id<Instance> instance = scene.instances.add({"instance", node});
  Animation animation;
  int curve(Curve c) {
    animation.curves.push_back(std::move(c));
    return int(animation.curves.size()) - 1;
  }
  Animation::NodeTrack& track() {
    if (animation.nodes.empty()) animation.nodes.push_back({node});
    return animation.nodes[0];
  }
  [[nodiscard]] const glm::dmat4& local() const { return scene.nodes.get(node)->local; }
};

}  // namespace

TEST_CASE("Step, linear and cubic curves follow their closed forms", "[animation]") {
  const std::vector<float> times{0.5f, 1.5f, 2.25f};
  const Curve step{Interpolation::Step, times, {1, 3, -2}}, linear{Interpolation::Linear, times, {1, 3, -2}};
  // x(t) = t³ - 2t with its derivative as tangents: a Hermite spline is exact for cubics.
  const auto x = [](double t) { return t * t * t - 2 * t; };
  const auto dx = [](double t) { return 3 * t * t - 2; };
  Curve cubic{Interpolation::CubicSpline, times, {}};
  for (const float t : times)
    for (const double v : {dx(t), x(t), dx(t)}) cubic.values.push_back(float(v));
  for (double t = -1; t < 4; t += 1.0 / 64) {
    const double in = std::clamp(t, 0.5, 2.25);
    const double expected = in < 1.5 ? 1 + 2 * (in - 0.5) : 3 - 5 * (in - 1.5) / 0.75;
    CHECK(at(step, t) == (t < 1.5 ? 1 : t < 2.25 ? 3 : -2));
    CHECK(at(linear, t) == Approx(expected).margin(1e-12));
    CHECK(at(cubic, t) == Approx(x(in)).margin(2e-6));
  }
}

TEST_CASE("Rotations go the short way round at a constant speed", "[animation]") {
  for (const double angle : {1e-9, 0.3, 1.2, 3.0})
    for (const double sign : {1.0, -1.0}) {  // q and -q are one rotation
      Curve c{Interpolation::Linear, {0, 2}, {}};
      push(c, turn(0.4, {1, 2, 3}));
      push(c, turn(angle, {3, -1, 2}) * turn(0.4, {1, 2, 3}) * sign);
      for (double t = 0; t <= 2; t += 0.125) {
        INFO(angle << " at " << t);
        CHECK(apart(rotationAt(c, t), turn(angle * t / 2, {3, -1, 2}) * turn(0.4, {1, 2, 3})) < 1e-4);
        CHECK(glm::length(rotationAt(c, t)) == Approx(1).epsilon(1e-12));
      }
    }
  // Splines of quaternions are made unit length; at the key frames they meet them.
  Curve cubic{Interpolation::CubicSpline, {0, 1}, {}};
  for (const double angle : {0.0, 2.0}) {
    push(cubic, glm::dquat(0.1, 0.7, -0.3, 0.2));
    push(cubic, turn(angle, {0, 1, 0}));
    push(cubic, glm::dquat(-0.3, 0.2, 0.9, 0.4));
  }
  for (double t = 0; t <= 1; t += 0.0625) CHECK(glm::length(rotationAt(cubic, t)) == Approx(1).epsilon(1e-12));
  CHECK(apart(rotationAt(cubic, 1), turn(2, {0, 1, 0})) < 1e-4);
}

TEST_CASE("Curves that make no sense are refused, never read past their end", "[animation]") {
  double out[4] = {7, 7, 7, 7};
  CHECK_FALSE(evaluate({}, 0, 3, false, out));
  CHECK_FALSE(evaluate({Interpolation::Linear, {0, 1}, {1, 2, 3}}, 0, 3, false, out));
  CHECK_FALSE(evaluate({Interpolation::CubicSpline, {0, 1}, {1, 2, 3, 4, 5, 6}}, 0, 3, false, out));
  CHECK_FALSE(evaluate({Interpolation::Linear, {0}, {1}}, 0, -1, false, out));
  CHECK_FALSE(evaluate({Interpolation::Linear, {0}, {0, 0, 0, 0}}, 0, 4, true, out));
  CHECK_FALSE(evaluate({Interpolation::Linear, {0, 1}, {NAN, 1}}, 0.5, 1, false, out));
  CHECK_FALSE(evaluate({Interpolation::Linear, {0}, {1, 2, 3}}, 0, 3, true, out));
  CHECK(out[0] == 7);
  CHECK(evaluate({Interpolation::Linear, {2, 1, NAN}, {1, 2, 3}}, 1.5, 1, false, out));  // some value, no fault
  CHECK(evaluate({Interpolation::Linear, {0, 1}, {1, 2}}, NAN, 1, false, out));
  CHECK(out[0] == 1);
}

TEST_CASE("Animations loop with their own length", "[animation]") {
  Animation a;
  a.curves = {{Interpolation::Linear, {0, 1.5f}, {0, 1}}, {Interpolation::Linear, {0.5f}, {0}}, {}};
  CHECK(a.length() == 1.5);
  CHECK(a.looped(1) == 1);
  CHECK(a.looped(1.5) == 0);
  CHECK(a.looped(4) == 1);
  CHECK(a.looped(-0.25) == 1.25);
  CHECK(a.looped(-1e-30) < 1.5);
  CHECK(a.looped(NAN) == 0);
  CHECK(a.looped(INFINITY) == 0);
  CHECK(Animation{}.looped(3) == 0);
}

TEST_CASE("Translation, rotation and scale are replaced one by one; the others rest", "[animation]") {
  World w;
  w.track().restTranslation = {1, 2, 3};
  w.track().restRotation = turn(0.5, {0, 0, 1});
  w.track().restScale = {2, 3, -4};
  w.track().rotation = w.curve({Interpolation::Linear, {0, 1}, {0, 0, 0, 1, 0, 1, 0, 0}});
  const Id<Animation> id = w.scene.animations.add(w.animation);
  animate(w.scene, id, 0.5);
  glm::dmat4 expected = glm::dmat4(glm::mat3_cast(turn(M_PI / 2, {0, 1, 0}) * 1.0));
  for (int c = 0; c < 3; ++c) expected[c] *= std::array{2.0, 3.0, -4.0}[std::size_t(c)];
  expected[3] = {1, 2, 3, 1};
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) CHECK(w.local()[c][r] == Approx(expected[c][r]).margin(1e-6));
  w.scene.animations.edit(id)->nodes[0].translation = 1;
  w.scene.animations.edit(id)->curves.push_back({Interpolation::Step, {0}, {9, 8, 7}});
  animate(w.scene, id, 0);
  CHECK(w.local()[3] == glm::dvec4(9, 8, 7, 1));
  CHECK(glm::length(glm::dvec3(w.local()[0])) == Approx(2));
}

TEST_CASE("Only rows that change are edited", "[animation]") {
  World w;
  const Id<Node> other = w.scene.nodes.add({"other"});
  w.animation.nodes = {{w.node}, {other}};
  w.animation.nodes[0].translation = w.curve({Interpolation::Linear, {0, 1, 2}, {0, 0, 0, 1, 0, 0, 1, 0, 0}});
  w.animation.nodes[1].translation = w.curve({Interpolation::Step, {0}, {0, 5, 0}});
  w.animation.weights = {{{w.instance}, 1, w.curve({Interpolation::Linear, {0, 1, 2}, {0, 1, 1}})}};
  const Id<Animation> id = w.scene.animations.add(w.animation);
  animate(w.scene, id, 0.5);
  const auto still = w.scene.nodes.revision(other), moving = w.scene.nodes.revision(w.node), weighed = w.scene.instances.revision(w.instance);
  animate(w.scene, id, 0.75);
  CHECK(w.scene.nodes.revision(other) == still);
  CHECK(w.scene.nodes.revision(w.node) > moving);
  CHECK(w.scene.instances.revision(w.instance) > weighed);
  CHECK(w.scene.instances.get(w.instance)->morphWeights == std::vector<float>{0.75f});
  animate(w.scene, id, 1.25);
  const auto nodes = w.scene.nodes.revision(), instances = w.scene.instances.revision();
  animate(w.scene, id, 1.75);  // between two equal key frames
  CHECK(w.scene.nodes.revision() == nodes);
  CHECK(w.scene.instances.revision() == instances);
}

TEST_CASE("What is gone or faulty stays as it is", "[animation]") {
  World w;
  w.track().translation = 5;  // no such curve
  w.track().scale = w.curve({Interpolation::Linear, {0, 1}, {NAN, 1, 1, 1, 1, 1}});
  w.animation.nodes.push_back({Id<Node>{77, 0}, {}, {1, 0, 0, 0}, glm::dvec3(1), 0});
  w.animation.weights = {{{Id<Instance>{55, 1}, w.instance}, 2, 9}, {{w.instance}, 1000000, 0}};
  const Id<Animation> id = w.scene.animations.add(w.animation);
  w.scene.nodes.edit(w.node)->local[3] = {4, 5, 6, 1};
  animate(w.scene, id, 0.5);
  animate(w.scene, Id<Animation>{}, 0.5);
  CHECK(w.local()[3] == glm::dvec4(4, 5, 6, 1));
  CHECK(w.scene.instances.get(w.instance)->morphWeights.empty());
  Report report;
  const Animation mended = validated(w.animation, report);
  CHECK((mended.nodes.empty() && mended.weights.empty()));
  CHECK(report.warnings().size() == 1);
}

TEST_CASE("Animations that move different things play side by side", "[animation]") {
  Scene s;
  const Id<Node> a = s.nodes.add({"a"}), b = s.nodes.add({"b"});
  const auto moves = [&](Id<Node> node, float x) {
    Animation animation;
    animation.curves = {{Interpolation::Step, {0}, {x, 0, 0}}};
    animation.nodes = {{node}};
    animation.nodes[0].translation = 0;
    return s.animations.add(animation);
  };
  const auto first = moves(a, 1), second = moves(a, 2), third = moves(b, 3);
  CHECK(playedTogether(s) == std::vector<Id<Animation>>{first, third});
  animate(s, 0.0);
  CHECK((s.nodes.get(a)->local[3].x == 1 && s.nodes.get(b)->local[3].x == 3));
  animate(s, second, 0);
  CHECK(s.nodes.get(a)->local[3].x == 2);
}

TEST_CASE("Validation mends joint weights and keeps all streams together", "[animation]") {
  Mesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  m.indices = {0, 1, 2, 2, 1, 3, 0, 0, 1};  // the last one is flat until something moves it
  m.joints = {{0, 1, 2, 3}, {4, 0, 0, 0}, {5, 0, 0, 0}, {6, 0, 0, 0}};
  m.weights = {{2, 2, 0, 0}, {NAN, -1, 0, 0}, {1, 0, 0, 0}, {0.999f, 0, 0, 0}};
  m.targets = {{"up", {{0, 0, 1}, {0, 0, 1}, {0, 0, NAN}, {0, 0, 1}}, {}, {}}};
  Report report;
  const auto good = validated(m, report);
  REQUIRE(good);
  CHECK(report.warnings().size() == 2);
  REQUIRE(good->positions.size() == 9);  // no normals: a vertex for each corner
  CHECK(good->joints.size() == 9);
  CHECK(good->targets[0].positions.size() == 9);
  CHECK(good->targets[0].normals.size() == 9);
  CHECK(good->weights[0] == glm::vec4(0.5f, 0.5f, 0, 0));
  CHECK(good->weights[1] == glm::vec4(1, 0, 0, 0));
  CHECK(good->weights[5] == glm::vec4(1, 0, 0, 0));
  CHECK(good->joints[5] == glm::u16vec4(6, 0, 0, 0));
  // Triangle 0 moves by (1, 1, 0) along z: its normal turns by what the moved corners say.
  const glm::dvec3 turned = glm::normalize(glm::cross(glm::dvec3(1, 0, 0), glm::dvec3(0, 1, -1)));
  CHECK(glm::length(glm::dvec3(good->normals[0] + good->targets[0].normals[0]) - turned) < 1e-6);

  Mesh bad = m;
  bad.weights.pop_back();
  CHECK_FALSE(validated(bad, report));
  bad = m;
  bad.joints.clear();
  CHECK_FALSE(validated(bad, report));
  bad = m;
  bad.targets[0].tangents.resize(2);
  const auto refused = validated(bad, report);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().what.find("targets[0].tangents") != std::string::npos);
}

TEST_CASE("Vertices that tangents split keep their joints and deltas", "[animation]") {
  // Two triangles with mirrored texture coordinates share an edge: its vertices get two tangents.
  Mesh m;
  m.positions = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
  m.normals.assign(4, {0, 0, 1});
  m.uv0 = {{0, 0}, {0, 1}, {1, 0}, {1, 0}};
  m.indices = {0, 1, 2, 1, 0, 3};
  m.joints = {{10, 0, 0, 0}, {11, 0, 0, 0}, {12, 0, 0, 0}, {13, 0, 0, 0}};
  m.weights.assign(4, {1, 0, 0, 0});
  m.targets = {{"t", {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}}, {}, {}}};
  makeTangents(m);
  REQUIRE(m.positions.size() == 6);
  REQUIRE(m.joints.size() == 6);
  REQUIRE(m.weights.size() == 6);
  REQUIRE(m.targets[0].positions.size() == 6);
  for (std::size_t v = 0; v < 6; ++v)
    for (std::size_t w = 0; w < 4; ++w)
      if (m.positions[v] == m.positions[w]) {
        CHECK(m.joints[v] == m.joints[w]);
        CHECK(m.targets[0].positions[v] == m.targets[0].positions[w]);
      }
}

TEST_CASE("Import: skins name nodes, instances take skin and weights, channels become tracks", "[import][animation]") {
  asset::Asset in;
  in.name = "test";
  asset::Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.normals.assign(3, {0, 0, 1});
  p.indices = {0, 1, 2};
  p.targets = {{{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {}, {}}};
  asset::Primitive stiff = p;
  p.joints.assign(3, {1, 0, 0, 0});
  p.weights.assign(3, {1, 0, 0, 0});
  in.meshes = {{"mesh", {p, stiff}, {0.5f}, {"puff"}}};
  in.nodes.resize(3);
  in.nodes[0].mesh = 0;
  in.nodes[0].skin = 0;
  in.nodes[1].name = "joint";
  in.nodes[1].translation = {0, 2, 0};
  in.skins = {{"bones", {2, 1}, {glm::mat4(1), glm::mat4(0)}}};
  using Path = asset::AnimationChannel::Path;
  in.animations = {{"wave", {{asset::Interpolation::Linear, {0, 1}, {0, 0, 0, 0, 4, 0}}, {asset::Interpolation::Step, {0, 1}, {0.25f, 1}}, {asset::Interpolation::Step, {0}, {3, 3, 3}}},
                    {{Path::Translation, 0, 1}, {Path::Weights, 1, 0}, {Path::Scale, 2, 1}}}};
  Report report;
  auto made = scene::importAsset(in, scene::Deadline(0), report);
  REQUIRE(made);
  Scene& s = *made;
  REQUIRE(s.instances.size() == 2);
  const Instance& skinned = *s.instances.get(s.instances.at(0));
  REQUIRE(s.skins.has(skinned.skin));
  const Skin& skin = *s.skins.get(skinned.skin);
  CHECK(s.nodes.get(skin.joints[1])->name == "joint");
  CHECK_FALSE(s.instances.get(s.instances.at(1))->skin);  // its primitive has no joints
  CHECK(skinned.morphWeights == std::vector<float>{0.5f});
  CHECK(s.meshes.get(skinned.mesh)->targets[0].name == "puff");
  REQUIRE(report.warnings().size() >= 1);
  CHECK(report.warnings()[0].message().find("singular") != std::string::npos);
  animate(s, 0.5);
  CHECK(s.nodes.get(skin.joints[1])->local[3] == glm::dvec4(0, 2, 0, 1));
  CHECK(s.nodes.get(skin.joints[1])->local[0].x == 3);
  for (std::uint32_t i = 0; i < 2; ++i) CHECK(s.instances.get(s.instances.at(i))->morphWeights == std::vector<float>{0.25f});
}
