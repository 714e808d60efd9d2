// What the reader makes of each thing that a glTF file can bring; materials and pictures are gltf_material_test.cpp's.
#include "gltf_fixture.h"

using namespace gltf_test;
using burnish::asset::Light;
using Indices = std::vector<std::uint32_t>;

namespace {
const Sandbox& box() {
  static const Sandbox sandbox;
  return sandbox;
}
Reading readJson(Json json) {
  json["asset"] = {{"version", "2.0"}};
  return read(box().put("file.gltf", json.dump()));
}
const burnish::asset::Primitive& only(const Reading& r) {
  INFO(r.message());
  REQUIRE(r.asset);
  REQUIRE(r.asset->meshes.at(0).primitives.size() == 1);
  return r.asset->meshes[0].primitives[0];
}
}  // namespace

TEST_CASE("strips, fans and lists without indices become indexed lists", "[gltf]") {
  struct Row {
    int mode, vertices;
    Indices expected;
  };
  for (const Row& row : {Row{4, 6, {0, 1, 2, 3, 4, 5}}, Row{5, 5, {0, 1, 2, 1, 3, 2, 2, 3, 4}},
                         Row{6, 5, {1, 2, 0, 2, 3, 0, 3, 4, 0}}, Row{4, 8, {0, 1, 2, 3, 4, 5}}}) {
    MeshFile f;
    f.positions(row.vertices);
    f.primitive["mode"] = row.mode;
    const Reading r = f.readIn(box());
    CHECK(only(r).indices == row.expected);
    CHECK(only(r).positions[2] == glm::vec3(2, 4, 0));
    CHECK(r.warned("multiple of 3") == (row.vertices == 8));
  }
  for (const int mode : {0, 1, 2, 3}) {
    MeshFile f;
    f.positions(4);
    f.primitive["mode"] = mode;
    const Reading r = f.readIn(box());
    REQUIRE(r.asset);
    CHECK(r.asset->meshes[0].primitives.empty());
    CHECK(r.warned("points and lines"));
  }
}

TEST_CASE("indices of all sizes; out of range and restart values are refused", "[gltf]") {
  const auto with = [](int component, const std::string& data, int vertices, std::size_t count = 3) {
    MeshFile f;
    f.positions(vertices);
    f.primitive["indices"] = f.accessor("SCALAR", component, count, data);
    return f.readIn(box());
  };
  CHECK(only(with(5121, bytes<std::uint8_t>({2, 1, 0}), 3)).indices == Indices{2, 1, 0});
  CHECK(only(with(5123, bytes<std::uint16_t>({2, 1, 0}), 3)).indices == Indices{2, 1, 0});
  CHECK(only(with(5125, bytes<std::uint32_t>({2, 1, 0}), 3)).indices == Indices{2, 1, 0});
  CHECK(with(5123, bytes<std::uint16_t>({2, 3, 0}), 3).message().find("/meshes/0/primitives/0/indices") !=
        std::string::npos);
  CHECK(with(5121, bytes<std::uint8_t>({2, 255, 0}), 300).message().find("restart") != std::string::npos);
  CHECK(with(5125, bytes<std::uint32_t>({2, 0xffffffffu, 0}), 3).message().find("restart") != std::string::npos);
}

TEST_CASE("few indices into a large vertex buffer take only their vertices", "[gltf]") {
  MeshFile f;
  f.positions(100);
  f.primitive["indices"] = f.accessor("SCALAR", 5121, 6, bytes<std::uint8_t>({90, 10, 50, 10, 90, 51}));
  const Reading r = f.readIn(box());
  const auto& p = only(r);
  CHECK(p.positions == std::vector<glm::vec3>{{10, 100, 0}, {50, 2500, 0}, {51, 2601, 0}, {90, 8100, 0}});
  CHECK(p.indices == Indices{3, 0, 1, 0, 3, 2});
}

