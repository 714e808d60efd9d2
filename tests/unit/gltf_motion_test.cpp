// Skins, morph targets and animations as the reader brings them.
#include "gltf_fixture.h"

using namespace gltf_test;
using burnish::asset::Interpolation;
using Path = burnish::asset::AnimationChannel::Path;

namespace {

const Sandbox& box() {
  static const Sandbox sandbox;
  return sandbox;
}
const burnish::asset::Primitive& only(const Reading& r) {
  INFO(r.message());
  REQUIRE(r.asset);
  REQUIRE(r.asset->meshes.at(0).primitives.size() == 1);
  return r.asset->meshes[0].primitives[0];
}

/// A triangle on two joints (nodes 1 and 2), node 0 the mesh.
struct SkinFile : MeshFile {
  SkinFile() {
    positions(3);
    json["scenes"] = {{{"nodes", {0, 1}}}};
    json["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"children", {2}}}, {{"translation", {0, 1, 0}}}};
    json["skins"] = {{{"name", "bones"}, {"joints", {2, 1}}}};
  }
  void joints(int set, std::initializer_list<std::uint8_t> j) {
    attribute(("JOINTS_" + std::to_string(set)).c_str(), accessor("VEC4", 5121, 3, bytes<std::uint8_t>(j)));
  }
  void weights(int set, std::initializer_list<float> w) {
    attribute(("WEIGHTS_" + std::to_string(set)).c_str(), accessor("VEC4", 5126, 3, bytes<float>(w)));
  }
};

/// One sampler of two or more key frames on node 0.
struct AnimationFile : MeshFile {
  AnimationFile() { positions(3); }
  int times(std::initializer_list<float> t) {
    return accessor("SCALAR", 5126, t.size(), bytes<float>(t), {{"min", {*t.begin()}}, {"max", {*(t.end() - 1)}}});
  }
  void animate(int input, int output, const char* path, const char* interpolation = nullptr) {
    Json sampler = {{"input", input}, {"output", output}};
    if (interpolation) sampler["interpolation"] = interpolation;
    json["animations"] = {{{"name", "move"},
                           {"samplers", {sampler}},
                           {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
  }
};

}  // namespace

TEST_CASE("skins: joints by the shown nodes, inverse bind matrices, weights of all formats", "[gltf][motion]") {
  SkinFile f;
  f.joints(0, {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0});
  const int weights = f.accessor("VEC4", 5121, 3, bytes<std::uint8_t>({51, 204, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}),
                                 {{"normalized", true}});
  f.attribute("WEIGHTS_0", weights);
  std::string matrices;
  for (int i = 0; i < 2; ++i)
    matrices += bytes<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, float(i) + 5, 6, 7, 1});
  f.json["skins"][0]["inverseBindMatrices"] = f.accessor("MAT4", 5126, 2, matrices);
  const Reading r = f.readIn(box());
  const auto& p = only(r);
  CHECK(r.report.empty());
  CHECK(p.joints[0] == glm::u16vec4(0, 1, 0, 0));
  CHECK(p.weights[0].y == Approx(0.8));
  REQUIRE(r.asset->skins.size() == 1);
  const auto& skin = r.asset->skins[0];
  CHECK(skin.name == "bones");
  CHECK(r.asset->nodes[0].skin == 0);
  REQUIRE(skin.joints.size() == 2);
  CHECK(r.asset->nodes[std::size_t(skin.joints[0])].translation == glm::dvec3(0, 1, 0));
  CHECK(r.asset->nodes[std::size_t(skin.joints[0])].parent == skin.joints[1]);
  CHECK(skin.inverseBind[1][3] == glm::vec4(6, 6, 7, 1));

