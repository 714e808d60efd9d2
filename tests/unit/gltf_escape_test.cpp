// Paths that leave the asset's folder, things that are no files, and files built to exhaust: each is one clear error,
// in no time.
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include "gltf_fixture.h"

using namespace gltf_test;

namespace {

std::string withBuffer(const std::string& uri, std::uint64_t length = 4) {
  return Json{{"asset", {{"version", "2.0"}}},
              {"buffers", {{{"uri", uri}, {"byteLength", length}}}},
              {"bufferViews", {{{"buffer", 0}, {"byteLength", length}}}}}
      .dump();
}

std::string withImage(const std::string& uri) {
  return Json{{"asset", {{"version", "2.0"}}},
              {"images", {{{"uri", uri}}}},
              {"textures", {{{"source", 0}}}},
              {"materials", {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}}}}
      .dump();
}

// Everything that a path could reach outside and inside.
void furnish(const Sandbox& box) {
  std::ofstream(box.root / "secret.bin") << "SECRET!!";
  fs::create_directories(box.root / "other");
  std::ofstream(box.root / "other/file.bin") << "SECRET!!";
  fs::create_symlink(box.root / "secret.bin", box.folder() / "link.bin");
  fs::create_directory_symlink(box.root / "other", box.folder() / "linked");
  fs::create_directories(box.folder() / "sub");
  REQUIRE(::mkfifo((box.folder() / "fifo").c_str(), 0600) == 0);
  box.put("huge.bin", "");
  fs::resize_file(box.folder() / "huge.bin", std::uint64_t(3) << 30);
  fs::create_symlink("/dev/zero", box.folder() / "zero");
}

struct Escape {
  const char* name;
  std::string uri;
  const char* says;
};

void checkRefused(const Reading& r, const Escape& e, const char* path) {
  INFO(e.name << ": " << r.message());
  REQUIRE_FALSE(r.asset);
  CHECK(r.asset.error().place.ends_with(path));
  CHECK(r.asset.error().what.find(e.says) != std::string::npos);
  CHECK_FALSE(r.asset.error().remedy.empty());
  CHECK(r.message().find('\n') == std::string::npos);
  CHECK(r.seconds < timeLimit(1));
}

}  // namespace

TEST_CASE("paths that leave the asset's folder are one clear error each", "[gltf]") {
  const Sandbox box;
  furnish(box);
  const Escape escapes[] = {
      {"..", "../secret.bin", "leaves the asset's folder"},
      {".. in the middle", "sub/../../secret.bin", "leaves the asset's folder"},
      {".. to nothing", "../nothing.bin", "leaves the asset's folder"},
      {"percent-encoded", "%2e%2e/secret.bin", "leaves the asset's folder"},
      {"percent-encoded slash", "..%2fsecret.bin", "leaves the asset's folder"},
      {"backslash", "..\\secret.bin", "leaves the asset's folder"},
      {"absolute", (box.root / "secret.bin").string(), "absolute"},
      {"file:", "file://" + (box.root / "secret.bin").string(), "scheme"},
      {"http:", "http://localhost/secret.bin", "scheme"},
      {"link to a file", "link.bin", "link that leaves"},
      {"link to a folder", "linked/file.bin", "link that leaves"},
      {"folder", "sub", "a folder"},
      {"the folder itself", ".", "a folder"},
      {"FIFO", "fifo", "a FIFO"},
      {"device", "zero", "a device"},
      {"device by its path", "/dev/zero", "absolute"},
      {"NUL", "a%00.bin", "NUL"},
      {"no URI", ":", "no URI"},
      {"empty", "", "no URI"},
  };
  for (const Escape& e : escapes) {
    checkRefused(read(box.put("buffer.gltf", withBuffer(e.uri))), e, "/buffers/0/uri");
    checkRefused(read(box.put("image.gltf", withImage(e.uri))), e, "/images/0/uri");
  }
  SECTION("links that stay inside are fine") {
    box.put("real.bin", "1234");
    fs::create_symlink("../real.bin", box.folder() / "sub/inner.bin");
    CHECK(read(box.put("ok.gltf", withBuffer("sub/inner.bin"))).message().empty());
    CHECK(read(box.put("ok.gltf", withBuffer("sub/../real.bin"))).message().empty());
  }
  SECTION("allowOutside lifts the guard, but nothing is fetched") {
    CHECK(read(box.put("ok.gltf", withBuffer("../secret.bin")), {.allowOutside = true}).message().empty());
    CHECK_FALSE(read(box.put("no.gltf", withBuffer("http://localhost/a")), {.allowOutside = true}).asset);
  }
  SECTION("environments are guarded the same way") {
    const Json file = {{"asset", {{"version", "2.0"}}},
                       {"scenes", {{{"extras", {{"burnish", {{"environment", "../secret.bin"}}}}}}}}};
    const Reading r = read(box.put("env.gltf", file.dump()));
    CHECK(r.message().find("/scenes/0/extras/burnish/environment") != std::string::npos);
  }
}

