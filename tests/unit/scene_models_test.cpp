// Whole files through loadScene. The models are the Khronos samples in ../shared/data, used where they are there; one
// file is made here.
#include <burnish/scene.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "paths.h"
#include "scene/tangents.h"

using namespace burnish;
namespace fs = std::filesystem;

namespace {

/// Stands in for the helper processes: every picture is a small varied one.
class FakeDecoder : public ImageDecoder {
 public:
  Result<Image> decode(std::span<const std::byte> file, std::string_view, const DecodeLimits&) override {
    Image image = makeImage(8, 4, 4, PixelType::U8);
    for (std::size_t i = 0; i < image.byteSize(); ++i)
      image.u8()[i] = std::uint8_t(std::to_integer<unsigned>(file[i % file.size()]) + 37 * i);
    return image;
  }
};

fs::path shared(std::string_view path) { return fs::path(BURNISH_SOURCE_DIR).parent_path() / "shared/data" / path; }

void checkScene(const Scene& s) {
  s.meshes.each([](Id<Mesh>, const Mesh& m) {
    INFO(m.name);
    REQUIRE(m.normals.size() == m.positions.size());
    for (std::size_t i = 0; i < m.positions.size(); ++i) {
      REQUIRE(std::isfinite(m.positions[i].x + m.positions[i].y + m.positions[i].z));
      REQUIRE(glm::length(m.normals[i]) == Approx(1).margin(1e-4));
      if (!m.tangents.empty()) REQUIRE(glm::length(glm::vec3(m.tangents[i])) == Approx(1).margin(1e-4));
    }
  });
  s.instances.each([&s](Id<Instance>, const Instance& i) {
    REQUIRE(s.meshes.has(i.mesh));
    REQUIRE(s.materials.has(i.material));
    REQUIRE(s.nodes.has(i.node));
  });
  s.materials.each([&s](Id<Material>, const Material& m) {
    for (const Id<Texture> t : {m.mapA, m.mapB, m.mapC, m.emissiveMap, m.metalRoughMap})
      if (t) REQUIRE(s.textures.has(t));
    REQUIRE(m.roughness >= 0);
    REQUIRE(m.roughness <= 1);
  });
  REQUIRE(!s.bounds().empty());
}

/// A temporary folder that goes when the test ends.
struct Folder {
  fs::path path;
  Folder() {
    std::string name = (fs::temp_directory_path() / "burnish-scene-XXXXXX").string();
    path = mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path); }
  void write(const char* name, std::string_view text) const { std::ofstream(path / name, std::ios::binary) << text; }
};

/// One triangle, positions in a data URI.
std::string triangleFile(const std::string& extras) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0])" + extras +
         R"(}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
}

}  // namespace

TEST_CASE("A file's own environment is read from its folder and nowhere else", "[scene]") {
  Folder folder;
  FakeDecoder decoder;
  const LoadOptions options{.decoder = &decoder};
  folder.write("sky.png", "anything");
  folder.write("inside.gltf", triangleFile(R"(,"extras":{"burnish":{"environment":"sky.png"}})"));
  Report report;
  auto s = loadScene(folder.path / "inside.gltf", options, report);
  REQUIRE(s);
  CHECK(s->environment.map.width == 8);
  CHECK(s->environment.map.type == PixelType::F32);
  CHECK(s->environment.revision == 1);

  folder.write("missing.gltf", triangleFile(R"(,"extras":{"burnish":{"environment":"none.hdr"}})"));
  Report missing;
  s = loadScene(folder.path / "missing.gltf", options, missing);
  REQUIRE(!s);
  CHECK(s.error().message().find("environment") != std::string::npos);
  CHECK(s.error().message().find("none.hdr") != std::string::npos);

  folder.write("outside.gltf", triangleFile(R"(,"extras":{"burnish":{"environment":"../../../../etc/hostname"}})"));
  Report outside;
  s = loadScene(folder.path / "outside.gltf", options, outside);
  REQUIRE(!s);
  CHECK(s.error().message().find("environment") != std::string::npos);

  Report own;
  Scene empty;
  CHECK(loadEnvironment(empty, folder.path / "sky.png", options, own));
  CHECK(!empty.environment.map.empty());
  CHECK(!loadEnvironment(empty, folder.path, options, own));
  CHECK(!loadEnvironment(empty, folder.path / "nothing.hdr", options, own));
}

TEST_CASE("Every sample model that is there loads", "[scene]") {
  FakeDecoder decoder;
  int loaded = 0;
  for (const char* folder : {"gltf", "atrium"}) {
    if (!fs::exists(shared(folder))) continue;
    for (const auto& entry : fs::recursive_directory_iterator(shared(folder))) {
      if (entry.path().extension() != ".gltf" && entry.path().extension() != ".glb") continue;
      INFO(entry.path());
      Report report;
      const auto s = loadScene(entry.path(), {.decoder = &decoder}, report);
      if (!s) FAIL(s.error().message());
      checkScene(*s);
      ++loaded;
    }
  }
  if (fs::exists(shared("gltf"))) CHECK(loaded >= 8);
}

TEST_CASE("Tangents agree with the ones that sample models bring", "[tangent]") {
  FakeDecoder decoder;
  for (const char* name : {"gltf/NormalTangentMirrorTest/NormalTangentMirrorTest.glb",
                           "gltf/WaterBottle/WaterBottle.gltf", "gltf/LightsPunctualLamp/LightsPunctualLamp.gltf"}) {
    if (!fs::exists(shared(name))) continue;
    Report report;
    const auto s = loadScene(shared(name), {.decoder = &decoder}, report);
    REQUIRE(s);
    std::size_t corners = 0, close = 0, flipped = 0;
    double sum = 0, worst = 0;
    s->meshes.each([&](Id<Mesh>, const Mesh& file) {
      if (file.tangents.empty()) return;
      Mesh ours = file;
      ours.tangents.clear();
      makeTangents(ours);
      REQUIRE(ours.tangents.size() == ours.positions.size());
      for (std::size_t c = 0; c < file.indices.size(); ++c) {
        const glm::vec4 a = file.tangents[file.indices[c]], b = ours.tangents[ours.indices[c]];
        // The file's tangent in the plane of its normal, which is where a shader uses it.
        const glm::vec3 n = file.normals[file.indices[c]], flat = glm::vec3(a) - n * glm::dot(n, glm::vec3(a));
        if (glm::length(flat) < 0.1f) continue;
        const double angle =
            glm::degrees(std::acos(std::clamp(double(glm::dot(glm::normalize(flat), glm::vec3(b))), -1.0, 1.0)));
        ++corners;
        sum += angle;
        worst = std::max(worst, angle);
        close += angle < 1;
        flipped += a.w != b.w;
      }
    });
    REQUIRE(corners > 0);
    INFO(name << ": " << corners << " corners, mean " << sum / double(corners) << " deg, worst " << worst << " deg, "
              << flipped << " of other handedness");
    // The mirror test was made with mikktspace itself; the other two with other tools, which weigh and split a little
    // differently.
    const bool reference = std::string_view(name).find("Mirror") != std::string_view::npos;
    CHECK(flipped == 0);
    if (reference) CHECK(worst < 0.1);
    CHECK(double(close) >= 0.99 * double(corners));
  }
}