TEST_CASE("normalized and quantized attributes", "[gltf]") {
  MeshFile f;
  f.positions(3);
  f.attribute("TEXCOORD_0",
              f.accessor("VEC2", 5121, 3, bytes<std::uint8_t>({0, 255, 0, 0, 51, 102, 0, 0, 255, 0, 0, 0}),
                         {{"normalized", true}}));
  f.json["bufferViews"][1]["byteStride"] = 4;
  f.attribute("COLOR_0", f.accessor("VEC3", 5123, 3,
                                    bytes<std::uint16_t>({65535, 0, 13107, 0, 0, 0, 0, 0, 65535, 65535, 65535, 0}),
                                    {{"normalized", true}}));
  f.json["bufferViews"][2]["byteStride"] = 8;
  const Reading plain = f.readIn(box());
  const auto& p = only(plain);
  CHECK(p.uv0[0] == glm::vec2(0, 1));
  CHECK(p.uv0[1].x == Approx(0.2));
  CHECK(p.uv0[1].y == Approx(0.4));
  CHECK(p.colors[0].x == 1);
  CHECK(p.colors[0].z == Approx(0.2));
  CHECK(p.colors[0].w == 1);

  MeshFile q;
  q.attribute("POSITION", q.accessor("VEC3", 5122, 3, bytes<std::int16_t>({-5, 7, 9, 0, 1, 2, 3, 0, 4, 5, 6, 0}),
                                     {{"min", {-5, 2, 3}}, {"max", {4, 7, 9}}}));
  q.attribute("NORMAL", q.accessor("VEC3", 5120, 3, bytes<std::int8_t>({127, -128, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0}),
                                   {{"normalized", true}}));
  q.json["bufferViews"][0]["byteStride"] = 8;
  q.json["bufferViews"][1]["byteStride"] = 4;
  CHECK(q.readIn(box()).message().find("/attributes/NORMAL") != std::string::npos);  // not without the extension
  q.json["extensionsUsed"] = q.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  q.json["accessors"][0]["min"] = {-5, 1, 2};
  const Reading r = q.readIn(box());
  CHECK(only(r).positions[0] == glm::vec3(-5, 7, 9));
  CHECK(only(r).normals[0] == glm::vec3(1, -1, 0));
}