TEST_CASE("a missing picture is a warning, a missing buffer an error", "[gltf]") {
  const Sandbox box;
  const Reading image = read(box.put("image.gltf", withImage("missing.png")));
  CHECK(image.message().empty());
  CHECK(image.warned("missing.png"));
  CHECK_FALSE(image.asset->materials[0].baseColorTexture);
  CHECK(read(box.put("buffer.gltf", withBuffer("missing.bin"))).message().find("/buffers/0/uri") != std::string::npos);
}

TEST_CASE("a 3 GB file behind 4 declared bytes is refused unread", "[gltf]") {
  const Sandbox box;
  furnish(box);
  const Reading r = read(box.put("bomb.gltf", withBuffer("huge.bin")));
  INFO(r.message());
  REQUIRE_FALSE(r.asset);
  CHECK(r.asset.error().place == "bomb.gltf: /buffers/0/uri");
  CHECK(r.asset.error().what.find("3221225472") != std::string::npos);
  CHECK(r.seconds < timeLimit(0.2));
}

TEST_CASE("nesting is bounded before parsing", "[gltf]") {
  const Sandbox box;
  const auto nested = [](int depth, const char* open, const char* close) {
    std::string text = R"({"asset":{"version":"2.0","extras":)";
    for (int i = 0; i < depth; ++i) text += open;
    text += "1";
    for (int i = 0; i < depth; ++i) text += close;
    return text + "}}";
  };
  for (const int depth : {63, 1000, 100000}) {
    const Reading arrays = read(box.put("a.gltf", nested(depth, "[", "]")));
    const Reading objects = read(box.put("o.glb", glb(nested(depth, R"({"extras":)", "}"))));
    CHECK(arrays.message().find("nested deeper than 64") != std::string::npos);
    CHECK(objects.message().find("nested deeper than 64") != std::string::npos);
    CHECK(arrays.seconds + objects.seconds < timeLimit(0.5));
  }
  CHECK(read(box.put("a.gltf", nested(62, "[", "]"))).message().empty());
  CHECK(read(box.put("s.gltf", R"({"asset":{"version":"2.0","generator":"[[[\"[[[{{{\\"}})"), {.maxJsonDepth = 2})
            .message()
            .empty());
}

TEST_CASE("a picture's buffer view out of range and node cycles are refused", "[gltf]") {
  const Sandbox box;
  box.put("a.bin", "1234");
  Json image = Json::parse(withBuffer("a.bin"));
  image["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
  CHECK(read(box.put("i.gltf", image.dump())).message().empty());
  image["bufferViews"][0]["byteLength"] = 5;
  CHECK(read(box.put("i.gltf", image.dump())).message().find("/bufferViews/0/byteLength") != std::string::npos);
  image["bufferViews"][0] = {{"buffer", 0}, {"byteOffset", 9007199254740992.0}, {"byteLength", 9007199254740992.0}};
  CHECK(read(box.put("i.gltf", image.dump())).message().find("/bufferViews/0/byteOffset") != std::string::npos);
  image["images"][0]["bufferView"] = 7;
  CHECK(read(box.put("i.gltf", image.dump())).message().find("/images/0/bufferView") != std::string::npos);

  for (const Json& nodes :
       {Json::parse(R"([{"children":[1]},{"children":[2]},{"children":[0]}])"), Json::parse(R"([{"children":[0]}])"),
        Json::parse(R"([{},{"children":[2]},{"children":[1]}])")}) {
    const Json file = {{"asset", {{"version", "2.0"}}}, {"nodes", nodes}};
    const Reading r = read(box.put("n.gltf", file.dump()));
    INFO(r.message());
    CHECK(r.message().find("loop") != std::string::npos);
    CHECK(r.message().find("/nodes/") != std::string::npos);
  }
}
