// Cost follows what a file weighs: small files that ask for much are refused, deep ones need no stack, many faults make
// a short report.
#include "gltf_fixture.h"

using namespace gltf_test;

namespace {
const Sandbox& box() {
  static const Sandbox sandbox;
  return sandbox;
}
std::string repeated(const std::string& piece, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += (i ? "," : "") + piece;
  return out;
}
const std::string kHead = R"({"asset":{"version":"2.0"},)";
}  // namespace

TEST_CASE("node trees of any depth", "[gltf]") {
  constexpr int kDepth = 100000;
  std::string nodes = R"({"children":[1]})";
  for (int i = 1; i < kDepth - 1; ++i)
    nodes += R"(,{"translation":[1,0,0],"children":[)" + std::to_string(i + 1) + "]}";
  nodes += ",{}";
  const Reading r = read(box().put("deep.gltf", kHead + R"("scenes":[{"nodes":[0]}],"nodes":[)" + nodes + "]}"));
  INFO(r.message());
  REQUIRE(r.asset);
  CHECK(r.asset->nodes.size() == kDepth);
  CHECK(r.asset->nodes.back().parent == kDepth - 2);
  CHECK(r.seconds < timeLimit(5));
  // the same as a loop, which only the last node closes
  nodes.replace(nodes.size() - 2, 2, R"({"children":[0]})");
  CHECK(read(box().put("loop.gltf", kHead + R"("nodes":[)" + nodes + "]}")).message().find("loop") !=
        std::string::npos);
}

TEST_CASE("accessors that stand for more than the file holds are refused", "[gltf]") {
  const std::string zeros = R"({"componentType":5126,"type":"MAT4","count":4294967295})";
  const Reading huge = read(box().put("z.gltf", kHead + R"("accessors":[)" + zeros + "]}"));
  CHECK(huge.message().find("/accessors/0") != std::string::npos);
  CHECK(huge.seconds < timeLimit(0.5));
  // one megabyte, read by ten thousand accessors
  box().put("one.bin", std::string(1 << 20, '\0'));
  const std::string many = repeated(R"({"bufferView":0,"componentType":5126,"type":"SCALAR","count":262144})", 10000);
  const Reading r = read(box().put(
      "m.gltf",
      kHead +
          R"("buffers":[{"byteLength":1048576,"uri":"one.bin"}],"bufferViews":[{"buffer":0,"byteLength":1048576}],"accessors":[)" +
          many + "]}"));
  CHECK(r.message().find("far more data") != std::string::npos);
  CHECK(r.seconds < timeLimit(2));
}

TEST_CASE("primitives that name the same data again and again are refused", "[gltf]") {
  MeshFile f;
  f.positions(100000);
  for (int i = 0; i < 5000; ++i) f.json["meshes"].push_back({{"primitives", {f.primitive}}});
  const Reading r = f.readIn(box());
  CHECK(r.message().find("far more data") != std::string::npos);
  CHECK(r.seconds < timeLimit(5));
}

TEST_CASE("many faults of a kind are one warning with a count", "[gltf]") {
  const Reading r = read(box().put("w.gltf", kHead + R"("nodes":[)" + repeated(R"({"typo":1})", 50000) + "]}"));
  INFO(r.message());
  REQUIRE(r.asset);
  REQUIRE(r.report.warnings().size() == 1);
  CHECK(r.report.warnings()[0].message() ==
        "w.gltf: /nodes/0/typo: unknown property 'typo' is ignored (and 49999 more like it)");
  CHECK(r.seconds < timeLimit(5));
  // and as many kinds as nodes stay a bounded report
  std::string nodes;
  for (int i = 0; i < 50000; ++i) nodes += (i ? ",{\"t" : "{\"t") + std::to_string(i) + "\":1}";
  const Reading many = read(box().put("w.gltf", kHead + R"("nodes":[)" + nodes + "]}"));
  REQUIRE(many.report.warnings().size() == 1001);
  CHECK(many.report.warnings().back().message() == "w.gltf: 49000 more warnings are not listed");
}

TEST_CASE("the number of JSON values is bounded before anything is built", "[gltf]") {
  std::string text = R"({"asset":{"version":"2.0","extras":[0)";
  text.reserve(40'000'000);
  for (int i = 0; i < 17'000'000; ++i) text += ",0";
  const Reading r = read(box().put("v.gltf", text + "]}}"));
  CHECK(r.message().find("JSON holds more than") != std::string::npos);
  CHECK(r.seconds < timeLimit(2));
}

TEST_CASE("files over the limit are not read", "[gltf]") {
  const fs::path file = box().put("big.gltf", kHead + R"("extras":0})");
  CHECK(read(file, {.maxFileBytes = 10}).message().find("limit") != std::string::npos);
  // the limit is on all files together
  box().put("one.bin", std::string(1000, '\0'));
  const fs::path two = box().put(
      "two.gltf", kHead + R"("buffers":[{"byteLength":1000,"uri":"one.bin"},{"byteLength":1000,"uri":"one.bin"}]})");
  CHECK(read(two, {.maxFileBytes = 3000}).message().empty());
  CHECK(read(two, {.maxFileBytes = 2000}).message().find("/buffers/1/uri") != std::string::npos);
}
