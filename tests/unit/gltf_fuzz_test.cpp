// Seeded mutations of valid files: every one is read or refused with an error that names a place; none crashes, hangs
// or leaves an index out of range.
#include <fmt/format.h>

#include <cmath>

#include "gltf_fixture.h"

using namespace gltf_test;

namespace {

std::string seedFile() {
  MeshFile f;
  f.positions(6);
  f.primitive["indices"] = f.accessor("SCALAR", 5123, 6, bytes<std::uint16_t>({0, 1, 2, 3, 4, 5}));
  f.attribute("NORMAL", f.accessor("VEC3", 5126, 6, std::string(72, '\0')));
  f.attribute("TEXCOORD_0", f.accessor("VEC2", 5121, 6, std::string(24, '\0'), {{"normalized", true}}));
  f.json["bufferViews"][3]["byteStride"] = 4;
  f.json["accessors"][2]["sparse"] = {
      {"count", 1}, {"indices", {{"bufferView", 4}, {"componentType", 5123}}}, {"values", {{"bufferView", 5}}}};
  f.accessor("SCALAR", 5123, 1, bytes<std::uint16_t>({3}));
  f.accessor("VEC3", 5126, 1, bytes<float>({0, 0, 1}));
  f.primitive["material"] = 0;
  f.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_texture_transform"};
  f.json["materials"] = {
      {{"emissiveTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}}}}}}}}};
  f.json["textures"] = {{{"source", 0}}};
  f.json["images"] = {{{"uri", "data:image/png;base64,iVBORw0KGgo="}}};
  f.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", {{"outerConeAngle", 1}}}}};
  f.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  f.json["nodes"] = {{{"children", {1, 2}}, {"mesh", 0}},
                     {{"camera", 0}, {"rotation", {0, 0, 0, 1}}},
                     {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  f.json["meshes"] = {{{"primitives", {f.primitive}}}};
  f.json["buffers"] = {{{"byteLength", f.binary.size()}}};
  return glb(f.json.dump(), f.binary);
}

// Bytes flipped, numbers replaced by awkward ones, pieces removed, doubled or cut off.
std::string mutated(std::string text, std::mt19937& random) {
  constexpr const char* kAwkward[] = {"-1",    "0",     "1",    "4294967295", "4294967296", "9007199254740993",
                                      "1e308", "1e999", "-0.0", "0.5",        "null",       "[]",
                                      "{}",    "\"\"",  "true", "65535",      "5126"};
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  for (std::size_t i = below(4) + 1; i > 0 && !text.empty(); --i) {
    const std::size_t at = below(text.size()), length = std::min(below(16) + 1, text.size() - at);
    switch (below(6)) {
      case 0:
        text[at] = char(below(256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      case 3:
        text.resize(at);
        break;
      default: {
        const std::size_t digit = text.find_first_of("0123456789", at);
        if (digit == text.npos) break;
        const std::size_t end = std::min(text.find_first_not_of("0123456789.", digit), text.size());
        text.replace(digit, end - digit, kAwkward[below(std::size(kAwkward))]);
      }
    }
  }
  return text;
}

// A random value of the document, by way of a random child at each step.
Json& pick(Json& from, std::mt19937& random) {
  Json* v = &from;
  while (v->is_structured() && !v->empty() && random() % 8) {
    auto child = v->begin();
    std::advance(child, long(random() % v->size()));
    v = &*child;
  }
  return *v;
}

// The document stays JSON; values of it are replaced, removed, doubled or exchanged.
std::string mutatedJson(const std::string& text, std::mt19937& random) {
  static const Json kAwkward = Json::parse(
      R"([-1,0,1,2,3,4,5,7,0.5,1e38,-1e308,255,5120,5121,5123,5125,5126,4294967295,4294967296,9007199254740993,null,true,"",
          "SCALAR","VEC4","MAT3",[],{},[0],[0,0],[1,1,1],{"index":0},"../a","data:,x"])");
  Json json = Json::parse(text);
  for (unsigned i = random() % 3 + 1; i > 0; --i) {
    Json& v = pick(json, random);
    switch (random() % 5) {
      case 0:
        if (v.is_structured() && !v.empty()) {
          auto child = v.begin();
          std::advance(child, long(random() % v.size()));
          v.erase(child);
        }
        break;
      case 1:
        if (v.is_array() && !v.empty()) v.push_back(Json(v[random() % v.size()]));
        break;
      case 2:
        v = Json(pick(json, random));
        break;
      case 3:
        if (v.is_number()) v = v.get<double>() + double(random() % 3) - 1;
        break;
      default:
        v = kAwkward[random() % kAwkward.size()];
    }
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Keeps the lengths of a GLB right, so that mutations reach what lies behind its header.
std::string mutatedGlb(const std::string& file, std::mt19937& random) {
  std::uint32_t length = 0;
  std::memcpy(&length, file.data() + 12, 4);
  const std::string text = file.substr(20, length);
  const std::string json = random() % 4 ? mutatedJson(text, random) : mutated(text, random);
  std::string binary = file.substr(std::min<std::size_t>(28 + length, file.size()));
  if (!binary.empty() && random() % 4 == 0) binary[random() % binary.size()] = char(random());
  return glb(json, binary);
}

template <class T>
bool allFinite(const std::vector<T>& list) {
  for (const T& v : list)
    for (int c = 0; c < T::length(); ++c)
      if (!std::isfinite(v[c])) return false;
  return true;
}

// What asset.h promises of every asset.
void checkPromises(const Asset& a) {
  const auto within = [](int index, std::size_t size) { return index >= -1 && index < int(size); };
  for (const auto& mesh : a.meshes)
    for (const auto& p : mesh.primitives) {
      CHECK(p.indices.size() % 3 == 0);
      CHECK(std::all_of(p.indices.begin(), p.indices.end(), [&](std::uint32_t i) { return i < p.positions.size(); }));
      for (const std::size_t n : {p.normals.size(), p.tangents.size(), p.uv0.size(), p.uv1.size(), p.colors.size()})
        CHECK((n == 0 || n == p.positions.size()));
      CHECK((allFinite(p.positions) && allFinite(p.normals) && allFinite(p.tangents) && allFinite(p.uv0) &&
             allFinite(p.uv1) && allFinite(p.colors)));
      CHECK(within(p.material, a.materials.size()));
    }
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    const auto& n = a.nodes[i];
    CHECK((n.parent >= -1 && n.parent < int(i)));
    CHECK((within(n.mesh, a.meshes.size()) && within(n.camera, a.cameras.size()) && within(n.light, a.lights.size())));
    for (int c = 0; c < 4; ++c)
      CHECK((std::isfinite(n.local[c].x) && std::isfinite(n.local[c].y) && std::isfinite(n.local[c].z)));
  }
  for (const auto& t : a.textures)
    CHECK((within(t.picture, a.pictures.size()) && within(t.sampler, a.samplers.size())));
  for (const auto& m : a.materials)
    if (m.emissiveTexture) CHECK(m.emissiveTexture.texture < int(a.textures.size()));
}

}  // namespace

TEST_CASE("mutated files are read or refused, nothing else", "[gltf]") {
  std::vector<std::string> seeds = {seedFile()};
  const fs::path samples = sharedData() / "gltf";
  for (const char* name :
       {"Fox/Fox.glb", "TextureTransformTest/TextureTransformTest.gltf", "EnvironmentTest/EnvironmentTest.gltf"})
    if (fs::exists(samples / name)) seeds.push_back(slurp(samples / name));
  const Sandbox box;
  {
    const Reading r = read(box.put("seed.glb", seeds[0]));
    INFO(r.message());
    REQUIRE(r.asset);  // a seed that is refused would make a test that finds nothing
    checkPromises(*r.asset);
  }
  const unsigned rounds = longRun() ? 200000 : 600;
  int accepted = 0;
  double slowest = 0;
  for (unsigned seed = 1; seed <= rounds; ++seed) {
    std::mt19937 random(seed);
    const std::string& original = seeds[seed % 8 ? 0 : seed / 8 % seeds.size()];
    const bool container = original.starts_with("glTF");
    const std::string file = container && seed % 3 ? mutatedGlb(original, random) : mutated(original, random);
    const Reading r = read(box.put("mutated.glb", file));
    INFO("seed " << seed << ": " << r.message());
    slowest = std::max(slowest, r.seconds);
    if (r.asset) {
      ++accepted;
      checkPromises(*r.asset);
    } else {
      CHECK(r.asset.error().place.starts_with("mutated.glb"));
      CHECK_FALSE(r.asset.error().what.empty());
    }
    REQUIRE(r.seconds < timeLimit(10));
  }
  WARN(fmt::format("{} mutations: {} read, {} refused, slowest {:.0f} ms", rounds, accepted,
                   rounds - unsigned(accepted), slowest * 1e3));
  CHECK((accepted > 0 && accepted < int(rounds)));
}