  f.json["scenes"] = {{{"nodes", {1}}}};  // the mesh is not shown: neither is its skin missed
  CHECK(f.readIn(box()).asset->skins[0].joints.size() == 2);
}

TEST_CASE("eight joints a vertex become the strongest four, and the loss is stated", "[gltf][motion]") {
  SkinFile f;
  f.json["nodes"] = {{{"mesh", 0}, {"skin", 0}},  {{"children", {2, 3, 4, 5, 6}}}, Json::object(), Json::object(),
                     Json::object(),              Json::object(),                  Json::object()};
  f.json["skins"][0]["joints"] = {1, 2, 3, 4, 5, 6};
  f.joints(0, {0, 1, 2, 3, 0, 1, 2, 3, 5, 0, 0, 0});
  f.weights(0, {0.1f, 0.3f, 0.05f, 0.05f, 0.25f, 0.25f, 0.25f, 0.25f, 1, 0, 0, 0});
  f.joints(1, {4, 5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  f.weights(1, {0.2f, 0.3f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  const Reading r = f.readIn(box());
  const auto& p = only(r);
  CHECK(p.joints[0] == glm::u16vec4(1, 5, 4, 0));
  CHECK(p.weights[0].x == Approx(0.3 / 0.9));
  CHECK(p.weights[0].w == Approx(0.1 / 0.9));
  CHECK(p.joints[1] == glm::u16vec4(0, 1, 2, 3));
  CHECK(p.weights[1] == glm::vec4(0.25f));
  REQUIRE(r.report.warnings().size() == 1);
  CHECK(r.warned("up to 10 %"));
}

TEST_CASE("a joint out of range and a negative weight are faults at their attribute", "[gltf][motion]") {
  SkinFile f;
  f.joints(0, {0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  f.weights(0, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  CHECK(f.readIn(box()).message().find("/attributes/JOINTS_0") != std::string::npos);
  SkinFile g;
  g.joints(0, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  g.weights(0, {1, -0.5f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  CHECK(g.readIn(box()).message().find("/attributes/WEIGHTS_0") != std::string::npos);
}

TEST_CASE("morph targets: dense and sparse, names, weights of mesh and node", "[gltf][motion]") {
  MeshFile f;
  f.positions(3);
  f.attribute("NORMAL", f.accessor("VEC3", 5126, 3, bytes<float>({0, 0, 1, 0, 0, 1, 0, 0, 1})));
  const int dense = f.accessor("VEC3", 5126, 3, bytes<float>({1, 0, 0, 0, 1, 0, 0, 0, 1}),
                               {{"min", {0, 0, 0}}, {"max", {1, 1, 1}}});
  const int turn = f.accessor("VEC3", 5126, 3, bytes<float>({1, 0, -1, 0, 0, 0, 0, 0, 0}));
  const int sparse = f.accessor("VEC3", 5126, 3, "", {{"min", {0, 0, 0}}, {"max", {0, 9, 0}}});
  f.json["bufferViews"].erase(f.json["bufferViews"].size() - 1);
  f.json["accessors"][sparse].erase("bufferView");
  const auto view = [&f](const std::string& data) {
    f.accessor("SCALAR", 5121, 1, data);
    f.json["accessors"].erase(f.json["accessors"].size() - 1);
    return f.json["bufferViews"].size() - 1;
  };
  const auto indices = view(bytes<std::uint8_t>({1}));
  const auto values = view(bytes<float>({0, 9, 0}));
  f.json["accessors"][sparse]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                           {"values", {{"bufferView", values}}}};
  f.primitive["targets"] = {{{"POSITION", dense}, {"NORMAL", turn}}, {{"POSITION", sparse}}};
  f.json["meshes"] = {{{"primitives", {f.primitive}},
                       {"weights", {0.25, 0.5}},
                       {"extras", {{"targetNames", {"smile", "frown"}}}}}};
  const Reading r = f.readIn(box());
  const auto& p = only(r);
  CHECK(r.report.empty());
  REQUIRE(p.targets.size() == 2);
  CHECK(p.targets[0].positions == std::vector<glm::vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  CHECK(p.targets[0].normals[0] == glm::vec3(1, 0, -1));
  CHECK(p.targets[1].positions == std::vector<glm::vec3>{{0, 0, 0}, {0, 9, 0}, {0, 0, 0}});
  CHECK(p.targets[1].normals.empty());
  CHECK(r.asset->meshes[0].weights == std::vector<float>{0.25f, 0.5f});
  CHECK(r.asset->meshes[0].targetNames == std::vector<std::string>{"smile", "frown"});
  CHECK(r.asset->nodes[0].weights.empty());
  f.json["nodes"][0]["weights"] = {1, 0};
  CHECK(f.readIn(box()).asset->nodes[0].weights == std::vector<float>{1, 0});
}

TEST_CASE("animations: times, values, interpolation; what is not shown is left out", "[gltf][motion]") {
  AnimationFile f;
  const int input = f.times({0, 0.5f});
  const int packed = f.accessor("VEC4", 5122, 2, bytes<std::int16_t>({0, 0, 0, 32767, 0, -32767, 0, 0}),
                                {{"normalized", true}});
  f.animate(input, packed, "rotation", "STEP");
  Reading r = f.readIn(box());
  only(r);
  CHECK(r.report.empty());
  REQUIRE(r.asset->animations.size() == 1);
  const auto& a = r.asset->animations[0];
  CHECK(a.name == "move");
  CHECK(a.samplers[0].interpolation == Interpolation::Step);
  CHECK(a.samplers[0].times == std::vector<float>{0, 0.5f});
  CHECK(a.samplers[0].values == std::vector<float>{0, 0, 0, 1, 0, -1, 0, 0});
  CHECK((a.channels[0].path == Path::Rotation && a.channels[0].node == 0));

  f.json["animations"][0]["samplers"][0]["interpolation"] = "WAVY";
  r = f.readIn(box());
  CHECK(r.warned("unknown interpolation"));
  CHECK(r.asset->animations[0].samplers[0].interpolation == Interpolation::Linear);

  f.json["nodes"] = {{{"mesh", 0}}, Json::object()};  // node 1 is not in the scene
  f.json["animations"][0]["channels"][0]["target"]["node"] = 1;
  r = f.readIn(box());
  REQUIRE(r.asset);
  CHECK(r.asset->animations[0].channels.empty());
}

TEST_CASE("faulty times and animated matrices are refused; zeros in place of times are mended", "[gltf][motion]") {
  AnimationFile f;
  const int value = f.accessor("VEC3", 5126, 2, std::string(24, '\0'));
  f.animate(f.times({0.5f, 0.25f}), value, "scale");
  f.json["accessors"][2].erase("min"), f.json["accessors"][2]["min"] = {0.25};
  f.json["accessors"][2]["max"] = {0.5};
  CHECK(f.readIn(box()).message().find("/animations/0/samplers/0/input") != std::string::npos);

  AnimationFile zeros;
  const int still = zeros.accessor("VEC3", 5126, 2, std::string(24, '\0'));
  zeros.animate(zeros.times({0, 0}), still, "scale");
  zeros.json["accessors"][2].erase("bufferView");
  const Reading r = zeros.readIn(box());
  INFO(r.message());
  REQUIRE(r.asset);
  CHECK(r.warned("the times do not grow"));
  CHECK(r.asset->animations[0].channels.empty());

  AnimationFile matrix;
  const int to = matrix.accessor("VEC3", 5126, 2, std::string(24, '\0'));
  matrix.animate(matrix.times({0, 1}), to, "translation");
  matrix.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  CHECK(matrix.readIn(box()).message().find("has a matrix") != std::string::npos);
}

TEST_CASE("a small file cannot ask for much memory through animations or morph targets", "[gltf][motion]") {
  AnimationFile f;
  const std::size_t keys = 100000;
  std::string t(keys * 4, '\0');
  for (std::size_t i = 0; i < keys; ++i) {
    const float seconds = float(i) * 0.001f;
    std::memcpy(t.data() + i * 4, &seconds, 4);
  }
  const int input = f.accessor("SCALAR", 5126, keys, t, {{"min", {0}}, {"max", {100}}});
  const int output = f.accessor("VEC3", 5126, keys, std::string(keys * 12, '\0'));
  f.animate(input, output, "scale");
  Json& a = f.json["animations"][0];
  for (int i = 1; i < 1000; ++i) {
    a["samplers"].push_back(a["samplers"][0]);
    f.json["nodes"].push_back(Json::object());
    f.json["scenes"][0]["nodes"].push_back(i);
    a["channels"].push_back({{"sampler", i}, {"target", {{"node", i}, {"path", "scale"}}}});
  }
  const Reading r = f.readIn(box());
  CHECK(r.message().find("far more data") != std::string::npos);
}

TEST_CASE("the Fox of the Khronos samples has its skin and three animations", "[gltf][motion]") {
  const fs::path file = sharedData() / "gltf/Fox/Fox.glb";
  if (!fs::exists(file)) return;
  const Reading r = read(file);
  REQUIRE(r.asset);
  REQUIRE(r.asset->skins.size() == 1);
  CHECK(r.asset->skins[0].joints.size() == 24);
  REQUIRE(r.asset->animations.size() == 3);
  CHECK(r.asset->animations[0].name == "Survey");
  CHECK(r.asset->animations[1].name == "Walk");
  CHECK(r.asset->animations[2].name == "Run");
  CHECK(r.asset->meshes[0].primitives[0].joints.size() == r.asset->meshes[0].primitives[0].positions.size());
}