TEST_CASE("sparse accessors replace elements of a view or of zeros", "[gltf]") {
  for (const bool onZeros : {false, true}) {
    MeshFile f;
    f.positions(3);
    const int indices = f.accessor("SCALAR", 5123, 2, bytes<std::uint16_t>({0, 2}));
    const int values = f.accessor("VEC3", 5126, 2, bytes<float>({9, 8, 7, 6, 5, 4}));
    Json& a = f.json["accessors"][0];
    a["sparse"] = {{"count", 2},
                   {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                   {"values", {{"bufferView", values}}}};
    a["max"] = {9, 9, 9};
    if (onZeros) a.erase("bufferView");
    f.json["accessors"].erase(1);
    f.json["accessors"].erase(1);
    const Reading r = f.readIn(box());
    const glm::vec3 kept = onZeros ? glm::vec3(0) : glm::vec3(1, 1, 0);
    CHECK(only(r).positions == std::vector<glm::vec3>{{9, 8, 7}, kept, {6, 5, 4}});
    f.binary[36] = 2;  // indices 2, 2
    CHECK(f.readIn(box()).message().find("/accessors/0/sparse/indices") != std::string::npos);
    f.binary[36] = 3;  // 3 of 3
    CHECK(f.readIn(box()).message().find("/accessors/0/sparse/indices") != std::string::npos);
  }
}

TEST_CASE("numbers that are not finite or break their bounds are refused at their accessor", "[gltf]") {
  for (const float bad : {NAN, INFINITY, -INFINITY}) {
    MeshFile f;
    f.positions(3);
    f.attribute("NORMAL", f.accessor("VEC3", 5126, 3, bytes<float>({0, 0, 1, 0, bad, 1, 0, 0, 1})));
    CHECK(f.readIn(box()).message().find("/accessors/1") != std::string::npos);
  }
  MeshFile f;
  f.positions(3);
  f.json["accessors"][0]["max"] = {2, 3, 0};
  CHECK(f.readIn(box()).message().find("/accessors/0/max/1") != std::string::npos);
  f.json["accessors"][0]["max"] = {2, 3.999, 0};  // rounded by the writer
  CHECK(f.readIn(box()).message().empty());
  CHECK(read(box().put("n.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"scale":[1,1e999,1]}]})"))
            .message()
            .find("/nodes/0/scale/1") != std::string::npos);
  CHECK(readJson({{"nodes", {{{"scale", {1, 1e39, 1}}}}}}).message().find("/nodes/0/scale/1") != std::string::npos);
  CHECK(readJson({{"nodes", {{{"scale", {1e30, 1, 1}}, {"children", {1}}}, {{"scale", {1e30, 1, 1}}}}}})
            .message()
            .find("/nodes/1") != std::string::npos);
}

TEST_CASE("colours are clamped, odd tangents mended, surplus attributes named", "[gltf]") {
  MeshFile f;
  f.positions(3);
  f.attribute("COLOR_0", f.accessor("VEC4", 5126, 3, bytes<float>({2, 0.5f, -1, 1, 0, 0, 0, 0, 1, 1, 1, 1})));
  f.attribute("NORMAL", f.accessor("VEC3", 5126, 3, bytes<float>({0, 0, 1, 0, 0, 1, 0, 0, 1})));
  f.attribute("TANGENT", f.accessor("VEC4", 5126, 3, bytes<float>({1, 0, 0, -0.5f, 0, 0, 0, 0, 1, 0, 0, 1})));
  for (const char* uv : {"TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2"})
    f.attribute(uv, f.accessor("VEC2", 5126, 3, std::string(24, '\0')));
  f.attribute("_OURS", f.accessor("SCALAR", 5126, 3, std::string(12, '\0')));
  const Reading r = f.readIn(box());
  const auto& p = only(r);
  CHECK(p.colors[0] == glm::vec4(1, 0.5, 0, 1));
  CHECK(p.tangents[0].w == -1);
  CHECK(p.tangents[1].w == 1);
  CHECK(p.uv1.size() == 3);
  CHECK(r.warned("colours outside 0 to 1"));
  CHECK(r.warned("tangents whose w"));
  CHECK(r.warned("TEXCOORD_2"));
  CHECK(r.report.warnings().size() == 3);
}

TEST_CASE("nodes: parents first, matrices and TRS, the default scene only", "[gltf]") {
  const Json file = {
      {"scene", 1},
      {"scenes", {{{"nodes", {0}}}, {{"nodes", {3, 1}}, {"extras", {{"burnish", {{"environment", "sky.hdr"}}}}}}}},
      {"nodes",
       {{{"name", "not shown"}},
        {{"name", "root"},
         {"children", {2}},
         {"translation", {1, 2, 3}},
         {"scale", {2, 3, 4}},
         {"rotation", {0, 0, 2e-1, 0}}},
        {{"name", "child"}, {"matrix", {1, 0, 0, 0, 0.5, -1, 0, 0, 0, 0, 0, 0, 7, 8, 9, 1}}},
        {{"name", "other"}}}}};
  box().put("sky.hdr", "x");
  const Reading r = readJson(file);
  INFO(r.message());
  REQUIRE(r.asset);
  const auto& n = r.asset->nodes;
  REQUIRE(n.size() == 3);
  CHECK((n[0].name == "other" && n[1].name == "root" && n[2].name == "child"));
  CHECK((n[1].parent == -1 && n[2].parent == 1));
  CHECK(n[1].local == glm::dmat4(-2, 0, 0, 0, 0, -3, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1));
  CHECK(n[2].local == glm::dmat4(1, 0, 0, 0, 0.5, -1, 0, 0, 0, 0, 0, 0, 7, 8, 9, 1));
  CHECK(r.asset->environment == "sky.hdr");
  CHECK(r.warned("quaternion"));
  CHECK(readJson({{"nodes", {Json::object(), {{"children", {0}}}}}}).asset->nodes.size() == 2);  // no scenes: all roots
}

TEST_CASE("fog of a scene: its numbers, and one clear error for what is none", "[gltf]") {
  const auto withFog = [](Json fog) {
    return readJson({{"scenes", {{{"extras", {{"burnish", {{"fog", std::move(fog)}}}}}}}}});
  };
  const Reading r = withFog({{"density", 0.002}, {"falloff", 0.05}, {"height", -3}, {"albedo", {0.5, 0.25, 1}}, {"anisotropy", 0.5}, {"start", 4}, {"colour", 1}});
  INFO(r.message());
  REQUIRE(r.asset);
  REQUIRE(r.asset->fog);
  const auto& fog = *r.asset->fog;
  CHECK((fog.density == 0.002f && fog.falloff == 0.05f && fog.height == -3 && fog.anisotropy == 0.5f && fog.start == 4));
  CHECK(fog.albedo == glm::vec3(0.5f, 0.25f, 1));
  CHECK(r.warned("'colour'"));
  CHECK_FALSE(readJson({{"scenes", {Json::object()}}}).asset->fog);
  for (const auto& [wrong, place] : std::vector<std::pair<Json, std::string>>{{{{"density", "thick"}}, "density"},
                                                                              {{{"density", -1}}, "density"},
                                                                              {{{"falloff", 1}}, "density"},
                                                                              {{{"density", 1}, {"albedo", {1, 2, 1}}}, "albedo"},
                                                                              {{{"density", 1}, {"anisotropy", 1}}, "anisotropy"}}) {
    const Reading bad = withFog(wrong);
    CAPTURE(wrong.dump());
    CHECK_FALSE(bad.asset);
    CHECK(bad.message().find("/scenes/0/extras/burnish/fog") != std::string::npos);
    CHECK(bad.message().find(place) != std::string::npos);
  }
}

TEST_CASE("sky of a scene: its numbers, and one clear error for what is none", "[gltf]") {
  const auto withSky = [](Json ours) { return readJson({{"scenes", {{{"extras", {{"burnish", std::move(ours)}}}}}}}); };
  const Reading r = withSky({{"sky", {{"sun", {0, 3, 4}}, {"turbidity", 4}, {"ground", {0.1, 0.2, 0.3}}, {"altitude", 100}}}});
  INFO(r.message());
  REQUIRE(r.asset);
  REQUIRE(r.asset->sky);
  CHECK((r.asset->sky->sun == glm::vec3(0, 3, 4) && r.asset->sky->turbidity == 4 && r.asset->sky->altitude == 100));
  CHECK(r.asset->sky->ground == glm::vec3(0.1f, 0.2f, 0.3f));
  box().put("sky.hdr", "x");
  for (const Json& bad : {Json{{"sky", Json::object()}}, Json{{"sky", {{"sun", {0, 0, 0}}}}}, Json{{"sky", {{"sun", {0, 1}}}}},
                          Json{{"sky", {{"sun", {0, 1, 0}}, {"turbidity", 0.5}}}}, Json{{"environment", "sky.hdr"}, {"sky", {{"sun", {0, 1, 0}}}}}}) {
    const Reading refused = withSky(bad);
    CAPTURE(bad.dump());
    CHECK_FALSE(refused.asset);
    CHECK(refused.message().find("/scenes/0/extras/burnish/sky") != std::string::npos);
  }
}

TEST_CASE("cameras and lights", "[gltf]") {
  Json file = {{"extensionsUsed", {"KHR_lights_punctual"}},
               {"cameras",
                {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}},
                 {{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}},
                 {{"type", "perspective"}, {"perspective", {{"yfov", 4}, {"znear", 0.1}}}}}},
               {"nodes", {{{"camera", 1}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}}}}};
  file["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"intensity", 3}},
      {{"type", "spot"},
       {"color", {1, 0.5, 0.25}},
       {"range", 7},
       {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 1.5707964}}}}};
  const Reading r = readJson(file);
  INFO(r.message());
  REQUIRE(r.asset);
  CHECK((r.asset->nodes[0].camera == 1 && r.asset->nodes[0].light == 1));
  CHECK((r.asset->cameras[0].fovY == 1 && r.asset->cameras[0].far == 0));
  CHECK((r.asset->cameras[1].orthographic && r.asset->cameras[1].ymag == 2 && r.asset->cameras[1].aspect == 2));
  CHECK((r.asset->cameras[2].fovY < 3.1416 && r.warned("too wide")));
  const auto& l = r.asset->lights;
  CHECK((l[0].kind == Light::Kind::Directional && l[0].intensity == 3));
  CHECK((l[1].kind == Light::Kind::Spot && l[1].range == 7 && l[1].outerCone <= 1.5707964f && l[1].innerCone == 0.1f));
  file["extensions"]["KHR_lights_punctual"]["lights"][1]["spot"]["innerConeAngle"] = 1.58;
  CHECK(readJson(file).message().find("/extensions/KHR_lights_punctual/lights/1/spot") != std::string::npos);
}

TEST_CASE("a light's extras say whether it casts shadows and how large it is", "[gltf]") {
  const auto with = [](const Json& ours) {
    Json file = {{"extensionsUsed", {"KHR_lights_punctual"}}, {"nodes", {{{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}}}};
    file["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"extras", {{"burnish", ours}}}}};
    return readJson(file);
  };
  const Reading r = with({{"shadow", true}, {"standIn", true}, {"sourceRadius", 0.25}, {"angularDiameter", 0.5}});
  REQUIRE(r.asset);
  CHECK((r.asset->lights[0].shadow && r.asset->lights[0].standIn && r.asset->lights[0].sourceRadius == 0.25f && r.asset->lights[0].angularDiameter == 0.5f && r.report.empty()));
  const Reading plain = with(Json::object());
  CHECK((!plain.asset->lights[0].shadow && plain.asset->lights[0].sourceRadius < 0));
  const Reading odd = with({{"shadow", "yes"}, {"sourceRadius", -1}});
  REQUIRE(odd.asset);
  CHECK((!odd.asset->lights[0].shadow && odd.asset->lights[0].sourceRadius < 0));
  CHECK(odd.warned("/extensions/KHR_lights_punctual/lights/0/extras/burnish/shadow: string where true or false is expected: it is left out"));
  CHECK(odd.warned("/extensions/KHR_lights_punctual/lights/0/extras/burnish/sourceRadius: no number from 0 to 1e6: it is left out"));
}

TEST_CASE("GLB: chunk and data URI", "[gltf]") {
  MeshFile f;
  f.positions(3);
  f.json["meshes"] = {{{"primitives", {f.primitive}}}};
  f.json["buffers"] = {{{"byteLength", f.binary.size()}}};
  const Reading chunk = read(box().put("chunk.glb", glb(f.json.dump(), f.binary)));
  CHECK(only(chunk).positions.size() == 3);
  CHECK(chunk.asset->name == "chunk.glb");
  CHECK(only(read(box().put("named.gltf", glb(f.json.dump(), f.binary)))).positions.size() ==
        3);  // told by its magic, not its name
  f.json["buffers"][0]["uri"] = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAgD8AAAAAAAAAQAAAgEAAAAAA";
  const Reading uri = read(box().put("uri.gltf", f.json.dump()));
  CHECK(only(uri).positions == only(chunk).positions);
}

TEST_CASE("faults of JSON text name their line, its values their path", "[gltf]") {
  CHECK(read(box().put("j.gltf", "{\"asset\":\n  {\"version\" \"2.0\"}}")).message().find("line 2") !=
        std::string::npos);
  CHECK(read(box().put("j.gltf", "")).message().find("empty") != std::string::npos);
  CHECK(read(box().put("j.gltf", R"({"asset":{"version":"2.0"},"nodes":[{},{"name":"a","name":"b"}]})"))
            .message()
            .find("/nodes/1/name: the name is given twice") != std::string::npos);
  CHECK(read(box().put("j.gltf", R"({"asset":{"version":"2.0"},"scene":-1})")).message().find("/scene") !=
        std::string::npos);
  CHECK(read(box().folder() / "missing.gltf").message().find("missing.gltf") != std::string::npos);
  burnish::Report report;
  CHECK_FALSE(burnish::asset::readGltf(box().put("j.gltf", "{}"), {}, report));  // no decoder
}
